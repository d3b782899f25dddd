"""Saving and restoring the state of a world."""

from __future__ import annotations

from pathlib import Path

from carom.errors import CaromError
from pybullet._calls.arguments import integer, text
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._clients.clients import client_of
from pybullet._shapes.shape_arguments import find_file

__all__ = ["loadBullet", "removeState", "restoreState", "saveBullet", "saveState"]

_CANNOT_LOAD = "Couldn't load .bullet file."
_CANNOT_RESTORE = "Couldn't restore state."


@exported
def saveState(physicsClientId: int = 0) -> int:
    """Saves the state of the world in memory: all that the next step starts from.

    This includes positions and velocities, motors and their targets, applied forces, contacts and their
    impulses. Masses, friction, constraints, gravity and the other parameters of the engine are not part
    of it.

    Args:
        physicsClientId: The connection.

    Returns:
        The id of the state: the lowest free one.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> state = p.saveState()
        >>> p.resetJointState(arm, 0, 1.0)
        >>> p.restoreState(state)
        >>> p.getJointState(arm, 0)[0]
        0.0
    """
    client = client_of(physicsClientId)
    with client.call_lock:
        number = next(n for n in range(len(client.states) + 1) if n not in client.states)
        client.states[number] = client.world.snapshot()
        return number


@exported
def restoreState(stateId: int = -1, fileName: str | None = None, physicsClientId: int = 0) -> None:
    """Restores a state. The steps that follow are the same, bit for bit, as after saving.

    Args:
        stateId: A state of `saveState`; it can be restored any number of times.
        fileName: A file of `saveBullet` instead, Carom's or PyBullet's: as given, in `data` folders near the
            working directory, or in the directory of `setAdditionalSearchPath`. From a file that PyBullet
            wrote, bodies get their poses, velocities and joint states, matched by their order as in PyBullet;
            contacts are found at the next step.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, there is no such state or file, the file cannot be used, or bodies were
            added or removed since, or have other joints. The world is then unchanged.

    Examples:
        >>> state = p.saveState()
        >>> p.resetBasePositionAndOrientation(cube, [0, 0, 9], [0, 0, 0, 1])
        >>> p.restoreState(stateId=state)
        >>> p.getBasePositionAndOrientation(cube)[0]
        (0.5, 0.0, 0.025)
    """
    client = client_of(physicsClientId)
    number = integer(stateId, "stateId")
    with client.call_lock:
        if number >= 0 or fileName is None:
            if number not in client.states:
                fail(_CANNOT_RESTORE, f"There is no state {number}.")
            state = client.states[number]
        else:
            # PyBullet's files keep bodies with maximal coordinates apart.
            state = find_file(client, text(fileName, "fileName"), _CANNOT_RESTORE)
        try:
            # As in PyBullet, getLinkState returns current poses after this call.
            client.world.restore(state, update_poses=True, maximal=client.maximal)
        except CaromError as problem:
            fail(_CANNOT_RESTORE, f"{str(problem)[0].upper()}{str(problem)[1:]}.")


@exported
def removeState(stateUniqueId: int, physicsClientId: int = 0) -> None:
    """Removes a state. One that does not exist is no error.

    Args:
        stateUniqueId: The state; its id is free again.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> state = p.saveState()
        >>> p.removeState(state)
    """
    client = client_of(physicsClientId)
    with client.call_lock:
        client.states.pop(integer(stateUniqueId, "stateUniqueId"), None)


@exported
def saveBullet(bulletFileName: str, physicsClientId: int = 0) -> None:
    """Writes the world to a file.

    The file contains bodies with their meshes, colours and textures, constraints, parameters, user data and
    the state. The format is Carom's own, not PyBullet's; see docs/world-files.md.

    Args:
        bulletFileName: The file; an existing one is replaced.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, the file cannot be written, or it could not be loaded again, which the
            message explains.

    Examples:
        >>> p.saveBullet(folder + "/scene.bullet")
        >>> p.restoreState(fileName=folder + "/scene.bullet")
    """
    from carom.world_files.world_file import save_world

    client = client_of(physicsClientId)
    path = text(bulletFileName, "bulletFileName")
    try:
        with client.call_lock:
            save_world(client.world, Path(path))
    except (CaromError, OSError, ValueError) as problem:
        fail("Couldn't save .bullet file.", f"{problem}.")


@exported
def loadBullet(bulletFileName: str, physicsClientId: int = 0) -> tuple[int, ...]:
    """Adds the bodies of a file of `saveBullet`, with their state and constraints.

    A world without bodies becomes the one that was saved, body ids, gravity and the other parameters
    included, and continues exactly as that one did.

    Args:
        bulletFileName: The file: as given, in `data` folders near the working directory, or in the
            directory of `setAdditionalSearchPath`.
        physicsClientId: The connection.

    Returns:
        The ids of the bodies.

    Raises:
        pybullet.error: Not connected, the file is missing or damaged, or it is not a file of Carom's
            `saveBullet`: from PyBullet's, only `restoreState` can restore something. The world is then
            unchanged.

    Examples:
        >>> p.saveBullet(folder + "/scene.bullet")
        >>> p.resetSimulation()
        >>> p.loadBullet(folder + "/scene.bullet")
        (0, 1, 2)
    """
    client = client_of(physicsClientId)
    path = find_file(client, text(bulletFileName, "bulletFileName"), _CANNOT_LOAD)
    with client.call_lock:
        client.bodies.forget_all()
        try:
            bodies = client.world.load_saved(path)
        except CaromError as problem:
            fail(_CANNOT_LOAD, f"{problem}.")
        client.time_step = client.world.parameters.time_step
        client.report_analytics = bool(client.world.parameters.report_solver_analytics)
        for body in bodies:
            client.origins.pop(body.id, None)
            client.maximal.discard(body.id)
            body.update_link_poses()
        return tuple(body.id for body in bodies)
