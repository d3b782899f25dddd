"""MJCF files with flexes; `record_flexes.py` asks MuJoCo where they are, and where they come to rest."""

_STILL = '<contact contype="0" conaffinity="0"/>'
MADE = {
    f"{kind} {dim}": f'<mujoco><worldbody><flexcomp name="f" type="{kind}" dim="{dim}" count="{count}" '
    'spacing=".1 .2 .3" mass="2"/></worldbody></mujoco>'
    for kind, dim, count in (
        ("grid", 1, "4 1 1"), ("grid", 2, "3 4 1"), ("grid", 3, "3 4 2"), ("box", 3, "3 4 5"),
        ("cylinder", 3, "5 4 3"), ("ellipsoid", 3, "4 3 5"), ("box", 2, "4 3 4"), ("cylinder", 2, "3 4 5"),
        ("ellipsoid", 2, "3 4 3"), ("circle", 1, "7 1 1"), ("disc", 2, "5 6 1"),
    )
}  # fmt: skip
MADE |= {
    "direct": """<mujoco><worldbody><body name="b" pos="0 0 3" euler="90 0 0"><geom size=".1"/><flexcomp
        name="f" type="direct" dim="2" point="0 0 0 1 0 0 0 1 0 5 5 5 1 1 0" element="0 1 2 1 4 2"
        scale="2 1 1" pos="1 0 0" euler="0 0 90" mass="2"/></body></worldbody></mujoco>""",
    "pins": """<mujoco><worldbody><flexcomp name="f" type="grid" dim="2" count="3 3 1" mass="2"><pin
        grid="0 1 2 2"/><pin gridrange="1 0 1 2"/><pin id="0"/><pin range="2 3"/></flexcomp></worldbody>
        </mujoco>""",
}
"""Flexes whose points, cells, pins and masses count."""

_RESTING = '<mujoco><option timestep="{}"/><worldbody>{}</worldbody></mujoco>'
RESTING = {
    "cable of springs": _RESTING.format(
        "1e-3", '<flexcomp name="f" type="grid" dim="1" count="9 1 1" spacing=".1 .1 .1" pos="0 0 2" '
        f'mass=".9" radius=".005"><edge stiffness="400" damping="1"/>{_STILL}<pin id="0 8"/></flexcomp>'
    ),
    "cable of constraints": _RESTING.format(
        "1e-3", '<flexcomp name="f" type="grid" dim="1" count="9 1 1" spacing=".1 .1 .1" pos="0 0 2" '
        f'mass=".9" radius=".005"><edge equality="true" damping=".5"/>{_STILL}<pin id="0 8"/></flexcomp>'
    ),
    "cloth of constraints": _RESTING.format(
        "1e-3", '<flexcomp name="f" type="grid" dim="2" count="5 7 1" spacing=".05 .05 .05" pos="0 0 2" '
        f'mass=".3" radius=".005"><edge equality="true" damping=".5"/>{_STILL}<pin id="0 6"/></flexcomp>'
    ),
    "cloth that stretches": _RESTING.format(
        '4e-4" gravity="9.81 0 0', '<flexcomp name="f" type="grid" dim="2" count="5 7 1" pos="0 0 2" '
        'spacing=".05 .05 .05" mass=".3" radius=".005"><elasticity young="1.5e5" poisson=".3333" '
        f'thickness=".002" elastic2d="stretch"/><edge damping=".02"/>{_STILL}<pin range="0 6"/></flexcomp>'
    ),
    "beam": _RESTING.format(
        "2e-4", '<flexcomp name="f" type="grid" dim="3" count="7 3 3" spacing=".05 .05 .05" pos="0 0 2" '
        f'mass="1" radius=".005"><elasticity young="3e5" poisson=".3"/>{_STILL}<pin gridrange="0 0 0 0 2 2"/>'
        "</flexcomp>"
    ),
}  # fmt: skip
"""Flexes that come to rest, as nothing but gravity acts on them."""
STEPS, KEPT = 6000, 0.995
"""So many steps are made, after each of which this share of velocities is kept."""
