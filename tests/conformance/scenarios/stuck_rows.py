"""Rows along which nothing can move: contacts of robots in a plane and on rails, motors that move no mass.

PyBullet computes 0/0 for the change of such a row, and forgets what the rows before it have changed. So it
stops sweeping early where the last rows are at rest, and never where such a row is the last.

It sorts a constraint by the island of its links. A link on fixed joints that lead to a fixed base, or to the
first link, is in none; a constraint of such ends alone is sorted before all others, and is not solved.
"""

from __future__ import annotations

from typing import Any

from ..scenario import load_asset, scenario, simulate, under

SLIDE, TURN = 1, 0
FIXED = 4


def _arm(p: Any, joints: list[tuple[int, list[float]]], step: float) -> int:
    """Capsules that lie along x, one after the other, on joints of these types and axes, 0.05 m high."""
    count = len(joints)
    hub = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.02, 0.02, 0.02])
    capsule = p.createCollisionShape(p.GEOM_CAPSULE, radius=0.05, height=0.3)
    lying = p.getQuaternionFromEuler([0, 1.5707963267948966, 0])
    shapes = [capsule if place == count - 1 or step > 0 else -1 for place in range(count)]
    body = p.createMultiBody(
        0,
        hub,
        -1,
        [0, 0, 0.05],
        linkMasses=[1.0 if shape >= 0 else 0.1 for shape in shapes],
        linkCollisionShapeIndices=shapes,
        linkVisualShapeIndices=[-1] * count,
        linkPositions=[[0.3, 0, 0] if place == 0 else [0, 0, step] for place in range(count)],
        linkOrientations=[lying, *[[0, 0, 0, 1]] * (count - 1)],
        linkInertialFramePositions=[[0, 0, 0]] * count,
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * count,
        linkParentIndices=list(range(count)),
        linkJointTypes=[kind for kind, _ in joints],
        linkJointAxis=[axis for _, axis in joints],
    )
    for joint in range(count):
        p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, targetVelocity=0.1, force=1.5)
    return body


@scenario(tolerance={"positions": 1e-6, "velocities": 1e-6})
def rows_along_which_nothing_can_move(p: Any) -> dict[str, Any]:
    """Capsules on sliders and hinges touch the floor; how they move, and how many sweeps that takes."""
    arms: dict[str, tuple[list[tuple[int, list[float]]], float]] = {
        "slides over the floor": ([(SLIDE, [0, 0, 1]), (SLIDE, [0, 1, 0])], 0.0),
        "slides and turns over the floor": ([(SLIDE, [0, 0, 1]), (SLIDE, [0, 1, 0]), (TURN, [1, 0, 0])], 0.0),
        "falls in a plane": ([(SLIDE, [1, 0, 0]), (SLIDE, [0, 0, 1]), (TURN, [0, 1, 0])], 0.0),
        "turns into the floor": ([(TURN, [0, 1, 0]), (TURN, [0, 1, 0])], 0.45),
    }
    results: dict[str, Any] = {}
    for name, (joints, step) in arms.items():
        p.resetSimulation()
        p.setGravity(0.3, -2.0, -9.8)
        p.setPhysicsEngineParameter(reportSolverAnalytics=1)
        floor = p.createCollisionShape(p.GEOM_BOX, halfExtents=[5, 5, 1])
        p.createMultiBody(0, floor, -1, [0, 0, -1])
        body = _arm(p, joints, step)

        def joints_of(body: int = body) -> dict[str, Any]:
            states = p.getJointStates(body, range(p.getNumJoints(body)))
            return {
                "positions": [state[0] for state in states],
                "velocities": [state[1] for state in states],
            }

        first = p.stepSimulation()
        results |= under(name, {"sweeps": [island["numIterationsUsed"] for island in first]})
        results |= under(name, simulate(p, 0.2, joints_of, stride=4))
    return results


def _robot(p: Any, base_mass: float, joints: list[tuple[int, int]]) -> int:
    """Boxes on joints of these types and parents, without motors that hold."""
    count = len(joints)
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.05, 0.04, 0.1])
    body = p.createMultiBody(
        base_mass,
        box,
        -1,
        [0, 0, 2],
        linkMasses=[1.0] * count,
        linkCollisionShapeIndices=[box] * count,
        linkVisualShapeIndices=[-1] * count,
        linkPositions=[[0.3, 0.1 * place, 0.1] for place in range(count)],
        linkOrientations=[[0, 0, 0, 1]] * count,
        linkInertialFramePositions=[[0.02, 0, 0]] * count,
        linkInertialFrameOrientations=[[0, 0, 0, 1]] * count,
        linkParentIndices=[parent for _, parent in joints],
        linkJointTypes=[kind for kind, _ in joints],
        linkJointAxis=[[0, 0.6, 0.8]] * count,
    )
    for joint, (kind, _) in enumerate(joints):
        if kind == TURN:
            p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, targetVelocity=0.2, force=2.0)
    return body


def _start(p: Any) -> None:
    p.resetSimulation()
    p.setGravity(0.5, -1.0, -9.8)
    p.setPhysicsEngineParameter(reportSolverAnalytics=1)


def _result(p: Any, body: int) -> dict[str, Any]:
    """The sweeps of the first step, and what the joints do."""
    first = p.stepSimulation()

    def joints() -> dict[str, Any]:
        states = p.getJointStates(body, [j for j in range(p.getNumJoints(body)) if _turns(p, body, j)])
        return {"positions": [state[0] for state in states], "velocities": [state[1] for state in states]}

    sweeps = [island["numIterationsUsed"] for island in first]
    return {"sweeps": sweeps} | simulate(p, 0.1, joints, stride=4)


def _turns(p: Any, body: int, joint: int) -> bool:
    return p.getJointInfo(body, joint)[2] == TURN


@scenario(tolerance={"positions": 1e-9, "velocities": 1e-9})
def constraints_of_still_links(p: Any) -> dict[str, Any]:
    """A constraint that ties two still ends has no effect but on the order of the motors."""
    chain = [(TURN, 0), (TURN, 1), (TURN, 2), (TURN, 3)]
    on_first = [(TURN, 0), (FIXED, 1), (FIXED, 2), (TURN, 3), (FIXED, 4)]
    cases = {
        "fixed base": (chain, -1),
        "link fixed to the first": (on_first, 1),
        "link fixed to that": (on_first, 2),
        "link fixed to a later one": (on_first, 4),
    }
    results: dict[str, Any] = {}
    for name, (joints, link) in cases.items():
        _start(p)
        body = _robot(p, 0.0, joints)
        p.createConstraint(body, link, -1, -1, p.JOINT_POINT2POINT, [0, 0, 1], [0, 0.1, 0], [0.2, 0.1, 1.8])
        results |= under(name, _result(p, body))
    return results


@scenario(tolerance={"positions": 1e-9, "velocities": 1e-9})
def constraints_of_fixed_bases_with_a_velocity(p: Any) -> dict[str, Any]:
    """A constraint holds a link to the velocity that a fixed base was given, as if it moved."""
    results: dict[str, Any] = {}
    for kind in (p.JOINT_POINT2POINT, p.JOINT_FIXED, p.JOINT_PRISMATIC):
        _start(p)
        body = _robot(p, 0.0, [(TURN, 0), (TURN, 1), (TURN, 2)])
        p.resetBaseVelocity(body, [0.3, -0.2, 0.1], [0.7, -0.8, 0.2])
        other = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), -1, [0.4, 0, 4])
        p.createConstraint(body, 1, other, -1, kind, [0, 0, 1], [0.1, 0.1, 0], [-0.2, 0.2, -0.1])
        results |= under(str(kind), _result(p, body))
    return results


@scenario(tolerance={"positions": 1e-9, "velocities": 1e-9})
def motors_that_move_no_mass(p: Any) -> dict[str, Any]:
    """Motors of joints whose links have lost their mass: their rows change by 0/0, and nothing else."""
    results: dict[str, Any] = {}
    for name, (link, force) in {
        "last": (3, 2.0),
        "first": (0, 2.0),
        "middle": (1, 2.0),
        "last with a negative force": (3, -2.0),
    }.items():
        _start(p)
        body = _robot(p, 0.0, [(TURN, 0), (TURN, 1), (TURN, 1), (TURN, 0)])
        for lost in (link,) if link != 0 else (0, 1, 2):
            p.changeDynamics(body, lost, mass=0)
        p.setJointMotorControl2(body, link, p.VELOCITY_CONTROL, targetVelocity=0.2, force=force)
        results |= under(name, _result(p, body))
    return results


@scenario(tolerance={"positions": 1e-9, "velocities": 1e-9})
def motors_that_turn_no_inertia_beside_constraints(p: Any) -> dict[str, Any]:
    """The last link turns about its centre of mass, without moments: its motor's row hides the constraint's.

    That shows where the sweeps end: in those in which the motors follow the constraint, only what the motor
    of the first joint does counts, and it does nothing while it pulls as hard as it may.
    """
    results: dict[str, Any] = {}
    places = ([0.1, 0.5813857880403893, -0.21157229713689102], [0.3, 0.2, 0.1])
    for name, other in {"world": False, "robot": True}.items():
        for place in places:
            for sweeps in (6, 9, 50):
                _start(p)
                p.setPhysicsEngineParameter(numSolverIterations=sweeps)
                box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
                body = p.createMultiBody(
                    2,
                    box,
                    -1,
                    [-0.5, 0.3, 0.2],
                    linkMasses=[0.1, 0.1],
                    linkCollisionShapeIndices=[box, -1],
                    linkVisualShapeIndices=[-1, -1],
                    linkPositions=[place, place],
                    linkOrientations=[[0, 0, 0, 1]] * 2,
                    linkInertialFramePositions=[[0, 0, 0]] * 2,
                    linkInertialFrameOrientations=[[0, 0, 0, 1]] * 2,
                    linkParentIndices=[0, 1],
                    linkJointTypes=[TURN, TURN],
                    linkJointAxis=[[1, 0, 0]] * 2,
                )
                p.changeDynamics(body, 1, localInertiaDiagonal=[0, 0, 0])
                p.resetBaseVelocity(body, [0.1, 0.2, 0.3], [1, 2, 3])
                for joint in range(2):
                    p.setJointMotorControl2(
                        body, joint, p.VELOCITY_CONTROL, targetVelocity=0.5 + joint, force=100
                    )
                ends = (p.createMultiBody(1, box, -1, [2, 0, 0]), -1) if other else (-1, -1)
                p.createConstraint(
                    body, -1, *ends, p.JOINT_POINT2POINT, [0, 0, 0], [0.1, 0.2, 0.3], [-0.4, 0.5, 0.6]
                )
                results |= under(f"{name}, {place[0]}, {sweeps} sweeps", _result(p, body))
    return results


@scenario(tolerance={"positions": 1e-9, "velocities": 1e-9})
def bodies_without_a_moment_of_inertia(p: Any) -> dict[str, Any]:
    """Nothing turns a single body one of whose moments of inertia is 0, neither a torque nor a constraint."""
    results: dict[str, Any] = {}
    for moments in ([3, 3, 0], [0, 0.1, 0.2], [0.1, 0, 0], [0.1, 0.2, 0.3]):
        p.resetSimulation()
        p.setGravity(0.5, -1.0, -9.8)
        box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.05, 0.04, 0.1])
        body = p.createMultiBody(0.5, box, -1, [0, 0, 1])
        p.changeDynamics(body, -1, localInertiaDiagonal=moments)
        p.resetBaseVelocity(body, [0.1, 0.2, 0.3], [1.0, -2.0, 0.5])
        p.createConstraint(
            body, -1, -1, -1, p.JOINT_POINT2POINT, [0, 0, 1], [-0.1, 0.2, -0.3], [-0.2, 0.1, 0.6]
        )

        def motion(body: int = body) -> dict[str, Any]:
            p.applyExternalTorque(body, -1, [0.1, 0.2, 0.3], p.WORLD_FRAME)
            return {
                "positions": sum(p.getBasePositionAndOrientation(body), ()),
                "velocities": sum(p.getBaseVelocity(body), ()),
            }

        results |= under(str(moments), simulate(p, 0.1, motion, stride=4))
    return results


def _motion(p: Any, body: int) -> dict[str, Any]:
    """Base and joints of a robot."""
    position, orientation = p.getBasePositionAndOrientation(body)
    linear, angular = p.getBaseVelocity(body)
    joints = [p.getJointState(body, joint) for joint in range(p.getNumJoints(body))]
    return {
        "positions": [*position, *(state[0] for state in joints)],
        "orientation": orientation,
        "velocities": [*linear, *angular, *(state[1] for state in joints)],
    }


@scenario(tolerance={"positions": 1e-8, "orientation": 1e-8, "velocities": 1e-6})
def constraints_of_freed_bodies(p: Any) -> dict[str, Any]:
    """Links that were still when their body was loaded stay so for constraints; no others become so."""
    results: dict[str, Any] = {}
    chains = {
        "fixed first": [(FIXED, 0), (TURN, 1), (FIXED, 2)],
        "fixed last": [(TURN, 0), (FIXED, 1), (FIXED, 2)],
    }
    for name, joints in chains.items():
        for loaded, *masses in (
            [0.0, 1.0],
            [0.0, 1.0, 0.0],
            [0.0, 1.0, 0.0, 1.0],
            [1.0, 0.0],
            [1.0, 0.0, 1.0],
        ):
            for link in (-1, 0, 1, 2):
                _start(p)
                body = _robot(p, loaded, joints)
                for mass in masses:
                    p.changeDynamics(body, -1, mass=mass)
                p.createConstraint(
                    body, link, -1, -1, p.JOINT_POINT2POINT, [0, 0, 1], [0, 0.1, 0], [0.2, 0.1, 1.8]
                )
                first = p.stepSimulation()
                case = {
                    "sweeps": [island["numIterationsUsed"] for island in first],
                    "bodies": [island["numBodies"] for island in first],
                } | simulate(p, 0.03, lambda body=body: _motion(p, body))
                results |= under(f"{name}, link {link}, masses {[loaded, *masses]}", case)
    return results


@scenario(tolerance=1e-9)
def inner_sweeps_go_on_after_stuck_rows(p: Any) -> dict[str, Any]:
    """Points of a pendulum in a plane are tied where they cannot be, with two inner sweeps in each."""
    pendulum = load_asset(p, "pendulum5.urdf")
    p.setPhysicsEngineParameter(numNonContactInnerIterations=2)
    for links, pivots in (((1, 2), ([0.3, 0.3, 0.3], [0, 1.3, 2.2])), ((0, 1), ([0, -0.3, 0], [0, -1, 4]))):
        p.createConstraint(pendulum, links[0], pendulum, links[1], p.JOINT_POINT2POINT, [0, 0, 1], *pivots)
    joints = range(p.getNumJoints(pendulum))
    return simulate(
        p, 1 / 240, lambda: {"joints": [state[0] for state in p.getJointStates(pendulum, joints)]}
    )


@scenario(tolerance={"positions": 1e-9, "velocities": 1e-9})
def rolling_of_bodies_without_inertia(p: Any) -> dict[str, Any]:
    """A ball without moments of inertia, and with rolling friction, slides close to a driven arm."""
    results: dict[str, Any] = {}
    for cone in (0, 1):
        for kinds in (["rollingFriction"], ["spinningFriction"], ["rollingFriction", "spinningFriction"]):
            _start(p)
            p.setPhysicsEngineParameter(enableConeFriction=cone)
            block = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.05, 0.05, 0.5])
            p.createMultiBody(0, block, -1, [0.3, -0.2, 1.5001])
            arm = _robot(p, 0.0, [(TURN, 0), (TURN, 1), (TURN, 2)])
            for joint in range(3):
                p.setJointMotorControl2(arm, joint, p.VELOCITY_CONTROL, targetVelocity=0.2, force=50)
            # So close that their bounds meet, which puts both into one island.
            ball = p.createMultiBody(
                1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1), -1, [0.3, -0.16, 2.1]
            )
            p.changeDynamics(ball, -1, localInertiaDiagonal=[0, 0, 0], **dict.fromkeys(kinds, 0.1))
            p.resetBaseVelocity(ball, [0.1, -0.1, -0.1])
            results |= under(f"{' and '.join(kinds)}, cone {cone}", _result(p, arm))
    return results
