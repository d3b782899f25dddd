"""Forces and torques from outside, in both frames, on bases and links."""

from __future__ import annotations

from typing import Any

from ..scenario import (
    base_motion,
    joint_motion,
    load,
    movable_joints,
    release_motors,
    scenario,
    simulate,
    under,
)


def _tree(p: Any) -> tuple[int, list[int]]:
    p.resetSimulation()
    p.setGravity(0, 0, -1.0)
    body = load(p, "tree.urdf", basePosition=[0.3, -0.2, 4.0], flags=p.URDF_USE_INERTIA_FROM_FILE)
    release_motors(p, body)
    for joint in movable_joints(p, body):
        p.changeDynamics(body, joint, jointDamping=0.1)
    return body, movable_joints(p, body)


def _move(p: Any, body: int, joints: list[int], act: Any) -> dict[str, Any]:
    return simulate(p, 2.0, lambda: base_motion(p, body) | joint_motion(p, body, joints), act)


@scenario()
def forces_on_base(p: Any) -> dict[str, Any]:
    """Forces at a point off the base's centre of mass, in the world's and the base's frame."""
    results: dict[str, Any] = {}
    for name, frame in (("world", p.WORLD_FRAME), ("link", p.LINK_FRAME)):
        body, joints = _tree(p)

        def push(step: int, body: int = body, frame: int = frame) -> None:
            if step % 60 < 30:
                point = [0.1, 0.05, -0.1]
                if frame == p.WORLD_FRAME:
                    base = p.getBasePositionAndOrientation(body)[0]
                    point = [b + o for b, o in zip(base, point, strict=True)]
                p.applyExternalForce(body, -1, [6.0, -2.0, 9.0], point, frame)

        results |= under(name, _move(p, body, joints, push))
    return results


@scenario()
def forces_on_links(p: Any) -> dict[str, Any]:
    """Forces on several links at once, several on the same link, in both frames."""
    results: dict[str, Any] = {}
    for name, frame in (("world", p.WORLD_FRAME), ("link", p.LINK_FRAME)):
        body, joints = _tree(p)

        def push(step: int, body: int = body, frame: int = frame) -> None:
            if step < 200:
                for link, force in ((0, [0.5, 0.3, 1.0]), (3, [-0.4, 0.2, 0.6]), (3, [0.1, 0.1, 0.1])):
                    point = [0.02, -0.03, 0.05]
                    if frame == p.WORLD_FRAME:
                        centre = p.getLinkState(body, link)[0]
                        point = [c + o for c, o in zip(centre, point, strict=True)]
                    p.applyExternalForce(body, link, force, point, frame)

        results |= under(name, _move(p, body, joints, push))
    return results


@scenario()
def torques_on_base_and_links(p: Any) -> dict[str, Any]:
    """Torques on the base and on links, in both frames."""
    results: dict[str, Any] = {}
    for name, frame in (("world", p.WORLD_FRAME), ("link", p.LINK_FRAME)):
        body, joints = _tree(p)

        def twist(step: int, body: int = body, frame: int = frame) -> None:
            if step < 240:
                p.applyExternalTorque(body, -1, [0.2, -0.1, 0.3], frame)
                p.applyExternalTorque(body, 1, [0.01, 0.02, -0.01], frame)
                p.applyExternalTorque(body, 6, [0.0, 0.015, 0.01], frame)

        results |= under(name, _move(p, body, joints, twist))
    return results


@scenario()
def forces_on_fixed_base(p: Any) -> dict[str, Any]:
    """Forces on the links and on the immovable base of an arm held by weak motors."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "seven_dof.urdf", useFixedBase=True)
    joints = movable_joints(p, body)
    for joint in joints:
        p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=3.0)

    def push(step: int) -> None:
        p.applyExternalForce(body, -1, [100.0, 0.0, 0.0], [0, 0, 0], p.LINK_FRAME)
        p.applyExternalForce(body, 4, [3.0, 2.0, 20.0], [0, 0.1, 0], p.LINK_FRAME)
        p.applyExternalTorque(body, 6, [0.5, 0.0, -0.5], p.WORLD_FRAME)
        if step < 100:
            tip = p.getLinkState(body, 7)[0]
            p.applyExternalForce(body, 7, [0.0, 0.0, 15.0], tip, p.WORLD_FRAME)

    return simulate(p, 2.0, lambda: joint_motion(p, body, joints), push)


@scenario()
def force_lasts_one_step(p: Any) -> dict[str, Any]:
    """A force and a torque applied once act for one step each."""
    body, joints = _tree(p)

    def kick(step: int) -> None:
        if step == 10:
            p.applyExternalForce(body, -1, [300.0, 0.0, 0.0], [0, 0, 0.1], p.LINK_FRAME)
        if step == 100:
            p.applyExternalTorque(body, -1, [0.0, 40.0, 0.0], p.LINK_FRAME)

    return _move(p, body, joints, kick)
