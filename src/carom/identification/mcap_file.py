"""Joint states from MCAP files: recordings of ROS 2, ROS 1 and Foxglove."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from carom.checks import Array
from carom.identification.chosen_body import moving_joints
from carom.identification.measurements import Measurements

if TYPE_CHECKING:
    from carom.scene.body import Body

# How messages are encoded, and what reads them besides `mcap`: a module, and the distribution that has it.
_DECODERS = {
    "cdr": ("mcap_ros2.decoder", "mcap-ros2-support"),
    "ros1": ("mcap_ros1.decoder", "mcap-ros1-support"),
}
_NANOSECONDS = 1e-9
_FIELDS = {"position": "positions", "velocity": "velocities", "effort": "torques"}
_COMMAND = "pip install 'carom[mcap]'"


class _State(NamedTuple):
    time: float
    values: dict[str, list[float]]


def read_mcap(path: str | Path, body: Body, topic: str | None = None) -> Measurements:
    """Measurements of a robot's joints from the joint states of an MCAP file.

    Messages are those of `sensor_msgs/JointState` of ROS 2 or ROS 1, or JSON with the same fields: `name`,
    `position`, and where they have as many entries `velocity` and `effort`. Their time is that of their
    header, or else that of the log. What came at unequal intervals is taken at equal ones, between
    neighbours on a line.

    Args:
        path: The file.
        body: The robot, by whose joints columns are found; others in messages are left out.
        topic: Of the messages; by default the only one with all joints of the robot.

    Returns:
        Rows at the mean interval, from the first message to the last.

    Raises:
        ValueError: There is no such topic, or several, or messages lack something.
        ImportError: A package that reads the messages is missing; the text says which.
        OSError: The file cannot be read.
    """
    file = Path(path)
    joints = moving_joints(body)
    found: dict[str, list[_State]] = {}
    seen: dict[str, set[str]] = {}
    for name, state, has in _joint_states(file, topic):
        seen.setdefault(name, set()).update(has)
        if set(joints) <= set(has):
            order = [has.index(joint) for joint in joints]
            values = {key: [row[k] for k in order] for key, row in state.values.items()}
            found.setdefault(name, []).append(_State(state.time, values))
    if not found:
        told = "; ".join(f"{name!r} has {', '.join(sorted(has))}" for name, has in seen.items())
        missing = ", ".join(sorted(set(joints) - set().union(*seen.values()))) or ", ".join(joints)
        raise ValueError(
            f"{file}: no topic{'' if topic is None else f' {topic!r}'} has states of all joints of "
            f"{body.name!r}; missing: {missing} ({told or 'there are no joint states'})"
        )
    if len(found) > 1:
        raise ValueError(
            f"{file}: {', '.join(map(repr, found))} have states of all joints: say which by topic"
        )
    return _measurements(file, next(iter(found.values())))


def _measurements(file: Path, states: list[_State]) -> Measurements:
    states = sorted(states, key=lambda state: state.time)
    time = np.array([state.time for state in states])
    kept = np.concatenate([[True], np.diff(time) > 0.0])
    if kept.sum() < 2:
        raise ValueError(f"{file}: there are fewer than two states at different times")
    even = np.linspace(time[0], time[-1], int(kept.sum()))
    arrays: dict[str, Array] = {}
    for key, name in _FIELDS.items():
        if all(key in state.values for state in states):
            values = np.array([state.values[key] for state in states], dtype=float)[kept]
            arrays[name] = np.stack([np.interp(even, time[kept], column) for column in values.T], axis=1)
    if "positions" not in arrays:
        raise ValueError(f"{file}: not all states have positions")
    velocities, torques = arrays.get("velocities"), arrays.get("torques")
    return Measurements.of(even - even[0], arrays["positions"], velocities=velocities, torques=torques)


def _joint_states(file: Path, topic: str | None) -> Iterator[tuple[str, _State, list[str]]]:
    """Topics, states, and names of their joints, of all messages that have some."""
    try:
        reader: Any = import_module("mcap.reader")
    except ImportError as reason:
        raise ImportError(f"reading MCAP files needs the package mcap: {_COMMAND}") from reason
    decoders: dict[int, Callable[[bytes], Any] | None] = {}
    with file.open("rb") as stream:
        try:
            for schema, channel, message in reader.make_reader(stream).iter_messages(topics=topic):
                if channel.id not in decoders:
                    decoders[channel.id] = _decoder(channel.message_encoding, schema)
                decode = decoders[channel.id]
                if decode is None:
                    continue
                state = _state(decode(message.data), message.log_time)
                if state is not None:
                    yield channel.topic, *state
        except (ImportError, OSError):
            raise
        # Of a damaged file the packages raise whatever comes, of their own and of the standard library.
        except Exception as reason:
            raise ValueError(f"{file} is no MCAP file, or is damaged: {reason}") from reason


def _decoder(encoding: str, schema: Any) -> Callable[[bytes], Any] | None:
    """What decodes messages; None for those that are no joint states."""
    if encoding == "json":
        return json.loads
    if encoding not in _DECODERS or schema is None or not schema.name.endswith("/JointState"):
        return None
    module, distribution = _DECODERS[encoding]
    try:
        made: Any = import_module(module).DecoderFactory()
    except ImportError as reason:
        raise ImportError(
            f"messages of the encoding {encoding!r} need: pip install {distribution}"
        ) from reason
    return made.decoder_for(encoding, schema)


def _state(message: Any, log_time: int) -> tuple[_State, list[str]] | None:
    """A joint state, and the names of its joints; None if the message is none."""

    def part(owner: Any, key: str) -> Any:
        return owner.get(key) if isinstance(owner, dict) else getattr(owner, key, None)

    names = part(message, "name")
    if not isinstance(names, (list, tuple)) or not names:
        return None
    values: dict[str, list[float]] = {}
    for key in _FIELDS:
        row = part(message, key)
        if row is not None and len(row) == len(names):
            values[key] = [float(value) for value in row]
    stamp = part(part(message, "header"), "stamp")
    seconds = next((part(stamp, key) for key in ("sec", "secs") if part(stamp, key) is not None), 0)
    rest = next((part(stamp, key) for key in ("nanosec", "nsec", "nsecs") if part(stamp, key) is not None), 0)
    time = seconds + _NANOSECONDS * rest if seconds or rest else _NANOSECONDS * log_time
    return _State(time, values), [str(name) for name in names]
