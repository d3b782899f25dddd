"""Friction of geoms is combined as in MuJoCo: of the higher priority, else the greater one."""

import pytest
from numpy.testing import assert_allclose

from carom import World

FILE = """<mujoco><option timestep=".001"/><worldbody><geom type="plane" size="9 9 .1" {plane}/>
<body name="box" pos="0 0 .1"><freejoint/><geom type="box" size=".3 .3 .1" {box}/></body></worldbody>
</mujoco>"""


def deceleration(folder, plane, box):
    (folder / "file.xml").write_text(FILE.format(plane=plane, box=box))
    with World(contact="bullet") as world:
        scene = world.load(folder / "file.xml")
        scene.apply_options()
        assert not scene.ignored.that_matter
        body = scene["box"]
        world.step(50)
        body.set_base_velocity([2.0, 0.0, 0.0], [0.0, 0.0, 0.0])
        world.step(100)
        return (2.0 - body.links[-1].velocity.linear[0]) / 0.1 / 9.81


@pytest.mark.parametrize(
    ("plane", "box", "coefficient"),
    [
        ('friction=".2"', 'friction=".6"', 0.6),
        ('friction=".6"', 'friction=".2"', 0.6),
        ('friction=".2" priority="1"', 'friction=".6"', 0.2),
        ('friction=".2"', 'friction=".6" priority="-3"', 0.2),
        ('friction=".3" priority="2"', 'friction=".6" priority="2"', 0.6),
    ],
)
def test_friction_is_combined_as_in_mujoco(tmp_path, plane, box, coefficient):
    assert_allclose(deceleration(tmp_path, plane, box), coefficient, rtol=0.02)


def test_only_files_of_mjcf_have_ranks(tmp_path):
    (tmp_path / "file.xml").write_text(FILE.format(plane='friction=".2"', box='friction=".6"'))
    with World(contact="bullet") as world:
        bodies = world.load(tmp_path / "file.xml").bodies
        assert {body.dynamics(-1).friction_rank for body in bodies} == {1000}
        assert world.add_box((1.0, 1.0, 1.0)).dynamics(-1).friction_rank == 0
