"""Measurements from files and logs: PyBullet's state logs, CSV, NumPy's archives, arrays, `World.log`."""

from __future__ import annotations

import csv
from collections.abc import Mapping
from pathlib import Path
from struct import Struct, calcsize
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.identification.chosen_body import moving_joints
from carom.identification.mcap_file import read_mcap
from carom.identification.measurements import Measurements

if TYPE_CHECKING:
    from carom.scene.body import Body

_MARKER = b"\xaa\xbb"
_OF_BASE = ("base_positions", "base_orientations", "base_velocities")
_KINDS = {
    "position": "positions",
    "velocity": "velocities",
    "acceleration": "accelerations",
    "torque": "torques",
}


def measurements_of(log: Any, body: Body, controls: Mapping[str, Any] | None = None) -> Measurements:
    """Measurements of a body's joints from any log that `carom.identify` takes.

    Raises:
        ValueError: The log lacks something, or has another format.
        OSError: The file cannot be read.
    """
    if isinstance(log, Measurements):
        return log
    if isinstance(log, (str, Path)) and Path(log).suffix.lower() == ".mcap":
        return read_mcap(log, body)
    if isinstance(log, (str, Path)):
        values = _read(Path(log), body)
    elif isinstance(log, Mapping):
        values = dict(log)
    else:
        values = _of_world_log(log, body)
    names = ["time", *_KINDS.values(), "controls", *_OF_BASE, "forces", "sensors"]
    unknown = sorted(values.keys() - set(names))
    if unknown:
        known = ", ".join(names)
        raise ValueError(f"a log has no {unknown[0]!r}; what it can have is {known}")
    joints = sum(body.velocity_count)
    if "time" not in values or ("positions" not in values and joints):
        raise ValueError("a log needs time and positions")
    values["controls"] = {**values.get("controls", {}), **(controls or {})}
    found = Measurements.of(values.pop("time"), values.pop("positions", None), **values)
    if found.positions.shape[1] != joints:
        raise ValueError(
            f"the log has {found.positions.shape[1]} joints; {body.name!r} has {joints} that can move"
        )
    return found


def _read(path: Path, body: Body) -> dict[str, Any]:
    kind = path.suffix.lower()
    if kind == ".csv":
        return _read_csv(path, body)
    if kind == ".npz":
        with np.load(path) as archive:
            arrays = {name: archive[name] for name in archive.files}
        own = {name: arrays.pop(name) for name in ("time", *_KINDS.values(), *_OF_BASE) if name in arrays}
        for group in ("forces", "sensors"):
            start = f"{group}."
            named = {name.removeprefix(start) for name in arrays if name.startswith(start)}
            if named:
                own[group] = {name: arrays.pop(start + name) for name in sorted(named)}
        return {**own, "controls": arrays}
    return _read_bullet(path, body)


def _read_csv(path: Path, body: Body) -> dict[str, Any]:
    """Columns `time`, `JOINT.position` and so on; all others are controls."""
    with path.open(newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    if not rows:
        raise ValueError(f"{path} is empty")
    names = [name.strip() for name in rows[0]]
    try:
        table = np.array([row for row in rows[1:] if row], dtype=float)
    except ValueError as reason:
        raise ValueError(f"{path}: all rows below the names must be numbers: {reason}") from None
    columns = dict(zip(names, table.T, strict=True))
    values: dict[str, Any] = {}
    if "time" in columns:
        values["time"] = columns.pop("time")
    joints = moving_joints(body)
    for end, kind in _KINDS.items():
        wanted = [f"{joint}.{end}" for joint in joints]
        missing = [name for name in wanted if name not in columns]
        if not missing:
            values[kind] = np.stack([columns.pop(name) for name in wanted], axis=1)
        elif len(missing) < len(wanted) or end == "position":
            raise ValueError(f"{path} has no column {missing[0]!r}")
    return {**values, "controls": columns}


def _read_bullet(path: Path, body: Body) -> dict[str, Any]:
    """A log of `STATE_LOGGING_GENERIC_ROBOT`: records after steps, with the torques of these steps."""
    data = path.read_bytes()
    lines = data.split(b"\n", 2)
    names = lines[0].decode("ascii", "replace").split(",")
    if len(lines) < 3 or "stepCount" not in names or "qNum" not in names:
        raise ValueError(
            f"{path} is no log of STATE_LOGGING_GENERIC_ROBOT, .csv, .npz or .mcap file: these can be read"
        )
    record = Struct(f"<{lines[1].decode('ascii', 'replace')}")
    rows: list[tuple[Any, ...]] = []
    records, at = lines[2], 0
    size = calcsize(record.format)
    while at + 2 <= len(records):
        if records[at : at + 2] != _MARKER:
            raise ValueError(f"{path} is damaged: no record begins at byte {at}")
        if at + 2 + size > len(records):
            break
        rows.append(record.unpack_from(records, at + 2))
        at += 2 + size
    column = {name: place for place, name in enumerate(names)}
    bodies = sorted({row[column["objectId"]] for row in rows})
    if len(bodies) > 1:
        rows = [row for row in rows if row[column["objectId"]] == body.id]
    if len(rows) < 2:
        raise ValueError(f"{path} has {len(rows)} records of the body; its bodies are {bodies}")
    table = np.array(rows, dtype=float)
    joints = int(table[0, column["qNum"]])

    def numbers(letter: str) -> np.ndarray:
        return table[:, [column[f"{letter}{index}"] for index in range(joints)]]

    values = {
        "time": table[:, column["timeStamp"]],
        "positions": numbers("q"),
        "velocities": numbers("u"),
    }
    if "t0" in column:
        # The torques of a record led to its state: they belong to the one before.
        values["torques"] = np.concatenate([numbers("t")[1:], np.full((1, joints), np.nan)])
    return values


def _of_world_log(log: Any, body: Body) -> dict[str, Any]:
    """A log of `World.log` with positions and velocities of all bodies."""
    try:
        time, position = log["time"], log["position"]
    except (KeyError, TypeError):
        raise ValueError(
            f"a log is a path, arrays by name, Measurements, or World.log(), not {type(log).__name__}"
        ) from None
    q = [body.position_index[j] for j, count in enumerate(body.velocity_count) if count]
    values = {"time": time, "positions": position[:, q]}
    try:
        velocity = log["velocity"]
    except KeyError:
        return values
    u = [body.velocity_index[j] for j, count in enumerate(body.velocity_count) if count]
    return {**values, "velocities": velocity[:, u]}
