"""Colours of bodies without visual shapes, recorded from PyBullet's window."""

from pathlib import Path

import pytest
from tests.viewer.watcher import Watcher

import pybullet as p
import pybullet_data
from carom import World
from carom.viewer.viewer import Viewer
from pybullet._clients.clients import clients

DATA = pybullet_data.getDataPath()
GREEN, YELLOW, RED, BLUE = [60, 186, 84], [244, 194, 13], [219, 50, 54], [72, 133, 237]
ROBOT = """<robot name="r"><link name="a">{body}<collision>{box}</collision></link>
<link name="b">{body}</link>
<link name="c">{body}<visual>{box}</visual></link>
<joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>
<joint name="k" type="fixed"><parent link="b"/><child link="c"/></joint></robot>"""


def box() -> int:
    return p.createMultiBody(1, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1]))


def colours(watcher: Watcher, body: int) -> list[list[float]]:
    shapes = watcher.wait_for(lambda: watcher.shown.get(("body", body)))["shapes"]
    return [[256 * part for part in shape["rgba"][:3]] for shape in shapes]


def test_bodies_without_a_colour_take_turns_as_in_pybullets_window(viewer: Viewer, tmp_path: Path):
    box()
    p.resetSimulation()
    boxes = [box() for _ in range(5)]
    p.loadURDF(f"{DATA}/franka_panda/panda.urdf")
    boxes.append(box())
    p.loadURDF(f"{DATA}/r2d2.urdf")
    boxes.append(box())
    p.removeBody(boxes.pop())
    boxes.append(box())
    robot = tmp_path / "robot.urdf"
    inertial = (
        '<inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    )
    robot.write_text(ROBOT.format(body=inertial, box='<geometry><box size=".2 .2 .2"/></geometry>'))
    p.loadURDF(str(robot))
    boxes.append(box())
    p.loadURDF(str(robot), flags=p.URDF_MERGE_FIXED_LINKS)
    boxes.append(box())
    with Watcher(viewer.address) as watcher:
        seen = [colours(watcher, each)[0] for each in boxes]
    assert seen == [YELLOW, RED, BLUE, GREEN, YELLOW, BLUE, YELLOW, YELLOW, BLUE]


def test_links_take_turns_and_a_stated_colour_stays(viewer: Viewer):
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    chain = p.createMultiBody(
        1, shape, -1, [0, 0, 1], linkMasses=[1, 1], linkCollisionShapeIndices=[shape, shape],
        linkVisualShapeIndices=[-1, -1], linkPositions=[[0, 0, 0.3]] * 2, linkOrientations=[[0, 0, 0, 1]] * 2,
        linkInertialFramePositions=[[0, 0, 0]] * 2, linkInertialFrameOrientations=[[0, 0, 0, 1]] * 2,
        linkParentIndices=[0, 1], linkJointTypes=[0, 0], linkJointAxis=[[0, 0, 1]] * 2,
    )  # fmt: skip
    visual = p.createVisualShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    white = p.createMultiBody(1, shape, visual)
    painted = box()
    p.changeVisualShape(painted, -1, rgbaColor=[1, 1, 1, 1])
    with Watcher(viewer.address) as watcher:
        assert colours(watcher, chain) == [YELLOW, RED, BLUE]
        assert colours(watcher, white) == colours(watcher, painted) == [[256, 256, 256]]
    # What scripts are told is white, as PyBullet tells them.
    assert [shape[7] for shape in p.getVisualShapeData(chain)] == [(1, 1, 1, 1)] * 3


def in_the_window(viewer: Viewer, bodies: list[int]) -> list[list[float]]:
    with Watcher(viewer.address) as watcher:
        return [colours(watcher, body)[0] for body in bodies]


@pytest.mark.parametrize("shown_before", [True, False])
def test_a_saved_world_keeps_the_colours_of_its_window(viewer: Viewer, tmp_path: Path, shown_before: bool):
    boxes = [box() for _ in range(4)]
    p.removeBody(boxes[0])
    p.changeVisualShape(boxes[3], -1, rgbaColor=[1, 1, 1, 1])
    if shown_before:
        assert in_the_window(viewer, boxes[1:]) == [RED, BLUE, [256, 256, 256]]
    clients[0].world.save(tmp_path / "boxes.carom")
    loaded = World()
    loaded.load(tmp_path / "boxes.carom")
    again = Viewer(loaded, port=0)
    assert in_the_window(again, boxes[1:]) == [RED, BLUE, [256, 256, 256]]
    again.close()
    assert loaded.load_urdf(f"{DATA}/cube_small.urdf").links_before == 4
