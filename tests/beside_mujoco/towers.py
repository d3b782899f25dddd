"""Towers of boxes that creep in MuJoCo; `record_towers.py` asks it how far."""

from __future__ import annotations

COUNT, TIME_STEP = 10, 0.002
SECONDS = (1, 6, 61)
"""When positions are compared with those of the first of these times [s]."""
_OFFSETS = (
    (0.0014, -0.0023), (-0.0046, -0.0048), (0.0031, 0.0041), (0.0011, 0.0023), (0.0004, 0.0044),
    (0.0032, -0.005), (0.0036, -0.0047), (0.0023, -0.0032), (0.0036, 0.0004), (-0.002, -0.0008),
)  # fmt: skip


def tower(cone: str = "pyramidal", share: float = 1.0, time_step: float = TIME_STEP) -> str:
    """A tower of boxes of 20 cm, off centre by a share of up to 5 mm."""
    bodies = "".join(
        f'<body name="b{i}" pos="{share * x!r} {share * y!r} {0.1 + 0.2 * i!r}"><freejoint/>'
        '<geom type="box" size=".1 .1 .1" mass="1"/></body>'
        for i, (x, y) in enumerate(_OFFSETS)
    )
    return (
        f'<mujoco><option cone="{cone}" timestep="{time_step!r}"/><worldbody>'
        f'<geom type="plane" size="5 5 .1"/>{bodies}</worldbody></mujoco>'
    )
