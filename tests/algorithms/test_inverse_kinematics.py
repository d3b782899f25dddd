"""Inverse kinematics beside PyBullet's recorded answers, and where PyBullet does not arrive."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.algorithms.own_reach import OwnReach
from tests.algorithms.reach_cases import ARMS, CLOSE, ROBOTS, WAYS, Reach, Way, single_calls, two_ends
from tests.physics.aba_reference import rotation
from tests.physics.robots import random_tree
from tests.rings import few

import pybullet as p
import pybullet_data
from carom import World
from carom.algorithms import inverse_kinematics
from carom.algorithms.inverse_kinematics import find_positions
from carom.description import JointType
from pybullet._clients.clients import clients

ORACLE = json.loads(Path(__file__).with_name("reach_oracle.json").read_text(encoding="utf-8"))
ARRIVED = 1e-4
"""PyBullet's own threshold [m]; angles are held to the same number."""


@pytest.fixture(params=ARMS, name="name")
def name_of_arm(request):
    return request.param


@pytest.fixture
def reach(name):
    reach = Reach(p, ARMS[name])
    yield reach
    reach.close()


@pytest.fixture
def own(name):
    own = OwnReach(ARMS[name])
    yield own
    own.close()


@pytest.fixture
def own_panda():
    own = OwnReach(ARMS["panda"])
    yield own
    own.close()


@pytest.fixture
def panda():
    reach = Reach(p, ARMS["panda"])
    yield reach
    reach.close()


@pytest.mark.parametrize("title", few(WAYS, 3))
def test_targets_are_reached_as_often_as_by_pybullet_and_nearly_always(own, name, title):
    way, recorded = WAYS[title], ORACLE[name]["ways"][title]
    targets = own.targets(way.poses)
    answers = [own.ask(way, target) for target in targets]
    reached = sum(own.reached(way, target, answer) for target, answer in zip(targets, answers, strict=True))
    assert reached >= recorded["reached"]
    share = 0.85 if title == "oriented" else 0.99
    assert reached >= share * way.poses
    if way.limited:
        assert all(own.within_limits(answer) for answer in answers)


@pytest.mark.parametrize("rested", [False, True])
def test_targets_are_reached_within_limits_from_anywhere(own, rested):
    """In 20 iterations, as nothing is said of them, and often not near the pose at the start."""
    random, way, reached = np.random.RandomState(11), Way(100), 0
    options = {"lowerLimits": own.lower.tolist(), "upperLimits": own.upper.tolist()}
    if rested:
        options |= {"jointRanges": (own.upper - own.lower).tolist(), "restPoses": own.home.tolist()}
    for target in own.targets(way.poses):
        own.place(random.uniform(own.lower, own.upper))
        answer = own.find(target[0].tolist(), **options)
        assert own.within_limits(answer)
        reached += own.reached(way, target, answer)
    assert reached >= 0.95 * way.poses


@pytest.mark.parametrize("title", few(WAYS, 3))
def test_where_pybullet_arrives_the_answer_is_the_same(own, name, title):
    way, compared = WAYS[title], 0
    threshold = way.options.get("residualThreshold", ARRIVED)
    answers = ORACLE[name]["ways"][title]["answers"]
    for target, answer in zip(own.targets(len(answers)), answers, strict=True):
        distance, angle = own.distances(target, answer)
        arrived = distance <= threshold and (not way.oriented or angle <= threshold)
        if arrived and (not way.limited or own.within_limits(answer)):
            assert_allclose(own.ask(way, target), answer, rtol=0, atol=2e-6)
            compared += 1
    assert compared or ARMS[name].slow or title not in ("100 iterations", "1000 iterations")


def test_an_orientation_gets_pybullets_answer_arrived_or_not(reach, name):
    asked, way = ORACLE[name]["ways"]["oriented"]["answers"], Way(200, oriented=True)
    for target, answer in zip(reach.targets(len(asked)), asked, strict=True):
        assert_allclose(reach.ask(way, target), answer, rtol=0, atol=2e-6)


def is_stuck(reach, target, answer):
    """Whether more than 2 cm and half of the way is left."""
    left, first = reach.distances(target, answer)[0], reach.distances(target, reach.home)[0]
    return left > 0.02 and left > 0.5 * first


def test_an_orientation_is_reached_from_singular_poses_where_pybullet_is_stuck(own_panda):
    """With all joints at 0, the 20 steps sometimes leave more than half of the way."""
    random = np.random.RandomState(3)
    own_panda.home = np.zeros(len(own_panda.joints))
    asked = arrived = 0
    for _ in range(400):
        joints = np.clip(
            0.3 * random.standard_normal(len(own_panda.joints)), own_panda.lower, own_panda.upper
        )
        target = own_panda.place(joints)
        own_panda.place(own_panda.home)
        pybullets = own_panda.find(*target, further=0)
        if is_stuck(own_panda, target, pybullets):
            asked += 1
            own_panda.place(own_panda.home)
            found = own_panda.find(*target, further=200, patience=0.5)
            distance, angle = own_panda.distances(target, found)
            arrived += distance < CLOSE and angle < CLOSE
    assert asked >= 5
    assert arrived >= 0.9 * asked


@pytest.mark.parametrize(
    ("start", "position", "orientation", "expected"),
    [
        ([0] * 7, (0, 0, 1.26), (0, 0, 1, 0.0007963), (0.015468, 0, 0.015468, 0, 0.015468, 0, 3.0935961)),
        (
            [0.1, 0.4, -0.2, -1.0, 0.3, 0.8, 0.0],
            (0.5, 0.1, 0.3),
            (1, 0, 0, 0),
            (0.0871371, 0.5652184, -0.2149306, -1.1594855, 0.2687166, 0.9237933, 2.967934),
        ),
    ],
)
def test_a_damping_holds_joints_as_in_pybullet(start, position, orientation, expected):
    """Answers of PyBullet 3.2.7; the first leaves more than half of the way."""
    client = p.connect(p.DIRECT)
    try:
        path = f"{pybullet_data.getDataPath()}/kuka_iiwa/model.urdf"
        arm = p.loadURDF(path, useFixedBase=True, physicsClientId=client)
        for joint, angle in enumerate(start):
            p.resetJointState(arm, joint, angle, physicsClientId=client)
        damping = [100.0] * 6 + [0.5]
        found = p.calculateInverseKinematics(
            arm, 6, position, orientation, jointDamping=damping, physicsClientId=client
        )
    finally:
        p.disconnect(client)
    assert_allclose(found, expected, rtol=0, atol=2e-6)


def test_more_steps_within_limits_come_nearer():
    """To poses out of reach: within limits 300 steps are the fewest, and more are taken if asked for."""
    reach = Reach(p, ARMS["seven_dof"])
    body = clients[reach.client].world.bodies[reach.body]
    limits = {"lower": reach.lower, "upper": reach.upper, "ranges": reach.upper - reach.lower}
    nearer = 0
    for position, orientation in reach.targets(100):
        target = 1.5 * position, orientation
        reach.place(reach.home)
        few, many = (
            find_positions(
                body,
                [reach.arm.link],
                [target[0]],
                [target[1]],
                iterations=1,
                further=further,
                rest=reach.home,
                **limits,
            )
            for further in (300, 3000)
        )
        first, second = (np.square(reach.distances(target, found)).sum() for found in (few, many))
        assert second <= first + 1e-9
        nearer += second < first - 1e-6
    reach.close()
    assert nearer > 0


# With the others PyBullet has not come to rest when it stops.
@pytest.mark.parametrize("name", [name for name, arm in ARMS.items() if not arm.slow])
def test_single_calls_agree_with_pybullet(reach, name):
    recorded = ORACLE[name]["calls"]
    calls = single_calls(reach)
    # With so few steps PyBullet does not arrive.
    assert calls.keys() - {"three iterations"} == recorded.keys() - {"three iterations"}
    for title in calls.keys() - {"three iterations"}:
        reach.place(reach.home)
        answer = p.calculateInverseKinematics(reach.body, physicsClientId=reach.client, **calls[title])
        assert_allclose(answer, recorded[title], rtol=0, atol=2e-6, err_msg=title)


def test_two_ends_agree_with_pybullet(reach, name):
    arguments = two_ends(reach)
    reach.place(reach.home)
    answer = p.calculateInverseKinematics2(reach.body, physicsClientId=reach.client, **arguments)
    assert_allclose(answer, ORACLE[name]["two ends"], rtol=0, atol=2e-6)


def test_an_answer_is_near_where_pybullets_iteration_was_heading(own_panda):
    """With more iterations PyBullet would come to the same place: the branch does not change."""
    few, many = WAYS["default"], WAYS["1000 iterations"]
    for target in own_panda.targets(40):
        assert_allclose(own_panda.ask(few, target), own_panda.ask(many, target), rtol=0, atol=0.15)


def test_the_same_question_has_the_same_answer_to_the_bit(panda):
    way = WAYS["limits and rest poses, oriented"]
    targets = panda.targets(20)
    first = [panda.ask(way, target) for target in targets]
    assert [panda.ask(way, target) for target in targets] == first


def test_asking_moves_nothing(panda):
    panda.place(panda.home)
    before = p.getJointStates(panda.body, panda.joints, physicsClientId=panda.client)
    p.calculateInverseKinematics(panda.body, 11, [0.4, 0.2, 0.5], physicsClientId=panda.client)
    assert p.getJointStates(panda.body, panda.joints, physicsClientId=panda.client) == before


def test_rest_poses_are_approached_without_the_link_leaving_its_target(own_panda):
    """Called again and again, as control loops do."""
    way = WAYS["limits and rest poses"]
    start = own_panda.home + 0.25
    target = own_panda.place(start)
    freedoms = len(own_panda.joints)
    positions = start
    for _ in range(60):
        own_panda.place(positions)
        positions = own_panda.find(
            target[0],
            lowerLimits=own_panda.lower,
            upperLimits=own_panda.upper,
            jointRanges=[2.0] * freedoms,
            restPoses=own_panda.home,
            maxNumIterations=100,
            residualThreshold=0.0,
        )
        assert own_panda.reached(way, target, positions)
    before, after = (np.abs(q - own_panda.home).sum() for q in (start, np.array(positions)))
    assert after < 0.7 * before


def test_an_arm_stretched_out_straight_bends_to_a_target_on_its_line():
    """The Jacobian has no way inwards there, and PyBullet stays where it is."""
    kuka = OwnReach(ARMS["kuka"])
    stretched = kuka.place(np.zeros(7))[0]
    base = np.array(p.getBasePositionAndOrientation(kuka.body, physicsClientId=kuka.client)[0])
    target = base + 0.6 * (stretched - base)
    kuka.place(np.zeros(7))
    answer = kuka.find(target, maxNumIterations=200)
    assert np.linalg.norm(kuka.place(answer)[0] - target) <= CLOSE
    kuka.close()


def test_a_target_out_of_reach_is_approached_as_far_as_it_goes(own_panda):
    target = np.array([3.0, 1.0, 0.5])
    own_panda.place(own_panda.home)
    answer = own_panda.find(target, maxNumIterations=1000)
    position = own_panda.place(answer)[0]
    shoulder = np.array(
        own_panda.p.getLinkState(own_panda.body, 1, physicsClientId=own_panda.client)[4],
    )
    towards = (target - shoulder) / np.linalg.norm(target - shoulder)
    assert (position - shoulder) @ towards > 0.99 * np.linalg.norm(position - shoulder)
    assert np.linalg.norm(position - shoulder) > 0.8


def test_selective_damping_arrives_too(reach):
    way = WAYS["1000 iterations"]
    for target in reach.targets(100):
        for joint, position in zip(reach.joints, reach.home, strict=True):
            p.resetJointState(reach.body, joint, position, physicsClientId=reach.client)
        answer = p.calculateInverseKinematics(
            reach.body,
            reach.arm.link,
            target[0],
            solver=p.IK_SDLS,
            maxNumIterations=200,
            physicsClientId=reach.client,
        )
        assert reach.reached(way, target, answer)


def link_origin(body, link):
    """World position of a link frame; of a planar joint's link, that of its centre of mass."""
    pose: np.ndarray = body.world.link_pose[body.first_link + 1 + link]
    if body.joint_types[link] == p.JOINT_PLANAR:
        return pose[:3].copy()
    frame = body.link_inertial_frame(link)
    to_link = rotation(pose[3:]) @ rotation(np.array(frame.orientation)).T
    return pose[:3] - to_link @ np.array(frame.position)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("fixed_base", [True, False])
def test_any_kind_of_joint_can_reach(seed, fixed_base):
    """Trees with spherical, planar, sliding and turning joints; positions are the engine's own here."""
    kinds = (JointType.REVOLUTE, JointType.PRISMATIC, JointType.SPHERICAL, JointType.PLANAR, JointType.FIXED)
    body = World().load(random_tree(seed, 8, fixed_base=fixed_base, joint_types=kinds), [0.3, 0.1, -0.2])
    link = 7
    random = np.random.default_rng(seed)

    def place(positions):
        first = 0
        for joint, count in enumerate(body.position_count):
            if count:
                body.set_joint_state(joint, positions[first : first + count], None)
            first += count
        return link_origin(body, link)

    start = body.world.position[body.first_position + 7 :][: sum(body.position_count)].copy()
    moved = start + random.uniform(-0.5, 0.5, len(start))
    first = 0
    for count in body.position_count:
        if count == 4:
            moved[first : first + 4] /= np.linalg.norm(moved[first : first + 4])
        first += count
    target = place(moved)
    place(start)
    found = inverse_kinematics(body, [link], [target], iterations=200, threshold=1e-8)
    assert_allclose(place(found.positions), target, rtol=0, atol=1e-7)
    assert found.success
    assert found.residual <= 1e-8
    assert found.angle_residual == 0.0


def test_spherical_joints_are_given_as_roll_pitch_and_yaw():
    client = p.connect(p.DIRECT)
    chain = p.loadURDF(str(ROBOTS / "spherical_chain.urdf"), useFixedBase=True, physicsClientId=client)
    last = p.getNumJoints(chain, physicsClientId=client) - 1
    angles = [0.3, -0.2, 0.4, -0.5, 0.1, 0.2, 0.6, -0.3, 0.1]

    def place(values):
        for joint in range(3):
            q = p.getQuaternionFromEuler(values[3 * joint : 3 * joint + 3])
            p.resetJointStateMultiDof(chain, joint, q, physicsClientId=client)
        state = p.getLinkState(chain, last, physicsClientId=client)
        assert state is not None
        return state[4]

    target = place(angles)
    place([0.0] * 9)
    answer = p.calculateInverseKinematics(
        chain, last, target, maxNumIterations=100, residualThreshold=1e-7, physicsClientId=client
    )
    assert len(answer) == 9
    assert_allclose(place(answer), target, rtol=0, atol=1e-6)
    start = p.calculateInverseKinematics(chain, -1, target, currentPositions=angles, physicsClientId=client)
    assert_allclose(start, angles, rtol=0, atol=1e-12)
    p.disconnect(client)


def test_numpy_arrays_do_as_well_as_lists(panda):
    target = panda.targets(1)[0]
    lists = panda.ask(WAYS["limits and rest poses, oriented"], target)
    for joint, position in zip(panda.joints, panda.home, strict=True):
        p.resetJointState(panda.body, joint, position, physicsClientId=panda.client)
    arrays = p.calculateInverseKinematics(
        panda.body,
        panda.arm.link,
        np.asarray(target[0]),
        np.asarray(target[1]),
        panda.lower,
        panda.upper,
        panda.upper - panda.lower,
        panda.home,
        currentPositions=None,
        maxNumIterations=1000,
        residualThreshold=1e-5,
        physicsClientId=panda.client,
    )
    assert arrays == lists


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"targetPosition": [1, 2]}, "couldn't extract position vector3"),
        ({"targetPosition": [1, 2, float("nan")]}, "couldn't extract position vector3"),
        ({"targetPosition": None}, "couldn't extract position vector3"),
        ({"bodyUniqueId": 77}, "Error in calculateInverseKinematics There is no body 77"),
        ({"endEffectorLinkIndex": 12}, "Error in calculateInverseKinematics .* has no link 12"),
        ({"endEffectorLinkIndex": -2}, "has no link -2"),
        ({"currentPositions": [0.0] * 7}, "size of input current positions needs to be equal"),
        ({"targetOrientation": [0, 0, 0, 0]}, "length 0"),
        ({"solver": 7}, "neither IK_DLS"),
        ({"lowerLimits": 5}, "lowerLimits is 5, not a list of numbers"),
        ({"lowerLimits": [float("nan")] * 9}, "not a number"),
        ({"jointDamping": ["a"] * 9}, "jointDamping"),
        ({"physicsClientId": 900}, "Not connected to physics server"),
    ],
)
def test_what_does_not_fit_is_refused(panda, arguments, message):
    usual = {
        "bodyUniqueId": panda.body,
        "endEffectorLinkIndex": 11,
        "targetPosition": [0.4, 0.0, 0.5],
        "physicsClientId": panda.client,
    }
    with pytest.raises(p.error, match=message):
        p.calculateInverseKinematics(**(usual | arguments))


def test_arguments_of_the_wrong_kind_raise_type_errors(panda):
    with pytest.raises(TypeError):
        panda.p.calculateInverseKinematics(panda.body, 11)
    with pytest.raises(TypeError):
        panda.p.calculateInverseKinematics(panda.body, "11", [0, 0, 0])
    with pytest.raises(TypeError):
        panda.p.calculateInverseKinematics(endEffectorLinkIndex=11, targetPosition=[0, 0, 0])


def test_a_body_without_moving_joints_cannot_reach():
    client = p.connect(p.DIRECT)
    cube = p.loadURDF(str(ARMS["panda"].file.parents[1] / "cube.urdf"), physicsClientId=client)
    with pytest.raises(p.error, match="no joint that moves"):
        p.calculateInverseKinematics(cube, -1, [0, 0, 0], physicsClientId=client)
    p.disconnect(client)


@pytest.mark.parametrize(
    ("links", "positions", "message"),
    [
        ([], [], "couldn't extract position vector3"),
        ([6], [], "couldn't extract position vector3"),
        ([6], [0.1, 0.2, 0.3], "couldn't extract position vector3"),
        (6, [[0.1, 0.2, 0.3]], "couldn't extract position vector3"),
        ([6], [[0.1, 0.2, 0.3]] * 2, "1 links and 2 positions"),
        ([99], [[0.1, 0.2, 0.3]], "has no link 99"),
    ],
)
def test_what_does_not_fit_several_ends_is_refused(panda, links, positions, message):
    with pytest.raises(p.error, match=message):
        p.calculateInverseKinematics2(panda.body, links, positions, physicsClientId=panda.client)


def test_lists_of_another_length_are_ignored_as_in_pybullet(panda):
    """Many scripts give seven limits for a Panda, whose fingers make it nine joints."""
    target = [0.4, 0.2, 0.5]
    panda.place(panda.home)
    plain = p.calculateInverseKinematics(panda.body, 11, target, physicsClientId=panda.client)
    seven = dict.fromkeys(("lowerLimits", "upperLimits", "jointRanges", "restPoses"), [0.1] * 7)
    given = p.calculateInverseKinematics(panda.body, 11, target, physicsClientId=panda.client, **seven)
    assert given == plain


def test_a_solver_does_not_outlive_its_body():
    world = World()
    body = world.load(random_tree(1, 5, fixed_base=True, joint_types=(JointType.REVOLUTE,)))
    other = world.load(random_tree(2, 5, fixed_base=True, joint_types=(JointType.REVOLUTE,)))
    target = [0.1, 0.1, 0.1]
    before = inverse_kinematics(other, [4], [target])
    inverse_kinematics(body, [4], [target])
    world.remove(body.id)
    assert inverse_kinematics(other, [4], [target]) == before


def test_residuals_say_how_far_the_links_are_from_their_targets():
    world = World()
    body = world.load_urdf("franka_panda/panda.urdf", fixed_base=True)
    link = body.links["panda_hand"].index
    turn = (1.0, 0.0, 0.0, 0.0)
    for place, arrives in (((0.5, 0.1, 0.4), True), ((0.5, 0.1, 4.0), False)):
        found = inverse_kinematics(body, [link], [place], [turn], iterations=300)
        assert found.success == arrives
        body.joints.reset(found.positions)
        hand = body.links["panda_hand"]
        assert found.residual == pytest.approx(np.linalg.norm(hand.pose.position - place), abs=1e-9)
        cosine = abs(hand.inertial_pose.orientation @ turn)
        assert found.angle_residual == pytest.approx(2.0 * np.arccos(min(cosine, 1.0)), abs=1e-6)
        assert (found.residual < 1e-3) == arrives


def folder_with_turned_hand(folder: Path) -> Path:
    """A KUKA whose hand has its principal axes of inertia askew."""
    text = Path(pybullet_data.getDataPath(), "kuka_iiwa", "model.urdf").read_text(encoding="utf-8")
    before, name, after = text.partition('<link name="lbr_iiwa_link_7"')
    askew = re.sub(
        r"<inertia [^>]*/>",
        '<inertia ixx=".002" ixy=".001" ixz="0" iyy=".003" iyz="0" izz=".004"/>',
        after,
        count=1,
    )
    assert askew != after
    (folder / "kuka.urdf").write_text(
        re.sub(r"<(visual|collision)>.*?</\1>", "", before + name + askew, flags=re.S)
    )
    return folder / "kuka.urdf"


def test_links_are_named_and_their_targets_are_poses_of_link_frames(tmp_path: Path):
    """Of a link whose inertial frame is turned: where it is, is what is found."""
    world = World()
    path = folder_with_turned_hand(tmp_path)
    arm = world.load(path, fixed_base=True)[0]
    wanted = [0.3, -0.4, 0.2, 1.1, -0.2, 0.5, 0.4]
    arm.joints.positions = wanted
    hand = arm.links[-1 + arm.joint_count]
    pose = hand.pose
    turned = np.abs(np.dot(pose.orientation, hand.inertial_pose.orientation))
    arm.joints.positions = np.array(wanted) + 0.1
    for link in (hand.name, hand.index):
        found = inverse_kinematics(arm, [link], [pose.position], [pose.orientation])
        assert found.success
        arm.joints.positions = found.positions
        assert_allclose(hand.pose.position, pose.position, atol=2e-4)
        assert abs(np.dot(hand.pose.orientation, pose.orientation)) > 1.0 - 1e-7
        arm.joints.positions = np.array(wanted) + 0.1
    assert turned < 0.999
    with pytest.raises(KeyError, match="no link is called 'hand'"):
        inverse_kinematics(arm, ["hand"], [pose.position])
    with pytest.raises(ValueError, match="a quaternion for each link"):
        inverse_kinematics(arm, [hand.index], [pose.position], [(0.0, 0.0, 1.0)])
