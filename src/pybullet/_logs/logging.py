"""Logging of states, contacts and timings to files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from pybullet._calls import constants
from pybullet._calls.arguments import by_name, integer, sequence, text
from pybullet._calls.builtin import exported, exported_as
from pybullet._calls.errors import fail, logger
from pybullet._clients.clients import client_of

if TYPE_CHECKING:
    from carom.recording.recorder import Film
    from pybullet._clients.clients import Client
    from pybullet._clients.log_registry import StateLog
    from pybullet._clients.timing_log import TimingLog

__all__ = ["startStateLogging", "stopStateLogging", "submitProfileTiming"]

_DEFAULT_ROOM = 12
# A body with this many joints could not be simulated at a useful speed.
_MAX_ROOM = 10_000


@exported
def startStateLogging(
    loggingType: int,
    fileName: str,
    objectUniqueIds: Sequence[int] | None = None,
    maxLogDof: int = -1,
    bodyUniqueIdA: int = -1,
    bodyUniqueIdB: int = -1,
    linkIndexA: int = -2,
    linkIndexB: int = -2,
    deviceTypeFilter: int = -1,
    logFlags: int = -1,
    physicsClientId: int = 0,
) -> Any:
    """Starts a log, written after each step or substep.

    Args:
        loggingType: `STATE_LOGGING_GENERIC_ROBOT` for bases and joints, `STATE_LOGGING_CONTACT_POINTS`
            for contacts, `STATE_LOGGING_MINITAUR` for the motors of a Minitaur, all in PyBullet's binary
            layouts; `STATE_LOGGING_PROFILE_TIMINGS` for a timing profile of steps and of the zones of
            `submitProfileTiming`, which Chrome can show, in `fileName` with `_0.json` appended;
            `STATE_LOGGING_VIDEO_MP4` for a video of 60 pictures for each second of simulated time, seen from
            the camera of the window, which needs `pip install 'carom[video]'` and works in `DIRECT` too, one
            at a time: a new one ends the one before;
            `STATE_LOGGING_VR_CONTROLLERS` for an empty log.

            `STATE_LOGGING_ALL_COMMANDS` for all calls that change the world, one such log at a time;
            `STATE_REPLAY_ALL_COMMANDS` performs them before it returns, with the same results, bit for bit,
            in a world in the same state as at the start of the log. See docs/command-logs.md.
        fileName: The file; an existing one is replaced, or read by `STATE_REPLAY_ALL_COMMANDS`.
        objectUniqueIds: Bodies to log; an empty list for all, but a Minitaur has to be given. Bodies with
            more joints than columns, or with spherical or planar joints, are left out.
        maxLogDof: Number of joints that have columns, at most 10,000; 12 if negative.
        bodyUniqueIdA: Body whose contacts are logged; -1 for any.
        bodyUniqueIdB: The other body of these contacts; -1 for any.
        linkIndexA: Link of `bodyUniqueIdA` whose contacts are logged; -2 for any.
        linkIndexB: Link of `bodyUniqueIdB`; -2 for any.
        deviceTypeFilter: Not used: there are no devices.
        logFlags: `STATE_LOG_JOINT_MOTOR_TORQUES`, `STATE_LOG_JOINT_USER_TORQUES` or both, added up, for
            columns of torques.
        physicsClientId: The connection.

    Returns:
        The id of the log; None for types that log nothing (`STATE_LOGGING_CUSTOM_TIMER` and others), if the
        first body is not a Minitaur, and if there is a log of commands already.

    Raises:
        pybullet.error: Not connected, the file cannot be written, `objectUniqueIds` is not a sequence, a
            video is asked for and PyAV is not installed, or a log cannot be replayed: its file is missing or
            damaged (then nothing is done), or one of its commands fails.

    Examples:
        >>> log = p.startStateLogging(p.STATE_LOGGING_GENERIC_ROBOT, folder + "/arm.bin", [arm])
        >>> _ = p.stepSimulation()
        >>> p.stopStateLogging(log)
    """
    client = client_of(physicsClientId)
    kind, path = integer(loggingType, "loggingType"), text(fileName, "fileName")
    problem = "startStateLogging failed."
    given = () if objectUniqueIds is None else sequence(objectUniqueIds, problem, "objectUniqueIds")
    bodies = [integer(body, "objectUniqueIds") for body in given]
    room, flags = integer(maxLogDof, "maxLogDof"), integer(logFlags, "logFlags")
    if room > _MAX_ROOM:
        fail(problem, f"maxLogDof is {room}; at most {_MAX_ROOM} are possible.")
    sides = (
        (integer(bodyUniqueIdA, "bodyUniqueIdA"), integer(linkIndexA, "linkIndexA")),
        (integer(bodyUniqueIdB, "bodyUniqueIdB"), integer(linkIndexB, "linkIndexB")),
    )
    integer(deviceTypeFilter, "deviceTypeFilter")

    from pybullet._logs import log_files as files

    log: StateLog | None = None
    try:
        if kind == constants.STATE_LOGGING_GENERIC_ROBOT:
            room = _DEFAULT_ROOM if room < 0 else room
            log = files.RobotLog(Path(path), client.world, frozenset(bodies), room, flags)
        elif kind == constants.STATE_LOGGING_MINITAUR:
            from pybullet._logs.minitaur_log import MinitaurLog, minitaur_motors

            robot = minitaur_motors(client.world, bodies)
            if robot is not None:
                log = MinitaurLog(Path(path), *robot)
        elif kind == constants.STATE_LOGGING_CONTACT_POINTS:
            log = files.ContactLog(Path(path), physicsClientId, client.world, sides)
        elif kind == constants.STATE_LOGGING_PROFILE_TIMINGS:
            from pybullet._clients.timing_log import TimingLog

            log = TimingLog(Path(path))
        elif kind == constants.STATE_LOGGING_VR_CONTROLLERS:
            log = files.ControllerLog(Path(path))
        elif kind == constants.STATE_LOGGING_VIDEO_MP4:
            log = _video(client, Path(path))
        elif kind in (constants.STATE_LOGGING_ALL_COMMANDS, constants.STATE_REPLAY_ALL_COMMANDS):
            from pybullet._logs.command_log import CommandLog, replay

            if kind == constants.STATE_REPLAY_ALL_COMMANDS:
                replay(physicsClientId, client, Path(path))
            elif not any(isinstance(other, CommandLog) for other in client.logs.by_id.values()):
                log = CommandLog(physicsClientId, client, Path(path))
    except (OSError, ValueError, ImportError) as reason:
        fail(problem, f"{reason}.")
    unwritten = constants.STATE_REPLAY_ALL_COMMANDS, constants.STATE_LOGGING_VIDEO_MP4
    if log is None and kind not in unwritten:
        if kind == constants.STATE_LOGGING_MINITAUR:
            logger.warning("startStateLogging: the first of objectUniqueIds is no Minitaur.")
        elif kind == constants.STATE_LOGGING_ALL_COMMANDS:
            logger.warning("startStateLogging: commands are being logged already.")
        else:
            logger.warning("startStateLogging: logs of type %d are not available.", kind)
        return None
    with client.call_lock:
        return client.logs.start(client.world, log)


def _video(client: Client, path: Path) -> Film | None:
    """A video; None if PyAV is not installed and there is no window that a video could be expected of."""
    from pybullet._window.film import film_of

    try:
        return film_of(client, path)
    except ImportError as reason:
        if client.window.camera_info()[0]:
            raise
        logger.warning("startStateLogging: no video is made: %s.", reason)
        return None


@exported
def stopStateLogging(loggingId: int, physicsClientId: int = 0) -> None:
    """Ends a log and finishes its file. One that does not exist is no error.

    Args:
        loggingId: The log.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or not everything could be written: the disk is full.

    Examples:
        >>> log = p.startStateLogging(p.STATE_LOGGING_CONTACT_POINTS, folder + "/contacts.bin")
        >>> p.stopStateLogging(log)
    """
    client = client_of(physicsClientId)
    with client.call_lock:
        client.logs.stop(client.world, integer(loggingId, "loggingId"))


@exported_as("(eventName=None, physicsClientId=0)")
def submitProfileTiming(eventName: str | None = None, physicsClientId: int = 0, **spaced: str | None) -> None:
    """Begins a named zone in the logs of `STATE_LOGGING_PROFILE_TIMINGS`, or ends the last one.

    Args:
        eventName: Name of a zone that begins; None ends one.
        physicsClientId: The connection.
        spaced: `"eventName "`: PyBullet's misspelt name of the first argument.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> log = p.startStateLogging(p.STATE_LOGGING_PROFILE_TIMINGS, folder + "/trace")
        >>> p.submitProfileTiming("plan")
        >>> p.submitProfileTiming()
        >>> p.stopStateLogging(log)
    """
    if spaced:
        eventName = by_name("submitProfileTiming", ("eventName ",), (), spaced)["eventName "]
    client = client_of(physicsClientId)
    if eventName is not None:
        name = text(eventName, "eventName")
        client.logs.zones.append(name)
        for log in _timing_logs(client):
            log.begin(name)
    elif client.logs.zones:
        name = client.logs.zones.pop()
        for log in _timing_logs(client):
            log.end(name)


def _timing_logs(client: Client) -> list[TimingLog]:
    if not client.logs.by_id:
        return []
    from pybullet._clients.timing_log import TimingLog

    return [log for log in client.logs.by_id.values() if isinstance(log, TimingLog)]
