"""Boxes and cylinders that touch in several points; `record_points.py` asks MuJoCo how they move."""

STEP = 1e-7
STEPS = (100, 500)
_BOX = 'type="box" size=".1 .1 .1"'
_CYLINDER = 'type="cylinder" size=".1 .1"'
_PLANE = 'type="plane" size="1 1 .1"'


def _file(below: str, geom: str, turn: str, height: float, step: float) -> str:
    head = f'<option timestep="{step}" tolerance="1e-12" iterations="300"/><compiler eulerseq="XYZ"/>'
    return (
        f'<mujoco>{head}<worldbody><geom {below}/><body name="b" pos="0 0 {height}" euler="{turn}">'
        f"<freejoint/><geom {geom}/></body></worldbody></mujoco>"
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
    }


TOUCHING = _files(STEP)
RESTING = {
    "box": _file(_BOX, _BOX, "0 0 30", 0.2, 0.002),
    "cylinder": _file(_PLANE, _CYLINDER, "0 0 0", 0.1, 0.002),
    "wheel": _file(_PLANE, _CYLINDER, "90 0 0", 0.12, 0.002),
    "stack": _stack(0.002),
}
