"""Things that are made, used and closed: one of each kind in each turn of a loop.

A function gives the objects that have to be gone once it has returned and nobody has them any more.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np

import carom
import carom.vector
import pybullet as p
import pybullet_data
import pybullet_envs  # noqa: F401  (registers its environments)
from carom.viewer.viewer import Viewer
from pybullet._clients.clients import clients

DATA = Path(pybullet_data.getDataPath())
ARM, DROID, PLANE = (str(DATA / name) for name in ("kuka_iiwa/model.urdf", "r2d2.urdf", "plane.urdf"))
GROUND = 0.0, 0.0, -9.81


def client() -> list[Any]:
    """A connection with a robot that makes a step."""
    number = p.connect(p.DIRECT)
    body = p.loadURDF(DROID, physicsClientId=number)
    p.stepSimulation(physicsClientId=number)
    p.getJointStates(body, [0, 1], physicsClientId=number)
    made = _of_client(number)
    p.disconnect(number)
    return made


def full_client() -> list[Any]:
    """A connection that uses all sorts of functions: states, images, constraints, queries, dynamics."""
    number = p.connect(p.DIRECT)
    p.setGravity(*GROUND, physicsClientId=number)
    own: dict[str, Any] = {"physicsClientId": number}
    p.loadURDF(PLANE, **own)
    droid, arm = p.loadURDF(DROID, [0, 0, 1], **own), p.loadURDF(ARM, [1, 0, 0], **own)
    p.stepSimulation(**own)
    p.setJointMotorControlArray(arm, range(7), p.POSITION_CONTROL, [0.1] * 7, **own)
    p.getLinkState(arm, 3, 1, 1, **own)
    p.calculateInverseKinematics(arm, 6, [0.5, 0.0, 0.5], **own)
    p.calculateInverseDynamics(arm, [0.0] * 7, [0.0] * 7, [0.0] * 7, **own)
    p.calculateMassMatrix(arm, [0.0] * 7, **own)
    p.getContactPoints(**own)
    p.getClosestPoints(droid, arm, 5.0, **own)
    p.rayTest([0, 0, 5], [0, 0, -5], **own)
    p.getAABB(arm, **own)
    tie = p.createConstraint(droid, -1, arm, -1, p.JOINT_FIXED, [0] * 3, [0] * 3, [0] * 3, **own)
    p.stepSimulation(**own)
    p.removeConstraint(tie, **own)
    state = p.saveState(**own)
    p.stepSimulation(**own)
    p.restoreState(state, **own)
    p.getCameraImage(32, 32, renderer=p.ER_TINY_RENDERER, **own)
    p.removeBody(droid, **own)
    made = _of_client(number)
    p.disconnect(number)
    return made


def window() -> list[Any]:
    """A connection with a window that nobody looks at."""
    number = p.connect(p.GUI, options="--port=0")
    p.loadURDF(DROID, physicsClientId=number)
    p.addUserDebugLine([0, 0, 0], [1, 1, 1], physicsClientId=number)
    p.addUserDebugParameter("height", 0, 1, 0.5, physicsClientId=number)
    p.stepSimulation(physicsClientId=number)
    shown: Any = clients[number].window
    made = [*_of_client(number), shown, shown.viewer, shown.viewer._server]
    p.disconnect(number)
    return made


def soft() -> list[Any]:
    """A connection with a soft body, and one with bodies of an MJCF file."""
    made: list[Any] = []
    for _ in range(2):
        number = p.connect(p.DIRECT)
        own: dict[str, Any] = {"physicsClientId": number}
        if made:
            p.loadMJCF(str(DATA / "mjcf" / "ant.xml"), **own)
        else:
            p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD, **own)
            p.loadSoftBody(str(DATA / "cloth_z_up.obj"), mass=1, useMassSpring=1, **own)
        p.stepSimulation(**own)
        made += _of_client(number)
        p.disconnect(number)
    return made


def served() -> list[Any]:
    """A server, and a client of it."""
    server = p.connect(p.SHARED_MEMORY_SERVER, key=_KEY)
    number = p.connect(p.SHARED_MEMORY, _KEY)
    p.loadURDF(DROID, physicsClientId=number)
    p.stepSimulation(physicsClientId=number)
    made = [*_of_client(server), clients[server].server]
    p.disconnect(number)
    p.disconnect(server)
    return made


def world() -> list[Any]:
    """A world with a robot and handles of its parts, which is left."""
    with carom.World() as made:
        made.gravity = GROUND
        body = made.load_urdf(DROID)
        made.step(2)
        parts = body.joints, body.links, body.actuators, body.joints.movable[0]
    return [made, made.engine, body, *parts[:3]]


def measured_world() -> list[Any]:
    """A world with an actuator, a sensor, a model read from a file, queries, a log, and a copy."""
    with carom.World() as made:
        body = made.load_urdf(ARM)
        joint = body.joints[0].name
        body.add_actuator("drive", carom.PositionActuator(joint, kp=50.0, kv=2.0))
        body.add_sensor("angle", carom.JointPosition(joint))
        made.load(DATA / "mjcf" / "ant.xml")
        log = made.log("position")
        made.step(3)
        log.stop()
        sensors = body.sensors
        sensors["angle"].read()
        made.restore(made.snapshot())
        queries = made.queries()
        made.remove(body.id)
        with made.copy() as copy:
            copy.step()
    return [made, copy, body, sensors, queries]


def worlds() -> list[Any]:
    """Many worlds, and their states, which are saved and restored."""
    with carom.World() as one:
        one.add_plane()
        body = one.load_urdf(DROID, (0.0, 0.0, 1.0))
        made = carom.Worlds(one, 3)
        made.step(2)
        state = made.snapshot()
        made.step()
        made.restore(state)
        made.contacts(body)
        batch = made[body]
        batch.joints.set_position_targets(0.0)
    return [one, made, batch, made._scene, made._engine]


def saved_world() -> list[Any]:
    """A world that is saved to a file, and one restored from it."""
    path = _folder() / "saved.carom"
    with carom.World() as made, carom.World() as other:
        for one in (made, other):
            one.load_urdf(DROID)
        made.step()
        made.save(path)
        other.restore(path)
        made.restore(made.snapshot())
    return [made, other]


def viewer() -> list[Any]:
    """A world that is shown, by a server of pages."""
    with carom.World() as shown:
        shown.load_urdf(DROID)
        made = Viewer(shown, shown.lock, port=0)
        shown.step()
        made.close()
    return [shown, made, made._server]


def vector() -> list[Any]:
    """A vector environment."""
    made: Any = gymnasium.make_vec("carom/PandaReach-v0", num_envs=2, vectorization_mode="vector_entry_point")
    made.reset(seed=0)
    made.step(np.zeros(made.action_space.shape, np.float32))
    made.close()
    return [made.unwrapped, made.unwrapped.worlds]


def environment() -> list[Any]:
    """An environment of PyBullet."""
    made: Any = gymnasium.make("HopperBulletEnv-v0")
    made.reset()
    made.step(np.zeros(made.action_space.shape, np.float32))
    made.close()
    return [made.unwrapped, made.unwrapped.robot, made.unwrapped.camera]


KINDS: dict[str, Callable[[], list[Any]]] = {
    make.__name__: make
    for make in (
        *(client, full_client, window, soft, served, world, measured_world),
        *(worlds, saved_world, viewer, vector, environment),
    )
}
_KEY = 48_117


def _of_client(number: int) -> list[Any]:
    made = clients[number]
    return [made, made.world, made.world.engine, *made.world.bodies.values()]


@cache
def _folder() -> Path:
    return Path(tempfile.mkdtemp())
