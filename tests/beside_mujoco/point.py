"""Boxes, cylinders and hulls that touch in several points; `record_points.py` asks MuJoCo how they move."""

STEP = 1e-7
STEPS = (100, 500)
_BOX = 'type="box" size=".1 .1 .1"'
_CYLINDER = 'type="cylinder" size=".1 .1"'
_PLANE = 'type="plane" size="1 1 .1"'
_SOLE, _TETRAHEDRON = 'type="mesh" mesh="sole"', 'type="mesh" mesh="tetrahedron"'


def _ring(x: float, y: float, z: float) -> str:
    return "".join(f"{side * x} {front * y} {z} " for side in (-1, 1) for front in (-1, 1))


# The edges of a sole are bevelled, as those of a shoe.
_MESHES = (
    f'<asset><mesh name="sole" vertex="{_ring(0.145, 0.04, 0)}{_ring(0.15, 0.045, 0.001)}'
    f'{_ring(0.15, 0.045, 0.03)}"/>'
    '<mesh name="tetrahedron" vertex=".1 0 0 -.05 .08 0 -.05 -.08 0 0 0 .1"/></asset>'
)


def _file(below: str, geom: str, turn: str, height: float, step: float) -> str:
    head = f'<option timestep="{step}" tolerance="1e-12" iterations="300"/><compiler eulerseq="XYZ"/>'
    meshes, inertia = "", ""
    if "mesh" in geom:
        meshes, inertia = _MESHES, '<inertial pos="0 0 0" mass="1" diaginertia=".004 .006 .005"/>'
    return (
        f'<mujoco>{head}{meshes}<worldbody><geom {below}/><body name="b" pos="0 0 {height}" euler="{turn}">'
        f"<freejoint/>{inertia}<geom {geom}/></body></worldbody></mujoco>"
    )


def _stack(step: float) -> str:
    boxes = "".join(
        f'<body name="{name}" pos="{x} 0 {z}" euler="0 0 {turn}"><freejoint/><geom {_BOX}/></body>'
        for name, x, z, turn in (("c", 0.01, 0.1, 0), ("d", 0.0, 0.3, 25), ("b", 0.02, 0.5, 70))
    )
    return f'<mujoco><option timestep="{step}"/><worldbody><geom {_PLANE}/>{boxes}</worldbody></mujoco>'


def _files(step: float) -> dict[str, str]:
    return {
        **{
            f"box turned by {turn}": _file(_BOX, _BOX, turn, 0.199, step)
            for turn in ("0 0 0", "0 0 30", "0 0 45", "0 0 1e-5", "3 0 0", "1 2 20")
        },
        "flat box": _file(_BOX, 'type="box" size=".07 .12 .1"', "0 0 30", 0.199, step),
        **{
            f"cylinder turned by {turn}": _file(_PLANE, _CYLINDER, turn, 0.099, step)
            for turn in ("0 0 0", "0 0 50", "90 0 0", "10 0 0", "45 0 0", ".1 0 30")
        },
        **{
            f"sole turned by {turn}": _file(_PLANE, _SOLE, turn, -0.002, step)
            for turn in ("0 0 0", ".4 .2 0", "0 -.3 40", "2 3 0")
        },
        **{
            f"tetrahedron turned by {turn}": _file(_PLANE, _TETRAHEDRON, turn, -0.002, step)
            for turn in ("0 0 0", "1 .5 0")
        },
    }


TOUCHING = _files(STEP)
RESTING = {
    "box": _file(_BOX, _BOX, "0 0 30", 0.2, 0.002),
    "cylinder": _file(_PLANE, _CYLINDER, "0 0 0", 0.1, 0.002),
    "wheel": _file(_PLANE, _CYLINDER, "90 0 0", 0.12, 0.002),
    "stack": _stack(0.002),
    "sole": _file(_PLANE, _SOLE, "0 0 0", 0.0, 0.002),
    "tetrahedron": _file(_PLANE, _TETRAHEDRON, "0 0 0", 0.0, 0.002),
}
