"""States of many worlds: to go back to, to log, and in files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from carom.checks import Array
from carom.engine.engine import Engine
from carom.native.gates import gated
from carom.render.world_looks import looks_of
from carom.scene.bodies import Bodies
from carom.world.world import World
from carom.worlds.body import BodyBatch
from carom.worlds.checkpoint import parameters_of, set_parameters
from carom.worlds.chosen import Mask, Where, world_numbers
from carom.worlds.face.state import FlatStates
from carom.worlds.keyframes import resets_to
from carom.worlds.lone import copy_coordinates, lone_world
from carom.worlds.saved import SavedWorlds
from carom.worlds.sensors import BatchSource
from carom.worlds.stepping import WorldsObserver
from carom.worlds.writing import assign

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from carom.worlds.face.log import WorldsLog
    from carom.worlds.worlds import Worlds


class WorldsKeeping:
    """Base class of `Worlds`: its states."""

    count: int
    time: Array
    halted: Mask
    call_lock: Any
    observers: list[WorldsObserver]
    _scene: World
    _engine: Engine
    _bodies: Bodies[BodyBatch]
    _sensors: BatchSource
    _unspent_times: Array
    _start: SavedWorlds

    @property
    def sensor_seeds(self) -> NDArray[np.int64]:
        """Seed of the noise of sensors in each world, a view (count,).

        At first `World.parameters.sensor_seed` and the numbers after it: a lone world with the seed of one of
        these has the same noise.
        """
        return self._sensors.own_seeds

    @property
    def state(self) -> FlatStates:
        """The state of all bodies as flat arrays with the world in front, which can be written to."""
        return FlatStates(self._engine)

    @gated("call_lock")
    def snapshot(self, where: Where | None = None) -> SavedWorlds:
        """The present states, for `restore`.

        Args:
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
        """
        worlds = world_numbers(self._engine.take(where), self.count)
        return SavedWorlds.take(self._engine, worlds, self.time[worlds], self._unspent_times[worlds])

    @gated("call_lock", section=True)
    def restore(self, start: SavedWorlds, where: Where | None = None) -> None:
        """Restore worlds to states of `snapshot`; the steps that follow are then the same, bit for bit.

        Args:
            start: States of all worlds, of which each chosen world gets its own; or one state for all chosen
                worlds; or one state for each chosen world.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Raises:
            ValueError: The states are of other bodies, or their number is wrong.
        """
        worlds = world_numbers(self._engine.take(where), self.count)
        self._put_back(start, worlds, start.rows_for(worlds, self.count))

    def _put_back(self, start: SavedWorlds, worlds: np.ndarray, rows: np.ndarray) -> None:
        """Restore worlds to some of the saved states, given by their rows."""
        start.put_back(self._engine, worlds, rows)
        self.time[worlds], self._unspent_times[worlds] = start.times[rows], start.unspent_times[rows]
        self.halted[worlds] = False

    @gated("call_lock")
    def checkpoint(self) -> dict[str, Any]:
        """States and parameters of all worlds, for `resume`, also in another process.

        Returns:
            Arrays, numbers and texts, in dictionaries and lists.
        """
        saved = self.snapshot()
        return {
            "bodies": [batch.name for batch in self._bodies.values()],
            "state": saved.state,
            "contacts": saved.contacts,
            "times": saved.times,
            "unspent_times": saved.unspent_times,
            "halted": self.halted.copy(),
            "sensor_seeds": self.sensor_seeds.copy(),
            "time_step": self._scene.parameters.time_step,
            "parameters": parameters_of(self._engine),
        }

    @gated("call_lock", section=True)
    def resume(self, saved: Mapping[str, Any]) -> None:
        """Give all worlds the states and parameters of `checkpoint`; they continue bit for bit.

        Args:
            saved: What `checkpoint` of as many copies of the same scene returned.

        Raises:
            ValueError: They are of other bodies, or of another number of worlds.
        """
        times = np.asarray(saved["times"])
        if len(times) != self.count:
            raise ValueError(f"this is a checkpoint of {len(times)} worlds; there are {self.count}")
        if saved["bodies"] != [batch.name for batch in self._bodies.values()]:
            raise ValueError(f"this is a checkpoint of worlds with other bodies: {saved['bodies']}")
        set_parameters(self._engine, saved["parameters"])
        state, contacts = dict(saved["state"]), dict(saved["contacts"])
        self.restore(SavedWorlds(np.arange(self.count), times, saved["unspent_times"], state, contacts))
        self.halted[:], self.sensor_seeds[:] = saved["halted"], saved["sensor_seeds"]
        self._scene.parameters.time_step = saved["time_step"]
        self._engine.update_settings(self._scene.parameters)

    @gated("call_lock")
    def set_start(self) -> None:
        """Let the present states be those that `reset` returns to; at first they are those when all began."""
        self._start = self.snapshot()

    @gated("call_lock", section=True)
    def reset(self, keyframe: str | None = None, where: Where | None = None) -> None:
        """Return to the start, or to a keyframe of the bodies that have one of this name, and to its time.

        Args:
            keyframe: Name of the keyframe; None for the start.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.

        Raises:
            KeyError: No body has a keyframe of this name.
            TypeError: It is no name.
        """
        worlds = world_numbers(self._engine.take(where), self.count)
        if keyframe is None:
            self._put_back(self._start, worlds, self._start.rows_for(worlds, self.count))
            return
        if not isinstance(keyframe, str):
            raise TypeError(f"a keyframe is found by its name, not by {keyframe!r}; where= says which worlds")
        writes, time = resets_to(self._scene, self._engine, keyframe, worlds)
        assign(*writes, (self.time, worlds, time), (self.halted, worlds, False))

    @gated("call_lock")
    def extract(self, world: int) -> World:
        """A copy of one of the worlds as a `World`, which continues exactly as it would.

        Raises:
            IndexError: There is no such world.
        """
        (number,) = world_numbers([world], self.count)
        lone = lone_world(
            self._scene,
            self._engine,
            int(number),
            float(self.time[number]),
            float(self._unspent_times[number]),
        )
        lone.parameters.sensor_seed = int(self.sensor_seeds[number])
        looks_of(self._scene, self.count).apply(int(number), lone)
        return lone

    @gated("call_lock", section=True)
    def copy_coordinates(self, number: int, world: World) -> None:
        """Copy the coordinates of one of the worlds to a `World`, for queries that `Worlds` does not have.

        The bodies that are present there are present in it afterwards.

        Args:
            number: Index of the world.
            world: A world with the same bodies, such as the original. Its velocities do not change.

        Raises:
            IndexError: There is no such world.
            ValueError: That world has other bodies.
        """
        (row,) = world_numbers([number], self.count)
        if world.arrays.used["position"] != self._engine.arrays.used["position"]:
            raise ValueError("that world has other bodies")
        copy_coordinates(self._engine, int(row), world)

    # Logs and files

    @gated("call_lock")
    def log(self, *names: str, every: int = 1) -> WorldsLog:
        """Record state arrays of all worlds after each step, until the log is stopped, as `World.log`.

        Args:
            *names: Names of arrays of `state`: `position`, `velocity`, `link_pose`, `motor_impulse`...
            every: Record every n-th step.

        Returns:
            The log: `log["position"]` is (steps, count, n), `log["time"]` (steps, count). Worlds that do not
            go on in a step are recorded as they stand.

        Raises:
            ValueError: There is no such array, or `every` is less than 1.
        """
        from carom.world.log import check_log
        from carom.worlds.face.log import WorldsLog

        check_log(names, every)
        return WorldsLog(self, names, every)

    @gated("call_lock")
    def save(self, path: str | Path) -> None:
        """Write everything of all worlds to a file, which `Worlds.load` reads.

        It has the bodies with their meshes, and of each world its state, what differs between worlds
        (parameters, colours and textures), and which are halted.

        Args:
            path: The file, in Carom's own format: end its name in .carom.

        Raises:
            ValueError: The name ends like a file of robots, such as .xml; the message says what writes these.
            OSError: The file cannot be written; an existing file is unchanged.
            carom.errors.StateError: It could not be loaded again; the message says why. An existing file is
                unchanged.
        """
        from carom.worlds.face.file import save_worlds

        save_worlds(cast("Worlds", self), Path(path))
