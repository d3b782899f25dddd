"""Frames of links in many worlds, where inertial frames are turned and elsewhere."""

from pathlib import Path

import numpy as np
from numpy.testing import assert_allclose

from carom import World, Worlds

TURNED = """<mujoco><worldbody><body name="a" pos=".1 .2 1" euler="10 20 30"><freejoint/>
<inertial pos=".1 -.2 .05" quat=".5 .1 -.7 .5" mass="1" diaginertia=".1 .2 .15"/>
<body name="b" pos=".3 0 0" euler="0 40 0"><joint axis="0 1 0"/>
<inertial pos="0 .1 .2" quat=".3 -.5 .2 .8" mass=".5" diaginertia=".1 .08 .05"/>
</body></body></worldbody></mujoco>"""


def test_link_frames_are_those_of_one_world(tmp_path: Path) -> None:
    (tmp_path / "turned.xml").write_text(TURNED)
    with World() as world:
        body = world.load(tmp_path / "turned.xml")["a"]
        body.joints.positions = [0.7]
        found = Worlds(world, 2)["a"].links.poses
        expected = [np.concatenate(tuple(body.links[name].pose)) for name in body.links.names[1:]]
        for world_poses in np.asarray(found):
            assert_allclose(world_poses, expected, rtol=0.0, atol=1e-12)
