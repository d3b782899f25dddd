"""Logs of commands: recording every call that changes the world, and replaying them.

The calls are recorded by a detour that exists as long as the log; steps are recorded by an observer of the
world, so those of a real-time simulation are included.
docs/command-logs.md describes the format. Reading a log runs no code from it, and no command writes files.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from operator import index
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple
from zlib import crc32

from carom.errors import DescriptionError
from carom.files.bounded import read_bounded
from carom.remote.errors import Malformed
from carom.remote.values import pack, padded, unpack
from pybullet._calls.detours import Function, add_detour, call_on, detour_of, functions, remove_detour
from pybullet._clients.log_file import LogFile

if TYPE_CHECKING:
    from pybullet._clients.clients import Client

_STEP = "stepSimulation"
_NAMES = """
addUserData applyExternalForce applyExternalTorque changeConstraint changeDynamics changeTexture
changeVisualShape createCollisionShape createCollisionShapeArray createConstraint createMultiBody
createSoftBodyAnchor createVisualShape createVisualShapeArray enableJointForceTorqueSensor
executePluginCommand loadBullet loadMJCF loadPlugin loadSDF loadSoftBody loadTexture loadURDF
performCollisionDetection removeBody removeCollisionShape removeConstraint removeState removeUserData
resetBasePositionAndOrientation resetBaseVelocity resetJointState resetJointStateMultiDof
resetJointStatesMultiDof resetMeshData resetSimulation resetVisualShapeData restoreState saveState
setAdditionalSearchPath setCollisionFilterGroupMask setCollisionFilterPair setDefaultContactERP setGravity
setInternalSimFlags setJointMotorControl setJointMotorControl2 setJointMotorControlArray
setJointMotorControlMultiDof setJointMotorControlMultiDofArray setPhysicsEngineParameter setTimeStep
stepSimulation unloadPlugin unsupportedChangeScaling
"""
COMMANDS = frozenset(_NAMES.split())
"""Functions that a log records: those that change the results of later steps or queries."""

_HEADER = struct.Struct("<8s2I")
_MAGIC, _VERSION = b"\x89CALOG\r\n", 1
_CHECK = struct.Struct("<I")
_SIZES = struct.Struct("<IQ")


class Command(NamedTuple):
    """One call: the name of a function, one of `COMMANDS`, its arguments, and its result; None for steps."""

    name: str
    arguments: list[Any]
    keywords: dict[str, Any]
    result: Any


class CommandLog:
    """Records the calls of a client until it is closed.

    Each call is written to the file when it returns, so the log of a killed process is complete. Calls that
    raise an exception are not recorded: they change nothing.

    Raises:
        OSError: The file cannot be written.
    """

    def __init__(self, number: int, client: Client, path: Path) -> None:
        self._number = index(number)
        self._client = client
        self._file = LogFile(path, buffered=False)
        self._file.write(_HEADER.pack(_MAGIC, _VERSION, 0))
        self._step = _record(Command(_STEP, [], {}, None))
        self._way = detour_of(self._number)
        add_detour(self._number, self)

    def call(self, function: Function, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
        """Calls a function, and records the call."""
        if function.name not in COMMANDS or function.name == _STEP:
            return self._pass_on(function, arguments, keywords)
        # The lock is held so that the order in the file is that of the calls.
        with self._client.call_lock:
            result = self._pass_on(function, arguments, keywords)
            positional, named = function.with_client(0, list(arguments), keywords)
            self._file.write(_record(Command(function.name, positional, named, result)))
            return result

    def before_step(self) -> None:
        """Does nothing: the step is recorded afterwards."""

    def after_step(self) -> None:
        """Records a step."""
        self._file.write(self._step)

    def close(self) -> None:
        """Ends the log."""
        # If the client was closed, its detour has been removed already.
        if detour_of(self._number) is self:
            if self._way is None:
                remove_detour(self._number)
            else:
                add_detour(self._number, self._way)
        self._file.close()

    def _pass_on(self, function: Function, arguments: tuple[Any, ...], keywords: dict[str, Any]) -> Any:
        if self._way is None:
            return function.plain(*arguments, **keywords)
        return self._way.call(function, arguments, keywords)


def replay(number: int, client: Client, path: Path) -> None:
    """Replays the commands of a log. The whole file is checked before the first command.

    Raises:
        ValueError: The file cannot be read, is not such a log, or damaged; then nothing is done. Or a
            command fails, or its result differs from the recorded one; then the commands before it have been
            performed.
    """
    try:
        data, _ = read_bounded(path)
    except DescriptionError as problem:
        raise ValueError(str(problem)) from problem
    content = memoryview(data)
    try:
        for _ in _commands(content):
            pass
        for place, command in enumerate(_commands(content)):
            try:
                _perform(index(number), client, command)
            # The file may be forged, so it may contain any argument.
            except Exception as problem:
                raise Malformed(
                    f"command {place + 1}, {command.name}, cannot be repeated; the {place} before it have "
                    f"been performed: {str(problem).rstrip('.')}"
                ) from problem
    except Malformed as problem:
        raise ValueError(f"{path}: {problem}") from problem


def _perform(number: int, client: Client, command: Command) -> None:
    if command.name == _STEP:
        # The public function would wait while the simulation is paused.
        with client.call_lock:
            client.world.step()
        return
    function = functions()[command.name]
    arguments, keywords = function.with_client(number, command.arguments, command.keywords)
    result = call_on(number, function, tuple(arguments), keywords)
    # The packed bytes are compared, because tuples of the recorded result have become lists.
    if pack(result) != pack(command.result):
        raise Malformed(
            f"it gives {result!r} and gave {command.result!r}; the world has to be as it was at the start of "
            "the log"
        )


def _record(command: Command) -> bytes:
    message, arrays = pack(tuple(command))
    contents = b"".join(bytes(array).ljust(padded(len(array)), b"\0") for array in arrays)
    checked = _SIZES.pack(len(message), len(contents)) + message + contents
    return _CHECK.pack(crc32(checked)) + checked


def _commands(content: memoryview) -> Iterator[Command]:
    """The commands of a file; raises `Malformed` at the first error."""
    if len(content) < _HEADER.size or bytes(content[: len(_MAGIC)]) != _MAGIC:
        raise Malformed("this is no log of commands")
    _, version, _ = _HEADER.unpack_from(content)
    if version != _VERSION:
        raise Malformed(f"the log has version {version} of the format; this is version {_VERSION}")
    place, start = 0, _HEADER.size
    while start < len(content):
        place += 1
        body = start + _CHECK.size + _SIZES.size
        if body > len(content):
            raise Malformed(f"the log is cut off in command {place}")
        message_size, contents_size = _SIZES.unpack_from(content, start + _CHECK.size)
        middle = body + message_size
        end = middle + contents_size
        if end > len(content):
            raise Malformed(f"the log is cut off in command {place}")
        if _CHECK.unpack_from(content, start)[0] != crc32(content[start + _CHECK.size : end]):
            raise Malformed(f"command {place} is damaged")
        yield _command(place, unpack(content[body:middle], content[middle:end], lists=True))
        start = end


def _command(place: int, value: Any) -> Command:
    match value:
        case [str() as name, list() as arguments, dict() as keywords, result] if all(
            isinstance(key, str) for key in keywords
        ):
            if name not in COMMANDS:
                raise Malformed(f"command {place} is {name!r}, which logs do not hold")
            return Command(name, arguments, keywords, result)
    raise Malformed(f"command {place} is no call of a function")
