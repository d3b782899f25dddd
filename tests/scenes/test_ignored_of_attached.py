"""What of attached models and repeated sections has no effect in MuJoCo either does not matter."""

from pathlib import Path

from carom import World

CHILD = """<mujoco><option integrator="RK4"/><worldbody><body name="arm"><joint name="j"/>
<geom size=".1"/></body><body name="other"><geom size=".1"/></body></worldbody></mujoco>"""
FILE = """<mujoco><asset><model name="child" file="child.xml"/></asset><statistic center="0 0 1"/>
<statistic extent="2"/><worldbody><frame pos="1 0 0"><attach model="child" body="arm" prefix="a_"/></frame>
<replicate count="2" prefix="x"><geom size=".1"/></replicate></worldbody></mujoco>"""


def test_only_what_differs_from_mujoco_matters(tmp_path: Path):
    (tmp_path / "child.xml").write_text(CHILD)
    (tmp_path / "file.xml").write_text(FILE)
    scene = World().load(tmp_path / "file.xml")
    assert not scene.ignored.that_matter
    assert not any("that Carom knows" in it.reason for it in scene.ignored)
