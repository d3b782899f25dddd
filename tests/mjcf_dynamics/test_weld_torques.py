"""Welds yield to torques by their `torquescale` as in MuJoCo.

The numbers are of `mujoco` 4.0: the turn of a body about y after 300 steps under its weight.
"""

from pathlib import Path

import pytest

from carom import World

FILE = """<mujoco><option timestep=".002" integrator="discrete"/><worldbody><body name="a" pos="0 0 1">
<geom size=".1 .2 .3" type="box" pos=".5 0 0" contype="0" conaffinity="0"/><freejoint/></body></worldbody>
<equality><weld body1="a" torquescale="{}" solref=".02 1"/></equality></mujoco>"""


@pytest.mark.parametrize(
    ("scale", "turn"),
    # No torque holds it with 0.
    [("0.25", 0.229681), ("1", 0.007787), ("2", 0.001862), ("0", 0.41023)],
)
def test_scaled_torques_hold_as_in_mujoco(tmp_path: Path, scale: str, turn: float):
    (tmp_path / "weld.xml").write_text(FILE.format(scale))
    scene = World(contact="compliant").load(tmp_path / "weld.xml")
    assert not scene.ignored.that_matter
    scene.world.step(300)
    assert scene["a"].pose.orientation[1] == pytest.approx(turn, rel=0.01)
