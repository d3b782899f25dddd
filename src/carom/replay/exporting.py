"""Writing a replay in the formats of other programs, by the ending of the file's name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from carom.replay.foxglove_file import write_mcap
from carom.replay.gltf import gltf
from carom.replay.losses import (
    COLLISIONS,
    CONTACTS,
    EVENTS,
    JOINTS,
    SENSORS,
    TENDONS,
    VALUES,
    VELOCITIES,
    lost,
)
from carom.replay.reading import read
from carom.replay.replay import Replay
from carom.replay.rerun_file import write_rrd
from carom.writing import write_whole


def export(replay: Replay | str | Path, path: str | Path) -> tuple[str, ...]:
    """Write a replay for another program, by the ending of the file's name.

    Args:
        replay: The replay, or its page.
        path: The file to write; one that is there is replaced. `.glb` is binary glTF with one animation;
            `.mcap` has Foxglove's schemas and needs `pip install 'carom[foxglove]'`; `.rrd` is a recording of
            Rerun and needs `pip install 'carom[rerun]'`.

    Returns:
        What the replay holds and the file does not.

    Raises:
        DescriptionError: The page is no replay, or is damaged.
        ImportError: The package that writes the file is not installed.
        OSError: A file cannot be read or written.
        ValueError: The ending is another one, or the replay has no frames.
    """
    target = Path(path)
    write = _WRITERS.get(target.suffix.lower())
    if write is None:
        raise ValueError(f"{target}: it is written by its ending, which has to be {', '.join(_WRITERS)}")
    found = replay if isinstance(replay, Replay) else read(replay)
    if not len(found.times):
        raise ValueError(f"{target}: the replay {found.title!r} has no frames")
    return write(found, target)


def _write_glb(replay: Replay, path: Path) -> tuple[str, ...]:
    write_whole(path, gltf(replay))
    return lost(replay, CONTACTS, TENDONS, VALUES, JOINTS, SENSORS, VELOCITIES, COLLISIONS, EVENTS)


_WRITERS: dict[str, Callable[[Replay, Path], tuple[str, ...]]] = {
    ".glb": _write_glb,
    ".mcap": write_mcap,
    ".rrd": write_rrd,
}
