"""Rays, nearest points and overlaps; expected values are real PyBullet's."""

import math
from typing import Any

import numpy as np
import pytest
from tests.pybullet.contacts.touching import add_pair

import pybullet as p
import pybullet_data

NOTHING: Any = None
NUMBER: Any = 3
MISS = (-1, -1, 1.0, (0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
TWO_LINKS = """<robot name="two">
  <link name="b">
    <inertial><origin xyz="0.1 0.2 0.3" rpy="0 0 1.5707963"/><mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><sphere radius="0.2"/></geometry></collision>
  </link>
  <link name="c">
    <inertial><origin xyz="0.1 0.2 0.3" rpy="0 0 1.5707963"/><mass value="1"/>
      <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><origin xyz="0.1 0.2 0.3"/><geometry><box size=".2 .3 .4"/></geometry></collision>
  </link>
  <joint name="j" type="revolute"><parent link="b"/><child link="c"/><origin xyz="1 0 0"/>
    <axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="9" velocity="9"/></joint>
</robot>"""


@pytest.fixture
def things(client):
    """A plane, a unit box 1 m up, a sphere beside it."""
    shapes = [
        p.createCollisionShape(p.GEOM_PLANE),
        p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 0.5, 0.5]),
        p.createCollisionShape(p.GEOM_SPHERE, radius=0.3),
    ]
    places = [(0, 0, 0), (0, 0, 1), (2, 0, 1)]
    return [
        p.createMultiBody(mass, shape, basePosition=place)
        for mass, shape, place in zip((0, 1, 1), shapes, places, strict=True)
    ]


@pytest.fixture
def turned(client, tmp_path):
    file = tmp_path / "two.urdf"
    file.write_text(TWO_LINKS)
    return p.loadURDF(str(file), [0, 0, 2], [0, 0, math.sin(0.3), math.cos(0.3)], useFixedBase=True)


def close(hit, body, fraction, position, normal):
    assert hit[:2] == (body, -1)
    assert hit[2] == pytest.approx(fraction, abs=1e-9)
    assert hit[3] == pytest.approx(position, abs=1e-9)
    assert hit[4] == pytest.approx(normal, abs=1e-6)


def test_a_ray_reports_what_it_hits_first(things):
    _plane, box, _sphere = things
    (hit,) = p.rayTest([0, 0, 5], [0, 0, -5])
    close(hit, box, 0.35, (0, 0, 1.5), (0, 0, 1))


def test_rays_that_hit_nothing(things):
    assert p.rayTest([9, 9, 5], [9, 9, 4]) == (MISS,)
    assert p.rayTest([0, 0, 1], [0, 0, 5]) == (MISS,), "from within"
    assert p.rayTest([0, 0, 5], [0, 0, 5]) == (MISS,), "without length"
    assert p.rayTest([-5, 0, 1], [5, 0, 1], 2) == (MISS,), "by the mask"
    assert p.rayTestBatch([], []) == ()


def test_a_world_without_bodies_is_empty(client):
    assert p.rayTest([0, 0, 5], [0, 0, -5]) == (MISS,)
    assert p.getOverlappingObjects([-1, -1, -1], [1, 1, 1]) is None
    assert p.getClosestPoints(0, 1, 5) == ()


def test_later_hits_are_numbered_along_the_ray(things):
    _plane, box, sphere = things
    ray = [-5, 0, 1], [5, 0, 1]
    close(p.rayTest(*ray, reportHitNumber=0)[0], box, 0.45, (-0.5, 0, 1), (-1, 0, 0))
    close(p.rayTest(*ray, reportHitNumber=1)[0], sphere, 0.67, (1.7, 0, 1), (-1, 0, 0))
    assert p.rayTest(*ray, reportHitNumber=2) == (MISS,)


@pytest.mark.parametrize(("epsilon", "counts"), [(0.1, True), (0.3, False)])
def test_later_hits_on_a_link_have_to_be_some_way_behind_the_ones_before(client, epsilon, counts):
    shapes = {"shapeTypes": [p.GEOM_SPHERE] * 2, "radii": [0.3] * 2}
    pair = p.createCollisionShapeArray(**shapes, collisionFramePositions=[[0, 0, 1], [2, 0, 1]])
    body = p.createMultiBody(0, pair)
    # One ball is hit a fifth of the ray behind the other.
    (hit,) = p.rayTestBatch([[-5, 0, 1]], [[5, 0, 1]], reportHitNumber=1, fractionEpsilon=epsilon)
    assert hit[0] == (body if counts else -1)


@pytest.mark.parametrize("make", [np.array, list, tuple])
def test_a_batch_is_its_rays_one_by_one(things, make):
    rng = np.random.default_rng(0)
    starts, ends = rng.normal(size=(200, 3)) * 4, rng.normal([1, 0, 1], size=(200, 3))
    batch = p.rayTestBatch(make(starts), make(ends), numThreads=0)
    assert batch == tuple(p.rayTest(start, end)[0] for start, end in zip(starts, ends, strict=True))
    assert {hit[0] for hit in batch} == {-1, *things}


def test_the_largest_batch(things):
    most = p.MAX_RAY_INTERSECTION_BATCH_SIZE
    assert len(p.rayTestBatch([[0, 0, 5]] * most, [[0, 0, -5]] * most)) == most
    with pytest.raises(p.error, match="Number of rays exceed the maximum batch size"):
        p.rayTestBatch([[0, 0, 5]] * (most + 1), [[0, 0, -5]] * (most + 1))


@pytest.mark.parametrize(
    ("link", "position"), [(-1, (-0.6124554836, 0.1868108337)), (0, (0.2128801313, 0.7514533071))]
)
def test_rays_in_the_frame_of_a_link(turned, link, position):
    floor = p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[50, 50, 0.01]))
    (hit,) = p.rayTestBatch([[0.3, 0.5, 0]], [[0.3, 0.5, -10]], 1, turned, link)
    close(hit, floor, 0.229, (*position, 0.01), (0, 0, 1))


def test_rays_in_the_frame_of_no_link_are_in_that_of_the_world(turned):
    start, end = [0.05, 0.1, 5], [0.05, 0.1, -5]
    hits = p.rayTest(start, end)
    assert hits[0][0] == turned
    for link in (1, 7, -2):
        assert p.rayTestBatch([start], [end], 1, turned, link) == hits


def test_rays_see_where_bodies_are_now(things):
    sphere = things[2]
    p.resetBasePositionAndOrientation(sphere, [20, 0, 0], [0, 0, 0, 1])
    close(p.rayTest([20, 0, 5], [20, 0, -5])[0], sphere, 0.47, (20, 0, 0.3), (0, 0, 1))
    p.removeBody(things[1])
    close(p.rayTest([0, 0, 5], [0, 0, -5])[0], things[0], 0.5, (0, 0, 0), (0, 0, 1))


@pytest.mark.parametrize(
    ("call", "problem"),
    [
        (lambda: p.rayTest([0, 0], [1, 1, 1]), "rayFromPosition has 2 values"),
        (lambda: p.rayTest([0, 0, 0], NOTHING), "rayToPosition is None"),
        (lambda: p.rayTest([math.nan, 0, 0], [1, 1, 1]), "nan"),
        (lambda: p.rayTestBatch([[0, 0, 0]], []), "Size of from_positions"),
        (lambda: p.rayTestBatch(NOTHING, []), "must be not None"),
        (lambda: p.rayTestBatch([[0, 0]], [[1, 1, 1]]), r"rayFromPositions\[0\] has 2"),
        (lambda: p.rayTestBatch([[0, 0, 1], [0, math.inf, 0]], [[1, 1, 1]] * 2), r"rayFromPositions\[1\]"),
        (lambda: p.rayTestBatch(NUMBER, [[1, 1, 1]]), "rayFromPositions is 3"),
        (lambda: p.rayTest([0, 0, 0], [1, 1, 1], physicsClientId=7), "Not connected"),
        (lambda: p.getOverlappingObjects([0, 0], [1, 1, 1]), "aabbMin has 2 values"),
        (lambda: p.getOverlappingObjects([0, 0, 0], NOTHING), "aabbMax is None"),
        (lambda: p.getClosestPoints(0, 1, math.nan), "distance"),
    ],
)
def test_bad_input_is_refused(things, call, problem):
    with pytest.raises(p.error, match=problem):
        call()


def test_nearest_points_of_two_bodies(things):
    _plane, box, sphere = things
    (point,) = p.getClosestPoints(box, sphere, 5)
    assert point[:5] == (0, box, sphere, -1, -1)
    assert point[5] == pytest.approx((0.5, 0, 1))
    assert point[6] == pytest.approx((1.7, 0, 1))
    assert point[7] == pytest.approx((-1, 0, 0))
    assert point[8] == pytest.approx(1.2)
    assert point[9:] == (0.0, 0.0, (0.0, 0.0, 0.0), 0.0, (0.0, 0.0, 0.0))
    (back,) = p.getClosestPoints(sphere, box, math.inf)
    assert (back[5], back[6]) == (point[6], point[5])


def test_no_nearest_points(things):
    _plane, box, sphere = things
    assert p.getClosestPoints(box, sphere, 0.1) == ()
    assert p.getClosestPoints(box, sphere, 5, 0, -1) == ()
    assert p.getClosestPoints(box, 99, 5) == ()
    assert p.getClosestPoints(box, -1, 5) == ()


def test_nearest_points_of_chosen_links(turned):
    floor = p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[50, 50, 0.01]))
    points = p.getClosestPoints(turned, floor, 9)
    assert [(point[3], pytest.approx(point[8])) for point in points] == [(-1, 1.79), (0, 2.09)]
    assert p.getClosestPoints(turned, floor, 9, -1) == points[:1]
    assert p.getClosestPoints(turned, floor, 9, 0) == points[1:]
    assert p.getClosestPoints(turned, floor, 9, -2, -1) == points
    within = p.getClosestPoints(turned, turned, 9)
    assert [point[3:5] for point in within] == [(-1, -1), (-1, 0), (0, -1), (0, 0)]
    assert within[1][8] == pytest.approx(0.8063743097776517)


def test_overlaps_with_a_box(things):
    plane, box, sphere = things
    assert p.getOverlappingObjects([-1, -1, 0.1], [1, 1, 3]) == ((plane, -1), (box, -1))
    assert p.getOverlappingObjects([-9, -9, -9], [9, 9, 9]) == ((plane, -1), (box, -1), (sphere, -1))
    assert p.getOverlappingObjects([10, 10, 10], [11, 11, 11]) == ((plane, -1),)
    p.removeBody(plane)
    assert p.getOverlappingObjects([10, 10, 10], [11, 11, 11]) is None


def test_overlaps_with_what_has_no_shape(client: int) -> None:
    """Its bounds are a point; in a URDF file those of a link are a cube of two millimetres."""
    body = add_pair(1.0, -1)
    assert p.getOverlappingObjects([0, -1, 0], [1.4, 1, 1]) == ((body, -1),)
    assert p.getOverlappingObjects([1.5, 0, 0], [2, 1, 1]) == ((body, 0),)
    assert p.getOverlappingObjects([0, 0.0001, 0], [2, 1, 1]) is None
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    ball = p.createMultiBody(1, shape, basePosition=[1.5, 0.5, 0.5])
    # Later calls take another way than the first ones.
    for _ in range(4):
        assert p.getOverlappingObjects([1.5, 0, 0], [2, 1, 1]) == ((body, 0), (ball, -1))
    p.removeBody(ball)
    p.resetBasePositionAndOrientation(body, [5, 5, 5], [0, 0, 0, 1])
    assert p.getOverlappingObjects([4, 4, 4], [6, 6, 7]) == ((body, -1), (body, 0))
    panda = p.loadURDF(f"{pybullet_data.getDataPath()}/franka_panda/panda.urdf", useFixedBase=True)
    (x, y, z), _ = p.getAABB(panda, 7)
    assert (panda, 7) in (p.getOverlappingObjects([x - 1, y - 1, z - 1], [x, y, z]) or ())
    assert (panda, 7) not in (p.getOverlappingObjects([x - 1, y - 1, z - 1], [x - 1e-6, y, z]) or ())


def test_questions_between_steps_change_nothing(things):
    def run(ask):
        p.resetBasePositionAndOrientation(things[1], [0, 0, 1], [0, 0, 0, 1])
        p.resetBaseVelocity(things[1], [0.3, 0, 0], [1, 2, 3])
        p.setGravity(0, 0, -9.81)
        p.performCollisionDetection()
        for _ in range(200):
            p.stepSimulation()
            if ask:
                p.rayTest([0, 0, 5], [0, 0, -5])
                p.getClosestPoints(things[0], things[1], 1)
                p.getOverlappingObjects([-1, -1, -1], [1, 1, 1])
        return p.getBasePositionAndOrientation(things[1]), p.getBaseVelocity(things[1])

    quiet = run(ask=False)
    assert run(ask=True) == quiet


def height_and_gap(box) -> tuple[float, float]:
    """Where a ray from above hits the box, and how far it is from the plane."""
    ((body, _, _, position, _),) = p.rayTest([0, 0, 9], [0, 0, -9])
    assert body == box
    return position[2], p.getClosestPoints(box, 0, 20)[0][8]


def test_answers_follow_every_way_to_move_a_body(things):
    _plane, box, sphere = things
    assert height_and_gap(box) == pytest.approx((1.5, 0.5))
    p.resetBasePositionAndOrientation(box, [0, 0, 3], [0, 0, 0, 1])
    assert height_and_gap(box) == pytest.approx((3.5, 2.5))
    saved = p.saveState()
    p.setGravity(0, 0, -10)
    z = 3.0
    for _ in range(3):
        p.stepSimulation()
        before, z = z, p.getBasePositionAndOrientation(box)[0][2]
        assert z < before
        assert height_and_gap(box) == pytest.approx((z + 0.5, z - 0.5))
        assert height_and_gap(box) == pytest.approx((z + 0.5, z - 0.5))
    # Nothing moves here, but the places of the last step are found again.
    p.performCollisionDetection()
    assert height_and_gap(box) == pytest.approx((z + 0.5, z - 0.5))
    p.restoreState(saved)
    assert height_and_gap(box) == pytest.approx((3.5, 2.5))
    p.removeBody(sphere)
    assert height_and_gap(box) == pytest.approx((3.5, 2.5))


def test_answers_follow_a_joint(turned):
    def tip() -> float:
        return p.getClosestPoints(turned, turned, 9, -1, 0)[0][8]

    before = tip()
    p.resetJointState(turned, 0, 2.0)
    after = tip()
    assert after < before - 0.1
    assert tip() == after
    p.resetJointState(turned, 0, 0.0)
    assert tip() == before


def test_answers_follow_a_margin(client):
    corners = [[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    shape = p.createCollisionShape(p.GEOM_MESH, vertices=corners)
    body = p.createMultiBody(1, shape)
    at = [p.rayTest([0, 0, 9], [0, 0, -9])[0][3][2]]
    p.changeDynamics(body, -1, collisionMargin=0.1)
    at.append(p.rayTest([0, 0, 9], [0, 0, -9])[0][3][2])
    assert at[1] > at[0] + 0.05


def test_a_mask_of_rays_counts_when_it_changes(things):
    box = things[1]
    assert p.rayTest([0, 0, 9], [0, 0, 0.9])[0][0] == box
    p.setCollisionFilterGroupMask(box, -1, 2, 1)
    assert p.rayTest([0, 0, 9], [0, 0, 0.9], collisionFilterMask=1)[0][0] == -1
    assert p.rayTest([0, 0, 9], [0, 0, 0.9], collisionFilterMask=2)[0][0] == box


def height(body: int) -> float:
    """Of the centre of mass of the first link, as getLinkState has it."""
    state = p.getLinkState(body, 0)
    assert state is not None
    return state[0][2]


@pytest.mark.parametrize(
    ("call", "brings_up_to_date"),
    [
        (lambda body: p.rayTest([0, 0, 5], [0, 0, 0]), False),
        (lambda body: p.rayTestBatch([[0, 0, 5]], [[0, 0, 0]], 1, body, 0), False),
        (lambda body: p.getClosestPoints(body, body, 1), False),
        (lambda body: p.performCollisionDetection(), False),
        (lambda body: p.getCameraImage(4, 4), False),
        (lambda body: p.resetJointState(body, 0, 0), True),
        (lambda body: p.resetBaseVelocity(body, [0, 0, 0]), True),
        (lambda body: p.getLinkState(body, 0, computeForwardKinematics=1), True),
    ],
)
def test_which_calls_bring_links_up_to_date_after_a_step(client, tmp_path, call, brings_up_to_date) -> None:
    (tmp_path / "two.urdf").write_text(TWO_LINKS)
    body = p.loadURDF(str(tmp_path / "two.urdf"), [0, 0, 9])
    p.setGravity(0, 0, -10)
    for _ in range(10):
        p.stepSimulation()
    before = height(body)
    call(body)
    assert (height(body) < before - 1e-4) == brings_up_to_date


def test_rays_of_a_link_start_where_it_was_at_the_start_of_the_last_substep(client, tmp_path) -> None:
    (tmp_path / "two.urdf").write_text(TWO_LINKS)
    body = p.loadURDF(str(tmp_path / "two.urdf"), [0, 0, 9])
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 9, 99]), basePosition=[5, 0, 0])
    p.resetBaseVelocity(body, [0, 0, -24])
    p.stepSimulation()
    (hit,) = p.rayTestBatch([[0, -1, 0]], [[0, -9, 0]], 1, body, 0)
    assert hit[3][2] == pytest.approx(height(body))
    (hit,) = p.rayTestBatch([[0, -1, 0]], [[0, -9, 0]], 1, body, -1)
    assert hit[3][2] == pytest.approx(p.getBasePositionAndOrientation(body)[0][2])


@pytest.mark.parametrize(("link", "distance"), [(-1, 0.18667658806331805), (0, 0.863273728645406)])
def test_shapes_without_bodies_are_near_what_has_just_moved(client, link, distance):
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    two = p.createMultiBody(
        1,
        ball,
        basePosition=[0.3, 0.1, 0.4],
        linkMasses=[1],
        linkCollisionShapeIndices=[ball],
        linkVisualShapeIndices=[-1],
        linkPositions=[[1, 0, 0]],
        linkOrientations=[[0, 0, 0, 1]],
        linkInertialFramePositions=[[0, 0, 0]],
        linkInertialFrameOrientations=[[0, 0, 0, 1]],
        linkParentIndices=[0],
        linkJointTypes=[p.JOINT_REVOLUTE],
        linkJointAxis=[[0, 0, 1]],
    )
    p.setGravity(0, 0, -9.8)
    p.setPhysicsEngineParameter(numSubSteps=4)
    p.resetBaseVelocity(two, [0, 0, -1], [0, 2, 0])
    for _ in range(3):
        p.stepSimulation()
    below = {"collisionShapeB": ball, "collisionShapePositionB": [0.3, 0.1, 0]}
    (point,) = p.getClosestPoints(two, -1, 5, linkIndexA=link, **below)
    assert point[8] == pytest.approx(distance, abs=1e-12)
