"""Targets of stable PD control in any order and of any length, against targets of all joints in order."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pytest

from carom import World
from carom.algorithms.stable_pd import stable_pd_torques
from carom.model.joint_columns import NO_ENTRIES, column_of
from carom.scene.body import Body

ROBOTS = Path(__file__).parents[1] / "pybullet" / "robots"
STEP = 0.01
NO_TURN = [0.0, 0.0, 0.0, 1.0]
TURN = [0.0, 0.6, 0.0, 0.8]

# Position, velocity, forces, kp and kd of a joint.
Target = tuple[list[float], list[float], list[float], float, float]


@pytest.fixture(params=[True, False], ids=["fixed", "floating"])
def zoo(request: pytest.FixtureRequest) -> Body:
    """Its joints are revolute, prismatic, fixed, spherical and continuous."""
    world = World()
    world.gravity = (0.3, -0.2, -9.8)
    body = world.load_urdf(ROBOTS / "zoo.urdf", fixed_base=request.param)
    generator = np.random.default_rng(3)
    for joint, count in enumerate(body.position_count):
        if count:
            position = TURN if count == 4 else generator.uniform(-0.3, 0.3, count).tolist()
            velocity = generator.uniform(-1.0, 1.0, body.velocity_count[joint]).tolist()
            body.set_joint_state(joint, position, velocity)
    return body


def torques_of(body: Body, targets: Sequence[tuple[int, Target]]) -> np.ndarray:
    joints = tuple(joint for joint, _ in targets)
    positions, velocities, forces, kps, kds = zip(*(target for _, target in targets), strict=True)
    columns = column_of(positions), column_of(velocities), column_of(forces)
    return stable_pd_torques(body, joints, *columns, kps, kds, STEP)


def reference(body: Body, targets: Mapping[int, Target]) -> np.ndarray:
    """The torques by a complete target for each joint of the body, filled in number by number."""
    complete: list[tuple[int, Target]] = []
    for joint, count in enumerate(body.position_count):
        freedoms = body.velocity_count[joint]
        aim = [*NO_TURN] if count == 4 else [0.0] * count
        rate, most, kp, kd = [0.0] * freedoms, [0.0] * freedoms, 0.0, 0.0
        if joint in targets:
            position, velocity, force, kp, kd = targets[joint]
            if len(position) == count:
                for k in range(count):
                    aim[k] = position[k]
            for k in range(freedoms):
                if len(velocity) == freedoms:
                    rate[k] = velocity[k]
                most[k] = force[k] if k < len(force) else 100000.0
        complete.append((joint, (aim, rate, most, kp, kd)))
    return torques_of(body, complete)


HINGE: Target = ([0.2], [0.5], [3.0], 40.0, 4.0)
SLIDER: Target = ([0.1], [0.3], [2.0], 30.0, 2.0)
BALL: Target = (TURN, [0.1, 0.2, 0.3], [9.0, 0.1, 9.0], 20.0, 1.0)
LAST: Target = ([-0.4], [0.0], [50.0], 70.0, 7.0)
FIXED: Target = ([], [], [], 1.0, 1.0)


@pytest.mark.parametrize(
    "targets",
    [
        pytest.param([(0, HINGE), (1, SLIDER), (3, BALL), (4, LAST)], id="in order"),
        pytest.param([(4, LAST), (3, BALL), (0, HINGE)], id="some in another order"),
        pytest.param([(3, BALL)], id="one"),
        pytest.param([(0, LAST), (3, BALL), (0, HINGE), (3, (TURN, [], [], 5.0, 0.5))], id="repeated"),
        pytest.param([(2, FIXED), (0, HINGE)], id="with a fixed joint"),
        pytest.param([(2, HINGE), (3, HINGE), (0, BALL), (1, SLIDER)], id="lengths of other joints"),
        pytest.param([(0, HINGE), (3, (TURN[:3], [0.1], [0.5, 7.0], 20.0, 1.0))], id="too short"),
        pytest.param([(0, ([0.2, 0.3], [0.5] * 2, [0.01] * 2, 40.0, 4.0)), (3, BALL)], id="too long"),
        pytest.param([(0, ([], [], [], 40.0, 4.0)), (3, ([], [], [], 20.0, 1.0))], id="empty"),
    ],
)
def test_targets_of_some_joints(zoo: Body, targets: list[tuple[int, Target]]) -> None:
    expected = reference(zoo, dict(targets))
    assert torques_of(zoo, targets).tobytes() == expected.tobytes()
    assert expected.any()


def test_columns_without_entries_are_those_of_empty_entries(zoo: Body) -> None:
    gains = [40.0, 20.0], [4.0, 1.0]
    torques = stable_pd_torques(zoo, (0, 3), NO_ENTRIES, NO_ENTRIES, NO_ENTRIES, *gains, STEP)
    expected = reference(zoo, {0: ([], [], [], 40.0, 4.0), 3: ([], [], [], 20.0, 1.0)})
    assert torques.tobytes() == expected.tobytes()


def test_nothing_is_left_of_earlier_targets(zoo: Body) -> None:
    torques_of(zoo, [(0, HINGE), (3, BALL), (4, LAST)])
    expected = reference(zoo, {1: SLIDER})
    torques_of(zoo, [(0, HINGE), (3, BALL), (4, LAST)])
    torques = torques_of(zoo, [(1, SLIDER)])
    assert torques.tobytes() == expected.tobytes()
    assert np.flatnonzero(torques).tolist() == [zoo.velocity_index[1] - zoo.first_velocity]


def test_items_that_are_no_numbers(zoo: Body) -> None:
    with pytest.raises(TypeError, match="not a float"):
        torques_of(zoo, [(0, (["up"], [], [], 1.0, 1.0))])  # type: ignore[list-item]


def test_bodies_without_moving_joints(tmp_path: Path) -> None:
    file = tmp_path / "stone.urdf"
    file.write_text('<robot name="stone"><link name="a"/></robot>')
    body = World().load_urdf(file)
    assert stable_pd_torques(body, (), NO_ENTRIES, NO_ENTRIES, NO_ENTRIES, [], [], STEP).tolist() == [0.0] * 6
