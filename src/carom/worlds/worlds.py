"""`Worlds`: many copies of a scene, stepped together."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike

from carom.checks import Array, positive
from carom.closed import Closed
from carom.engine.parameters import EngineParameters
from carom.native.cpu import core_count
from carom.native.gates import gated
from carom.scene.bodies import Bodies
from carom.scene.body import Body
from carom.scene.named import Named
from carom.world.face.solving import Solver
from carom.world.face.vectors import NamedVector, control_vector, sensor_vector, set_controls
from carom.world.world import World
from carom.worlds.algorithms.linearizing import Linearizing
from carom.worlds.body import BodyBatch
from carom.worlds.chosen import Chosen, Mask, Where
from carom.worlds.contact_queries import ContactQueries
from carom.worlds.devices import CPU, make_engine
from carom.worlds.face.asking import WorldsAsking
from carom.worlds.face.keeping import WorldsKeeping
from carom.worlds.parts.constraints import ConstraintQueries
from carom.worlds.saved import SavedWorlds
from carom.worlds.sensors import BatchSource
from carom.worlds.stepping import WorldsObserver, WorldsStepping

if TYPE_CHECKING:
    from carom.gpu.device import Device

# Attributes that are set by writing to their arrays, and those that cannot be set.
_IN_PLACE = frozenset(("time", "halted"))
_FOR_GOOD = frozenset(("count", "device"))
# Parameters that differ between worlds: their fields in the model, and the shape of one.
_VARYING: dict[str, tuple[str, tuple[int, ...]]] = {
    "gravity": ("gravity_vector", (3,)),
    "fluid_density": ("fluid_density", ()),
    "fluid_viscosity": ("fluid_viscosity", ()),
    "wind": ("fluid_wind", (3,)),
}


class Worlds(
    WorldsStepping, WorldsKeeping, WorldsAsking, ContactQueries, ConstraintQueries, Linearizing, Closed
):
    """Many worlds with the same bodies, each with its own state.

    Each is simulated, bit for bit, like a single world, for any number of other worlds and of threads.
    Besides the state, these may differ: gravity, fluid, masses and inertias, contact parameters, damping,
    joint limits, and which user constraints are active. The first axis of arrays is the world: (count, ...).

    Attributes:
        lock: The lock that all methods, and those of bodies, have from their arguments to their results; hold
            it to make several calls, or to use views, without those of other threads in between.
        count: Number of worlds.
        device: The device they are on.
        time: Simulated time of each world [s], shape (count,).
        halted: Which worlds are halted because a velocity became NaN or infinite, (count,). Their state is
            that before the step; `restore` makes them run again.

    Args:
        world: The world to copy; it is not changed.
        count: Number of worlds.
        device: Where they are stored and stepped: "cpu", "cuda" or a GPU by number such as "cuda:1". On a GPU
            views are arrays on the GPU, `carom.gpu.array.DeviceArray`; docs/gpu.md has more.
            ("warp-cpu" is for tests of the GPU code on the processor.)
        threads: Number of threads on the processor; None for the number of cores available.

    Raises:
        TypeError: It is no world.
        ValueError: A number is less than 1, or there is no such device.
        ImportError: For a GPU Warp has to be installed.
        NotImplementedError: On a GPU contacts cannot be rigid yet.
        MemoryError: There is not enough memory for so many worlds.
    """

    def __init__(
        self, world: World, count: int, *, device: str | Device = CPU, threads: int | None = None
    ) -> None:
        if not isinstance(world, World):
            raise TypeError(
                f"Worlds are copies of a World: carom.Worlds(world, count), not {world!r}; a file of "
                "worlds.save is read by carom.Worlds.load(path)"
            )
        if count < 1:
            raise ValueError(f"count must be at least 1, not {count}")
        if threads is not None and threads < 1:
            raise ValueError(f"threads must be at least 1, not {threads}")
        self.count: int = count
        self._thread_count = threads
        self._scene = world.copy()
        self.lock: Any = self._scene.lock
        self.call_lock: Any = self._scene.call_lock
        self._scene.prepare()
        self._engine = make_engine(self._scene, count, device, threads)
        self.device: str = device if isinstance(device, str) else device.name
        self._engine.update_settings(self._scene.parameters)
        self.time: Array = np.full(count, world.time)
        self._unspent_times = np.full(count, world.unspent_time)
        if self._engine.keeps_times:
            addresses = self.time.ctypes.data, self._unspent_times.ctypes.data
            self._engine.keep_times(*addresses, (self.time, self._unspent_times))
        self.halted: Mask = np.zeros(count, dtype=bool)
        # It is not known yet how long they take.
        self._steps_at_once = 1
        self.observers: list[WorldsObserver] = []
        workers = min(count, threads or core_count())
        self._sensors = BatchSource(self._scene, self._engine, self.time)
        self._bodies = Bodies(
            (number, BodyBatch(body, self._scene, self._engine, self._sensors, workers))
            for number, body in self._scene.bodies.items()
        )
        # One state is that of all.
        first = np.zeros(1, dtype=np.int64)
        times = self.time[:1], self._unspent_times[:1]
        self._start = SavedWorlds.take(self._engine, first, *times)
        # Nobody else has its bodies, so these need not keep it.
        self._scene.let_go()
        self._close(Worlds)

    @classmethod
    def load(cls, path: str | Path, *, device: str | Device = CPU, threads: int | None = None) -> Worlds:
        """The worlds that `save` has written to a file, which go on bit for bit as those would.

        They start, for `reset`, with the states of the file.

        Args:
            path: The file.
            device: As for `Worlds`.
            threads: Likewise.

        Raises:
            carom.errors.DescriptionError: The file cannot be used, or it has one world, which `World.load`
                loads.
        """
        from carom.worlds.face.file import load_worlds

        return load_worlds(cls, Path(path), device, threads)

    def __repr__(self) -> str:
        names = ", ".join(repr(batch.name) for batch in self)
        halted = np.count_nonzero(self.halted)
        return f"<Worlds: {self.count} on {self.device!r} with {names or 'no bodies'}, {halted} halted>"

    def __setattr__(self, name: str, value: Any) -> None:
        # Others have these arrays as well.
        if name in _IN_PLACE and "_closed" in self.__dict__:
            with self.call_lock:
                self.__dict__[name][:] = value
            return
        if name in _FOR_GOOD and "_closed" in self.__dict__:
            raise AttributeError(f"{name} of Worlds stays what it is: make others by Worlds(world, count)")
        super().__setattr__(name, value)

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        raise TypeError(
            "Worlds cannot be pickled or deep-copied: save(path) keeps all of them, extract(number) gives "
            "one, which can be, and Worlds(world, count) makes others"
        )

    @property
    def bodies(self) -> Named[BodyBatch]:
        """The bodies by name, or by their place in the order they were added."""
        return Named("body", list(self))

    def __iter__(self) -> Iterator[BodyBatch]:
        """The bodies, in the order they were added; `count` is the number of worlds."""
        return iter(self._bodies.values())

    def __contains__(self, key: object) -> bool:
        """Whether there is a body of this name or number, or this very one."""
        return self._bodies.has(key.id if isinstance(key, Body) else key)

    # Time

    @property
    def time_step(self) -> float:
        """Duration of a step [s], the same in all worlds.

        As in a `World`, drives keep the impulses that their maximum forces were converted to.
        """
        return self._scene.parameters.time_step

    @time_step.setter
    @gated("call_lock", section=True)
    def time_step(self, value: float) -> None:
        (seconds,) = positive([value], "time_step").tolist()
        self._scene.parameters.time_step = seconds
        self._engine.update_settings(self._scene.parameters)

    # Controls and sensors of all bodies

    @property
    @gated("call_lock")
    def controls(self) -> NamedVector:
        """Controls of all actuators, in the order of the bodies, (count, n): a copy with names and bounds.

        They can be set: (count, n), (n,) or one number for all.
        """
        return control_vector(self, self.count)

    @controls.setter
    @gated("call_lock", section=True)
    def controls(self, values: ArrayLike) -> None:
        set_controls(self, values, self.count)

    @property
    @gated("call_lock")
    def sensors(self) -> NamedVector:
        """What all sensors show now, in the order of the bodies, (count, n): a copy with names and slices."""
        return sensor_vector(self, self.count)

    # Parameters

    @property
    def contact(self) -> str:
        """The law of contacts, that of the world they were made from."""
        return self._scene.parameters.contact

    @property
    def integrator(self) -> str:
        """How velocities become positions, as in the world they were made from."""
        return self._scene.parameters.integrator

    @property
    def substeps(self) -> int:
        """Number of substeps of each step, as in the world they were made from."""
        return self._scene.substeps

    @property
    def solver(self) -> Solver:
        """How far contacts and constraints are solved, as in the world they were made from."""
        return self._scene.solver

    @property
    def gravity(self) -> Array:
        """Gravity of each world in world axes [m/s²], a copy (count, 3)."""
        return self._engine.parameter("model", "gravity_vector", 0)

    @gravity.setter
    @gated("call_lock", section=True)
    def gravity(self, value: ArrayLike) -> None:
        worlds = self._chosen(None)
        values = worlds.values(np.asarray(self._engine.take(value)), (3,), "gravity")
        self._engine.set_parameter("model", "gravity_vector", 0, values, worlds.rows)

    @property
    def parameters(self) -> EngineParameters:
        """Parameters of the engine as all worlds have them, a copy; `change_parameters` sets some.

        Of gravity and fluid it has those of the world that they were made from: they may differ.
        """
        return replace(self._scene.parameters)

    @gated("call_lock", section=True)
    def change_parameters(self, *, where: Where | None = None, **values: ArrayLike) -> None:
        """Set gravity and fluid of each world, or of some, by the names that a `World` has for them.

        Args:
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
            **values: `gravity` in world axes [m/s²], (n, 3) for the n worlds chosen, or (3,) for all;
                `fluid_density` [kg/m³] and `fluid_viscosity` [Pa s], (n,) or one number; `wind`, the velocity
                of the fluid in world axes [m/s], (n, 3) or (3,).

        Raises:
            ValueError: A shape does not fit, something is not finite, or a density or viscosity is negative;
                nothing has changed.
            TypeError: There is no such parameter, or it is the same in all worlds.
        """
        worlds = self._chosen(where)
        found: dict[str, np.ndarray] = {}
        for name, given in values.items():
            if name not in _VARYING:
                raise TypeError(
                    f"no parameter {name!r} can differ between worlds; those that can are "
                    f"{', '.join(_VARYING)}; others are set in the world, before Worlds(world, count)"
                )
            field, inner = _VARYING[name]
            found[field] = worlds.values(np.asarray(self._engine.take(given)), inner, name)
            if not inner and (found[field] < 0.0).any():
                raise ValueError(f"{name} must not be negative")
        for field, numbers in found.items():
            self._engine.set_parameter("model", field, 0, numbers, worlds.rows)

    def _chosen(self, where: Where | None) -> Chosen:
        return Chosen(self._engine.take(where), self.count)
