"""Robots loaded with `URDF_GLOBAL_VELOCITIES_MB`, by whose links' late velocities PyBullet moves them."""

from __future__ import annotations

from typing import Any

from ...scenario import (
    base_motion,
    flat,
    joint_motion,
    load,
    load_asset,
    movable_joints,
    release_motors,
    scenario,
    simulate,
    under,
)

_CLOSE = 1e-8
_TILTED = [0.0985, 0.0515, -0.0052, 0.9938]


def _observe(p: Any, body: int) -> dict[str, Any]:
    return base_motion(p, body) | under("joints", joint_motion(p, body, movable_joints(p, body)))


def _falling(p: Any, path: str, height: float) -> int:
    """A robot with the flag above a floor, tilted so that its feet land one after the other."""
    p.setGravity(0, 0, -9.81)
    load_asset(p, "plane.urdf")
    return load_asset(
        p,
        path,
        basePosition=[0.0, 0.0, height],
        baseOrientation=_TILTED,
        flags=p.URDF_GLOBAL_VELOCITIES_MB,
    )


def _spread(p: Any, body: int) -> None:
    """Joints without motors, at positions and rates of their own."""
    release_motors(p, body)
    for place, joint in enumerate(movable_joints(p, body)):
        p.resetJointState(body, joint, 0.1 * place - 0.5, 1.0 - 0.3 * place)


@scenario(tolerance=_CLOSE)
def global_velocities_r2d2_falls(p: Any) -> dict[str, Any]:
    """R2D2 with global velocities falls on a floor."""
    body = _falling(p, "r2d2.urdf", 0.6)
    return simulate(p, 0.5, lambda: _observe(p, body))


@scenario(tolerance=_CLOSE)
def global_velocities_laikago_lands(p: Any) -> dict[str, Any]:
    """A Laikago with global velocities lands while it turns."""
    body = _falling(p, "laikago/laikago_toes_zup.urdf", 0.58)
    p.resetBaseVelocity(body, [0.3, 0.0, 0.0], [1.0, 2.0, 0.5])
    return simulate(p, 0.6, lambda: _observe(p, body))


@scenario(tolerance=_CLOSE)
def global_velocities_minitaur_is_thrown(p: Any) -> dict[str, Any]:
    """A Minitaur with global velocities is thrown, and swings its legs by its motors."""
    body = _falling(p, "quadruped/minitaur.urdf", 2.0)
    p.resetBaseVelocity(body, [0.1, 0.2, 0.3], [1.0, 2.0, 3.0])
    for place, joint in enumerate(movable_joints(p, body)):
        p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, targetVelocity=(-1) ** place, force=0.05)
    return simulate(p, 0.5, lambda: _observe(p, body))


@scenario(tolerance=_CLOSE)
def global_velocities_robot_tumbles(p: Any) -> dict[str, Any]:
    """A free robot with global velocities and loose joints tumbles without gravity."""
    body = load_asset(p, "laikago/laikago_toes_zup.urdf", flags=p.URDF_GLOBAL_VELOCITIES_MB)
    p.resetBaseVelocity(body, [0.1, 0.2, 0.3], [1.0, 2.0, 3.0])
    _spread(p, body)
    return simulate(p, 0.5, lambda: _observe(p, body))


@scenario(tolerance=_CLOSE)
def global_velocities_arm_on_a_base_that_is_told_to_move(p: Any) -> dict[str, Any]:
    """An arm with global velocities swings on a fixed base whose velocity is set."""
    p.setGravity(0, 0, -9.81)
    body = load(p, "seven_dof.urdf", useFixedBase=True, flags=p.URDF_GLOBAL_VELOCITIES_MB)
    _spread(p, body)
    p.resetBaseVelocity(body, [0.1, 0.2, 0.3], [0.3, 0.2, 0.1])
    return simulate(p, 0.5, lambda: _observe(p, body))


@scenario(tolerance=_CLOSE)
def global_velocities_balls_and_slides(p: Any) -> dict[str, Any]:
    """Ball joints, and a planar joint, with global velocities."""
    p.setGravity(0, 0, -9.81)
    found: dict[str, Any] = {}
    for name in ("spherical_chain.urdf", "planar_body.urdf", "slider.urdf"):
        p.resetSimulation()
        p.setGravity(0, 0, -9.81)
        body = load(p, name, flags=p.URDF_GLOBAL_VELOCITIES_MB)
        p.resetBaseVelocity(body, [0.1, 0.2, 0.3], [1.0, 2.0, 3.0])
        joints = range(p.getNumJoints(body))

        def observe(body: int = body, joints: range = joints) -> dict[str, Any]:
            states = p.getJointStatesMultiDof(body, joints)
            return base_motion(p, body) | {"joint_states": flat([state[:2] for state in states])}

        found |= under(name, simulate(p, 0.5, observe))
    return found


@scenario(tolerance=_CLOSE)
def global_velocities_with_sensors(p: Any) -> dict[str, Any]:
    """Sensors of all joints of R2D2 with global velocities, while it falls."""
    body = _falling(p, "r2d2.urdf", 0.6)
    joints = range(p.getNumJoints(body))
    for joint in joints:
        p.enableJointForceTorqueSensor(body, joint)
    p.resetBaseVelocity(body, [0.1, 0.2, 0.3], [1.0, 2.0, 3.0])

    def observe() -> dict[str, Any]:
        reactions = flat([state[2] for state in p.getJointStates(body, joints)])
        return _observe(p, body) | {"reactions": reactions}

    return simulate(p, 0.4, observe)


@scenario(tolerance=_CLOSE)
def global_velocities_in_substeps(p: Any) -> dict[str, Any]:
    """R2D2 with global velocities turns and falls, in steps of four substeps."""
    p.setPhysicsEngineParameter(numSubSteps=4)
    body = _falling(p, "r2d2.urdf", 0.6)
    p.resetBaseVelocity(body, [0.1, 0.2, 0.3], [1.0, 2.0, 3.0])
    return simulate(p, 0.4, lambda: _observe(p, body))


@scenario(tolerance=_CLOSE)
def global_velocities_are_restored(p: Any) -> dict[str, Any]:
    """R2D2 with global velocities turns; its state is saved and restored, and its base is put elsewhere."""
    body = _falling(p, "r2d2.urdf", 0.6)
    p.resetBaseVelocity(body, [0.1, 0.2, 0.3], [5.0, 2.0, 3.0])
    saved: list[int] = []

    def act(step: int) -> None:
        if step == 20:
            saved.append(p.saveState())
        if step == 30:
            p.restoreState(saved[0])
        if step == 40:
            p.resetBasePositionAndOrientation(body, [0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 1.0])

    return simulate(p, 0.25, lambda: _observe(p, body), act, stride=1)


@scenario(tolerance=1e-7)
def global_velocities_fall_asleep(p: Any) -> dict[str, Any]:
    """R2D2 with global velocities falls asleep, and is woken up and pushed."""
    p.setGravity(0, 0, -9.81)
    load_asset(p, "plane.urdf")
    flags = p.URDF_GLOBAL_VELOCITIES_MB | p.URDF_ENABLE_SLEEPING
    body = load_asset(p, "r2d2.urdf", basePosition=[0.0, 0.0, 0.47], flags=flags)

    def act(step: int) -> None:
        if step == 600:
            p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_WAKE_UP)
            p.resetBaseVelocity(body, [1.0, 0.0, 0.0], [0.0, 0.0, 3.0])

    return simulate(p, 2.75, lambda: _observe(p, body), act)
