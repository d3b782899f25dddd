"""The order of contacts of robots whose links are in the floor when they are made, as PyBullet 3.2.7 has it.

PyBullet looks for pairs while it makes a body: the frames of links then stand for their inertial frames.
Pairs that met only there, and pairs of one body, change the places of the others. Expected are the links in
contact, in their order, after the first and the third step.
"""

from __future__ import annotations

from random import Random

import pytest

import pybullet as p

LINKS = 7
CASES = [
    (2, True, [0, 1, 2, 3, 6, 4], [0, 1, 2, 3, 6, 4]),
    (10, True, [0, 3, 6, 5, 1, 4, 2], [0, 3, 6, 2, 1, 4]),
    (14, True, [6, 2, 3, 4, 5, 0], [6, 2, 3, 4, 5]),
    (24, True, [1, 4, 5, 6, 3], [1, 4, 5, 6, 3]),
    (26, True, [1, 2, 6, 5, 4], [1, 2, 5]),
    (2, False, [3, 2, 1, 6, 0, 4], [3, 2, 1, 6, 0, 4]),
    (10, False, [3, 0, 6, 1, 2, 5, 4], [3, 0, 6, 1, 2, 4]),
    (14, False, [5, 4, 3, 2, 0, 6], [5, 4, 3, 2, 6]),
    (17, False, [0, 3, 6, 1, 2], [0, 3, 6, 1, 2]),
    (24, False, [5, 4, 6, 1, 3], [5, 4, 6, 1, 3]),
]


def vector(random: Random, most: float) -> list[float]:
    return [round(random.uniform(-most, most), 3) for _ in range(3)]


def make_robot(random: Random, height: float = 0.1) -> int:
    """A tree of boxes whose centres of mass lie off the frames of their links, where the boxes are."""
    boxes = [
        p.createCollisionShape(
            p.GEOM_BOX, halfExtents=[round(random.uniform(0.03, 0.1), 3) for _ in range(3)]
        )
        for _ in range(LINKS + 1)
    ]
    return p.createMultiBody(
        1,
        boxes[LINKS],
        -1,
        [0, 0, height],
        baseInertialFramePosition=vector(random, 0.15),
        linkMasses=[1] * LINKS,
        linkCollisionShapeIndices=boxes[:LINKS],
        linkVisualShapeIndices=[-1] * LINKS,
        linkPositions=[vector(random, 0.2) for _ in range(LINKS)],
        linkOrientations=[[0, 0, 0, 1]] * LINKS,
        linkInertialFramePositions=[vector(random, 0.2) for _ in range(LINKS)],
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * LINKS,
        linkParentIndices=[random.randrange(link + 1) for link in range(LINKS)],
        linkJointTypes=[p.JOINT_REVOLUTE] * LINKS,
        linkJointAxis=[[1, 0, 0]] * LINKS,
    )


def make_floor() -> int:
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[9, 9, 0.5])
    return p.createMultiBody(0, shape, basePosition=[0, 0, -0.5])


def links_in_contact(robot: int) -> list[int]:
    """The robot's links that touch, each once for all of its points that follow each other."""
    links: list[int] = []
    for _, _, body, link_a, link_b, *_ in p.getContactPoints():
        link = link_b if body == robot else link_a
        if links[-1:] != [link]:
            links.append(link)
    return links


@pytest.mark.usefixtures("client")
@pytest.mark.parametrize(("seed", "floor_first", "first", "third"), CASES)
def test_contacts_of_what_is_made_in_the_floor(
    seed: int, floor_first: bool, first: list[int], third: list[int]
) -> None:
    random = Random(seed)
    p.setGravity(0, 0, -9.8)
    if floor_first:
        make_floor()
    robot = make_robot(random)
    if not floor_first:
        make_floor()
    p.stepSimulation()
    assert links_in_contact(robot) == first
    p.stepSimulation()
    p.stepSimulation()
    assert links_in_contact(robot) == third


@pytest.mark.usefixtures("client")
def test_more_pairs_part_than_there_is_room_for_at_first() -> None:
    # All links are made in one place, so that each meets each; two of three touch the floor.
    p.setGravity(0, 0, -9.8)
    make_floor()
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    count = 110
    places = [[0.5 * (link % 8), 0.5 * (link // 8), -0.3 + 0.05 * (link % 3)] for link in range(count)]
    robot = p.createMultiBody(
        1,
        box,
        -1,
        [0, 0, 0.35],
        linkMasses=[1] * count,
        linkCollisionShapeIndices=[box] * count,
        linkVisualShapeIndices=[-1] * count,
        linkPositions=places,
        linkOrientations=[[0, 0, 0, 1]] * count,
        linkInertialFramePositions=places,
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * count,
        linkParentIndices=[0] * count,
        linkJointTypes=[p.JOINT_FIXED] * count,
        linkJointAxis=[[1, 0, 0]] * count,
    )
    p.stepSimulation()
    assert links_in_contact(robot) == [link for link in reversed(range(count)) if link % 3 < 2]
