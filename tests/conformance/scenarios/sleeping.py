"""Bodies that fall asleep, who wakes them up, and what goes past them unnoticed."""

from __future__ import annotations

from typing import Any

from ..scenario import load, load_asset, scenario, simulate, under

_RADIUS = 0.1


def _floor(p: Any) -> int:
    p.setGravity(0, 0, -10)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 0.5])
    return p.createMultiBody(0, shape, basePosition=[0, 0, -0.5])


def _ball(p: Any, x: float = 0.0, z: float = _RADIUS, **options: Any) -> int:
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=_RADIUS)
    body = p.createMultiBody(1, shape, basePosition=[x, 0, z], **options)
    p.changeDynamics(body, -1, linearDamping=0, angularDamping=0)
    return body


def _roll(p: Any, body: int, speed: float) -> None:
    p.resetBaseVelocity(body, [speed, 0, 0], [0, speed / _RADIUS, 0])


def _let_sleep(p: Any, *bodies: int, also: int = 0) -> None:
    for body in bodies:
        p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING | also)


def _steps(p: Any, count: int) -> None:
    for _ in range(count):
        p.stepSimulation()


def _places(p: Any, *bodies: int) -> dict[str, Any]:
    return {f"ball {i}": p.getBasePositionAndOrientation(body)[0] for i, body in enumerate(bodies)}


@scenario()
def slow_balls_fall_asleep(p: Any) -> dict[str, Any]:
    """Balls that roll slower and faster than the threshold, in whole steps and in substeps."""
    series: dict[str, Any] = {}
    for substeps in (1, 4):
        p.resetSimulation()
        p.setPhysicsEngineParameter(numSubSteps=substeps)
        _floor(p)
        balls = []
        cases = ((0.0221, -1), (0.0224, -1), (0.05, 0.2), (0.05, 0.3), (0, 0))
        for i, (speed, threshold) in enumerate(cases):
            balls.append(_ball(p, x=0.5 * i))
            _let_sleep(p, balls[-1])
            p.changeDynamics(balls[-1], -1, sleepThreshold=threshold)
            _roll(p, balls[-1], speed)
        series |= under(f"{substeps} substeps", simulate(p, 2.5, lambda balls=balls: _places(p, *balls)))
    return series


@scenario()
def commands_about_sleep(p: Any) -> dict[str, Any]:
    """A falling ball is put to sleep and woken up by every command and loading flag there is."""
    enable, disable = p.ACTIVATION_STATE_ENABLE_SLEEPING, p.ACTIVATION_STATE_DISABLE_SLEEPING
    wake, sleep = p.ACTIVATION_STATE_WAKE_UP, p.ACTIVATION_STATE_SLEEP
    no_waking, waking = p.ACTIVATION_STATE_DISABLE_WAKEUP, p.ACTIVATION_STATE_ENABLE_WAKEUP
    cases: dict[str, list[int]] = {
        "sleep without leave": [sleep],
        "sleep": [enable | sleep],
        "sleep and wake": [enable | sleep, wake],
        "sleep and stay awake": [enable | sleep, disable],
        "sleep for ever": [enable | sleep | no_waking, disable],
        "sleep for ever, woken": [enable | sleep | no_waking, wake],
        "leave comes too late": [no_waking, enable | sleep],
        "leave comes in time": [no_waking, waking, enable | sleep],
    }
    series: dict[str, Any] = {}
    for name, commands in cases.items():
        p.resetSimulation()
        _floor(p)
        ball = _ball(p, z=3.0)

        def act(step: int, commands: list[int] = commands, ball: int = ball) -> None:
            if step % 4 == 0 and step // 4 < len(commands):
                p.changeDynamics(ball, -1, activationState=commands[step // 4])

        observe = lambda ball=ball: {"place": p.getBasePositionAndOrientation(ball)[0]}  # noqa: E731
        series |= under(name, simulate(p, 0.1, observe, act, stride=1))
    for flags in (0, p.URDF_ENABLE_SLEEPING, p.URDF_ENABLE_WAKEUP):
        p.resetSimulation()
        _floor(p)
        ball = _ball(p, flags=flags)
        box = load_asset(p, "cube_small.urdf", basePosition=[1, 0, 0.025], flags=flags)
        _steps(p, 600)
        p.setGravity(0, 0, 10)
        _steps(p, 5)
        heights = [p.getBasePositionAndOrientation(body)[0][2] for body in (ball, box)]
        series[f"loaded with {flags}/rises"] = [height > 0.1005 for height in heights]
    return series


@scenario()
def asleep_to_the_world(p: Any) -> dict[str, Any]:
    """Forces, velocities, turned gravity and a lost support leave a sleeper cold; a new place moves it."""
    _floor(p)
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.3, 0.3, 0.1])
    support = p.createMultiBody(0, box, basePosition=[2, 0, 0.1])
    balls = [_ball(p), _ball(p, x=2.0, z=0.3)]
    _let_sleep(p, *balls)
    _steps(p, 500)
    p.setGravity(0, 0, 10)
    p.removeBody(support)

    def act(step: int) -> None:
        p.applyExternalForce(balls[0], -1, [50, 0, 0], [0, 0, _RADIUS], p.WORLD_FRAME)
        if step == 5:
            p.resetBaseVelocity(balls[1], [1, 0, 0])
        if step == 10:
            p.resetBasePositionAndOrientation(balls[0], [0, 0, 2], [0, 0, 0, 1])
        if step == 15:
            p.changeDynamics(balls[0], -1, activationState=p.ACTIVATION_STATE_WAKE_UP)

    return simulate(p, 0.1, lambda: _places(p, *balls), act, stride=1)


@scenario(tolerance=1e-2)
def sleepers_are_hit(p: Any) -> dict[str, Any]:
    """A ball rolls into one that sleeps, with leave to wake up and without; those far off sleep on.

    A ball that is lifted off comes down on points PyBullet kept from before: measured 9e-3.
    """
    series: dict[str, Any] = {}
    for name, also in (("may wake up", 0), ("may not", p.ACTIVATION_STATE_DISABLE_WAKEUP)):
        p.resetSimulation()
        _floor(p)
        balls = [_ball(p), _ball(p, x=0.5), _ball(p, x=-0.5)]
        _let_sleep(p, *balls[:2], also=also)
        _steps(p, 500)
        _roll(p, balls[2], 2.0)
        series |= under(name, simulate(p, 0.5, lambda balls=balls: _places(p, *balls)))
    return series


@scenario()
def neighbours_keep_each_other_awake(p: Any) -> dict[str, Any]:
    """A ball may sleep only if those that touch it, are tied to it or are very near may as well."""
    series: dict[str, Any] = {}
    for gap in (0.0, 0.03, 0.05):
        p.resetSimulation()
        _floor(p)
        balls = [_ball(p), _ball(p, x=2 * _RADIUS + gap)]
        _let_sleep(p, balls[0])
        _steps(p, 600)
        p.setGravity(0, 0, 10)
        series |= under(f"gap {gap}", simulate(p, 0.05, lambda balls=balls: _places(p, *balls)))
    for name, sleepers in (("one", 1), ("both", 2)):
        p.resetSimulation()
        _floor(p)
        balls = [_ball(p), _ball(p, x=2.0)]
        p.createConstraint(balls[0], -1, balls[1], -1, p.JOINT_POINT2POINT, [0, 0, 0], [1, 0, 0], [-1, 0, 0])
        _let_sleep(p, *balls[:sleepers])
        _steps(p, 600)
        p.setGravity(0, 0, 10)
        series |= under(f"tied, {name}", simulate(p, 0.05, lambda balls=balls: _places(p, *balls)))
    return series


@scenario()
def robots_fall_asleep(p: Any) -> dict[str, Any]:
    """Arms and trees held by their motors fall asleep; new targets do not wake them up, leave does."""
    series: dict[str, Any] = {}
    for name, options in (("seven_dof.urdf", {"useFixedBase": 1}), ("double_pendulum.urdf", {})):
        p.resetSimulation()
        p.setGravity(0, 0, -10)
        body = load(p, name, flags=p.URDF_ENABLE_SLEEPING, **options)

        def act(step: int, body: int = body) -> None:
            if step >= 600:
                p.setJointMotorControl2(body, 0, p.POSITION_CONTROL, targetPosition=1.0, force=50)
            if step == 660:
                p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_DISABLE_SLEEPING)

        def observe(body: int = body) -> dict[str, Any]:
            states = p.getJointStates(body, list(range(p.getNumJoints(body))))
            return {
                "position": [state[0] for state in states],
                "velocity": [state[1] for state in states],
                "torque": [state[3] for state in states],
            }

        series |= under(name, simulate(p, 3.0, observe, act))
    return series


def _slider(p: Any, base_mass: float) -> int:
    """A box with another on a rail, which no motor holds."""
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.05, 0.04, 0.1])
    body = p.createMultiBody(
        base_mass,
        box,
        -1,
        [0, 0, 2],
        linkMasses=[1.0],
        linkCollisionShapeIndices=[box],
        linkVisualShapeIndices=[-1],
        linkPositions=[[0.3, 0, 0.1]],
        linkOrientations=[[0, 0, 0, 1]],
        linkInertialFramePositions=[[0.02, 0, 0]],
        linkInertialFrameOrientations=[[0, 0, 0, 1]],
        linkParentIndices=[0],
        linkJointTypes=[p.JOINT_PRISMATIC],
        linkJointAxis=[[0, 0.6, 0.8]],
    )
    p.setJointMotorControl2(body, 0, p.VELOCITY_CONTROL, force=0)
    return body


def _fall_asleep(p: Any, body: int, also: int = 0) -> None:
    _let_sleep(p, body, also=also)
    p.changeDynamics(body, -1, activationState=p.ACTIVATION_STATE_SLEEP)


def _whole_motion(p: Any, body: int) -> dict[str, Any]:
    return {
        "pose": sum(p.getBasePositionAndOrientation(body), ()),
        "velocity": sum(p.getBaseVelocity(body), ()),
        "joint": p.getJointState(body, 0)[:2],
    }


@scenario(tolerance=1e-9)
def fixed_bases_with_a_velocity_sleep(p: Any) -> dict[str, Any]:
    """The velocity of a fixed base wakes the body if it is fast, and is lost in sleep if it is slow."""
    series: dict[str, Any] = {}
    for name, speed in (("slow", 0.05), ("fast", 2.0)):
        for wakes in (p.ACTIVATION_STATE_ENABLE_WAKEUP, p.ACTIVATION_STATE_DISABLE_WAKEUP):
            p.resetSimulation()
            body = _slider(p, 0.0)
            _fall_asleep(p, body, also=wakes)
            p.resetBaseVelocity(body, [0, 0, speed], [0, speed, 0])
            motion = simulate(p, 0.05, lambda body=body: _whole_motion(p, body))
            series |= under(f"{name}, wakes {wakes}", motion)
    for mass in (1.0, 0.0):
        p.resetSimulation()
        p.setGravity(0, 0, -9.8)
        body = _slider(p, 1.0)
        p.stepSimulation()
        p.changeDynamics(body, -1, mass=mass)
        _fall_asleep(p, body)
        series |= under(f"falls, mass {mass}", simulate(p, 0.05, lambda body=body: _whole_motion(p, body)))
    return series


@scenario(tolerance=1e-6)
def links_that_sleep_are_reported_where_they_are(p: Any) -> dict[str, Any]:
    """`getLinkState` of a body that moves tells of the start of a step, but where it fell asleep."""
    series: dict[str, Any] = {}
    for substeps in (1, 2):
        p.resetSimulation()
        p.setGravity(1, -2, -9.8)
        p.setPhysicsEngineParameter(numSubSteps=substeps)
        body = _slider(p, 1.0)
        _fall_asleep(p, body)
        seen = simulate(p, 4 / 240, lambda body=body: {"link": p.getLinkState(body, 0)[0]})
        series |= under(f"{substeps} substeps", seen)
    return series
