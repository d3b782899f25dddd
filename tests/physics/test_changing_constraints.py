"""Constraints that come and go while a world runs: what steps know is renewed no more than it has to be."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any

import pytest
from tests.rings import few

import pybullet as p
import pybullet_data
from carom.layouts.contacts import SORTED
from carom.native.launch import KernelStructs
from carom.scene.constraint_rows import ConstraintRows
from carom.world.world import World
from pybullet._clients.clients import clients

ROBOT = f"{pybullet_data.getDataPath()}/kuka_iiwa/model.urdf"


def _story(seed: int, *, floor: bool) -> list[Any]:
    """What a script sees that ties, unties, changes and steps a world at random."""
    random = Random(seed)
    client = p.connect(p.DIRECT)
    seen: list[Any] = []
    try:
        p.setGravity(0, 0, -10, physicsClientId=client)
        box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=client)
        if floor:
            plane = p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client)
            p.createMultiBody(0, plane, physicsClientId=client)
        for number in range(1 if floor else 3):
            place = [0, 0, 0.5 + 2 * number]
            p.loadURDF(ROBOT, place, useFixedBase=random.random() < 0.5, physicsClientId=client)
        for number in range(3):
            shape = box if floor else -1
            p.createMultiBody(1.0, shape, basePosition=[1, 0, 0.1 + 0.21 * number], physicsClientId=client)
        ties: list[int] = []
        for _ in range(60):
            bodies = [it.id for it in clients[client].world.bodies if it.id > 0 or not floor]
            a, b = random.choice(bodies), random.choice([-1, *bodies])
            what = random.choice(
                ["tie", "tie", "untie", "untie", "pull", "step", "step", "step", "weigh", "place", "near"]
            )
            if what == "tie" and a != b:
                kind = random.choice([p.JOINT_FIXED, p.JOINT_POINT2POINT])
                ends = [0.0, 0.0, 0.2], [random.uniform(-0.3, 0.3) for _ in range(3)]
                ties.append(p.createConstraint(a, -1, b, -1, kind, [0, 0, 0], *ends, physicsClientId=client))
            elif what == "untie" and ties:
                p.removeConstraint(ties.pop(random.randrange(len(ties))), physicsClientId=client)
            elif what == "pull" and ties:
                p.changeConstraint(random.choice(ties), [0, 0, 1], maxForce=9.0, physicsClientId=client)
            elif what == "step":
                p.stepSimulation(client)
            elif what == "weigh":
                p.changeDynamics(a, -1, mass=random.choice([0.0, 1.0, 2.0]), physicsClientId=client)
            elif what == "place":
                p.resetBasePositionAndOrientation(a, [0, 1, random.random()], [0, 0, 0, 1], client)
            elif what == "near":
                seen.append(p.getClosestPoints(a, 0, 1.0, physicsClientId=client))
            elif random.random() < 0.2:
                p.createMultiBody(1.0, box, basePosition=[2, 0, 1], physicsClientId=client)
            elif random.random() < 0.2:
                p.loadURDF(ROBOT, [0, 0, 10 + 2 * len(bodies)], useFixedBase=True, physicsClientId=client)
            seen += [
                (p.getBasePositionAndOrientation(body, client), p.getBaseVelocity(body, client))
                for body in bodies
            ]
            seen.append(p.getContactPoints(physicsClientId=client))
        return seen
    finally:
        p.disconnect(client)


@pytest.mark.parametrize("seed", few(range(12), 4))
@pytest.mark.parametrize("floor", [True, False], ids=["on a floor", "apart"])
def test_what_is_kept_is_what_would_be_made_anew(
    floor: bool, seed: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    kept = _story(seed, floor=floor)
    monkeypatch.setattr(World, "constraints_changed", World.scene_changed)
    assert kept == _story(seed, floor=floor)


def test_rows_of_other_constraints_are_left_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """What ties and unties a body in each step does not make the rows of all motors anew."""
    client = p.connect(p.DIRECT)
    try:
        p.loadURDF(ROBOT, useFixedBase=True, physicsClientId=client)
        body = p.createMultiBody(1.0, physicsClientId=client)

        def tie_and_untie() -> None:
            ties = [
                p.createConstraint(body, -1, -1, -1, kind, [0] * 3, [0] * 3, [0] * 3, physicsClientId=client)
                for kind in (p.JOINT_FIXED, p.JOINT_POINT2POINT)
            ]
            p.stepSimulation(client)
            for tie in ties:
                p.removeConstraint(tie, physicsClientId=client)
            p.stepSimulation(client)

        tie_and_untie()
        monkeypatch.setattr(ConstraintRows, "sort", _refuse)
        for _ in range(3):
            tie_and_untie()
    finally:
        p.disconnect(client)


def _refuse(*_: Any) -> None:
    raise AssertionError("what was there has been made anew")


def test_launches_are_those_of_before(monkeypatch: pytest.MonkeyPatch) -> None:
    """Tying and untying a body makes no launch anew, once there is room for its constraint."""
    client = p.connect(p.DIRECT)
    try:
        box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=client)
        for place in range(2):
            p.createMultiBody(1.0, box, basePosition=[place, 0, 0], physicsClientId=client)

        def tie_and_step() -> None:
            tie = p.createConstraint(
                0, -1, -1, -1, p.JOINT_FIXED, [0] * 3, [0] * 3, [0] * 3, physicsClientId=client
            )
            p.stepSimulation(client)
            p.removeConstraint(tie, physicsClientId=client)

        tie_and_step()

        engine = clients[client].world.engine
        monkeypatch.setattr(engine, "_make_program", _refuse)
        for _ in range(3):
            tie_and_step()
    finally:
        p.disconnect(client)


def _robot_after_a_tie() -> list[Any]:
    """Joints of a robot that was loaded while a body was tied, after that was let go."""
    client = p.connect(p.DIRECT)
    try:
        p.setGravity(0, 0, -10, physicsClientId=client)
        body = p.createMultiBody(1.0, physicsClientId=client)
        tie = p.createConstraint(
            body, -1, -1, -1, p.JOINT_FIXED, [0] * 3, [0] * 3, [0] * 3, physicsClientId=client
        )
        robot = p.loadURDF(ROBOT, useFixedBase=True, physicsClientId=client)
        for joint in range(7):
            p.setJointMotorControl2(robot, joint, p.POSITION_CONTROL, 0.5, force=80, physicsClientId=client)
        p.stepSimulation(client)
        p.removeConstraint(tie, physicsClientId=client)
        for _ in range(20):
            p.stepSimulation(client)
        return [p.getJointState(robot, joint, client) for joint in range(7)]
    finally:
        p.disconnect(client)


def test_motors_are_relaxed_in_the_order_that_a_removal_leaves(monkeypatch: pytest.MonkeyPatch) -> None:
    """The last motor takes the place of the tie in Bullet's list, so all have to be sorted again."""
    kept = _robot_after_a_tie()
    monkeypatch.setattr(World, "constraints_changed", World.scene_changed)
    assert kept == _robot_after_a_tie()


def _tied_box(break_off: Callable[[], None]) -> list[Any]:
    """Where a box on a floor is that is tied, after the first step has been broken off."""
    client = p.connect(p.DIRECT)
    try:
        p.setGravity(0, 0, -10, physicsClientId=client)
        plane = p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client)
        box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=client)
        bodies = [
            p.createMultiBody(mass, shape, physicsClientId=client) for mass, shape in enumerate([plane, box])
        ]
        p.stepSimulation(client)
        kind, none = p.JOINT_POINT2POINT, [0, 0, 0]
        p.createConstraint(bodies[1], -1, -1, -1, kind, none, none, [1, 0, 1], physicsClientId=client)
        break_off()
        for _ in range(10):
            p.stepSimulation(client)
        return [p.getBasePositionAndOrientation(bodies[1], client)]
    finally:
        p.disconnect(client)


def test_a_step_that_is_broken_off_leaves_no_old_settings(monkeypatch: pytest.MonkeyPatch) -> None:
    """Kernels count on the numbers of constraints in their copies of the settings."""

    def break_off() -> None:
        with monkeypatch.context() as patch:
            patch.setattr(KernelStructs, "changed", _interrupt)
            with pytest.raises(KeyboardInterrupt):
                p.stepSimulation(max(clients))

    assert _tied_box(break_off) == _tied_box(lambda: None)


def _interrupt(*_: Any) -> None:
    raise KeyboardInterrupt


def test_the_order_of_rows_stays_where_only_numbers_change() -> None:
    """Sorting again after each change gives the same bits: it is left out."""

    def places(*, sorted_anew: bool) -> list[Any]:
        client = p.connect(p.DIRECT)
        try:
            world = clients[client].world
            p.setGravity(0, 0, -10, physicsClientId=client)
            plane = p.createCollisionShape(p.GEOM_PLANE, physicsClientId=client)
            p.createMultiBody(0, plane, physicsClientId=client)
            box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, physicsClientId=client)
            boxes = [
                p.createMultiBody(1.0, box, basePosition=[0.21 * k, 0, 0.1], physicsClientId=client)
                for k in range(4)
            ]
            boxes.append(p.createMultiBody(1.0, box, basePosition=[0.1, 0, 0.31], physicsClientId=client))
            tied = p.createConstraint(
                *(boxes[0], -1, boxes[4], -1, p.JOINT_POINT2POINT, [0, 0, 1], [0, 0, 0.1], [0, 0, -0.1]),
                physicsClientId=client,
            )
            seen: list[Any] = []
            kept = 0
            for step in range(60):
                pivot = [0.001 * (step % 5), 0, -0.1]
                counts = world.contact_arrays.contacts.numpy["count_contacts"][0]
                order = int(counts[SORTED])
                p.changeConstraint(tied, pivot, maxForce=5 + step % 7, physicsClientId=client)
                kept += counts[SORTED] == order > 0
                if sorted_anew:
                    counts[SORTED] = 0
                p.stepSimulation(physicsClientId=client)
                seen += [p.getBasePositionAndOrientation(one, physicsClientId=client) for one in boxes]
            # While bodies settle, bounds meet and part, and arrays grow.
            assert kept > (-1 if sorted_anew else 40)
            return seen
        finally:
            p.disconnect(client)

    assert places(sorted_anew=False) == places(sorted_anew=True)
