"""`Worlds`: many copies of a scene, stepped together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import Array, positive
from carom.closed import Closed
from carom.native.cpu import core_count
from carom.native.gates import alone, in_section
from carom.queries.ray_hits import RayHits
from carom.render.world_looks import looks_of
from carom.scene.bodies import Bodies
from carom.scene.named import Named
from carom.world.face.looking import window
from carom.world.face.solving import Solver
from carom.world.face.vectors import NamedVector, control_vector, sensor_vector, set_controls
from carom.world.world import World
from carom.worlds.algorithms.linearizing import Linearizing
from carom.worlds.body import BodyBatch
from carom.worlds.checkpoint import parameters_of, set_parameters
from carom.worlds.chosen import Chosen, Mask, world_numbers
from carom.worlds.contact_queries import ContactQueries
from carom.worlds.devices import CPU, make_engine
from carom.worlds.glimpse import Glimpses
from carom.worlds.images import Images, ImageTaker, of_worlds
from carom.worlds.keyframes import resets_to
from carom.worlds.lone import copy_coordinates, lone_world
from carom.worlds.parts.constraints import ConstraintQueries
from carom.worlds.rays import RayCaster
from carom.worlds.saved import SavedWorlds
from carom.worlds.sensors import BatchSource
from carom.worlds.stepping import WorldsObserver, WorldsStepping
from carom.worlds.writing import assign

if TYPE_CHECKING:
    from carom.camera import Camera
    from carom.gpu.device import Device
    from carom.pose import Pose
    from carom.render.lights import Light
    from carom.viewer.viewer import Viewer


class Worlds(WorldsStepping, ContactQueries, ConstraintQueries, Linearizing, Closed):
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
        ValueError: A number is less than 1, or there is no such device.
        ImportError: For a GPU Warp has to be installed.
        NotImplementedError: On a GPU contacts cannot be rigid yet.
        MemoryError: There is not enough memory for so many worlds.
    """

    def __init__(
        self, world: World, count: int, *, device: str | Device = CPU, threads: int | None = None
    ) -> None:
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

    def __repr__(self) -> str:
        names = ", ".join(repr(batch.name) for batch in self)
        halted = np.count_nonzero(self.halted)
        return f"<Worlds: {self.count} on {self.device!r} with {names or 'no bodies'}, {halted} halted>"

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        raise TypeError(
            "Worlds cannot be pickled or deep-copied: save() keeps its states, extract(number) gives one of "
            "its worlds, which can be, and Worlds(world, count) makes others"
        )

    def __len__(self) -> int:
        return self.count

    @property
    def bodies(self) -> Named[BodyBatch]:
        """The bodies by name, or by their place in the order they were added."""
        return Named("body", list(self))

    def __iter__(self) -> Iterator[BodyBatch]:
        """The bodies, in the order they were added."""
        return iter(self._bodies.values())

    # Time

    @property
    def time_step(self) -> float:
        """Duration of a step [s], the same in all worlds.

        As in a `World`, drives keep the impulses that their maximum forces were converted to.
        """
        return self._scene.parameters.time_step

    @time_step.setter
    @in_section("call_lock")
    def time_step(self, value: float) -> None:
        (seconds,) = positive([value], "time_step").tolist()
        self._scene.parameters.time_step = seconds
        self._engine.update_settings(self._scene.parameters)

    # States

    @alone("call_lock")
    def snapshot(self, where: ArrayLike | None = None) -> SavedWorlds:
        """The present states, for `restore`.

        Args:
            where: Which worlds: a mask (count,) or their indices; None for all.
        """
        worlds = world_numbers(self._engine.take(where), self.count)
        return SavedWorlds.take(self._engine, worlds, self.time[worlds], self._unspent_times[worlds])

    @in_section("call_lock")
    def restore(self, start: SavedWorlds, where: ArrayLike | None = None) -> None:
        """Restore worlds to states of `snapshot`; the steps that follow are then the same, bit for bit.

        Args:
            start: States of all worlds, of which each chosen world gets its own; or one state for all chosen
                worlds; or one state for each chosen world.
            where: Which worlds: a mask (count,) or their indices; None for all.

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

    @alone("call_lock")
    def checkpoint(self) -> dict[str, Any]:
        """States and parameters of all worlds, for `resume`, also in another process.

        Returns:
            Arrays, numbers and texts, in dictionaries and lists.
        """
        saved = self.snapshot()
        return {
            "bodies": [batch.name for batch in self],
            "state": saved.state,
            "contacts": saved.contacts,
            "times": saved.times,
            "unspent_times": saved.unspent_times,
            "halted": self.halted.copy(),
            "sensor_seeds": self.sensor_seeds.copy(),
            "time_step": self.time_step,
            "parameters": parameters_of(self._engine),
        }

    @in_section("call_lock")
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
        if saved["bodies"] != [batch.name for batch in self]:
            raise ValueError(f"this is a checkpoint of worlds with other bodies: {saved['bodies']}")
        set_parameters(self._engine, saved["parameters"])
        state, contacts = dict(saved["state"]), dict(saved["contacts"])
        self.restore(SavedWorlds(np.arange(self.count), times, saved["unspent_times"], state, contacts))
        self.halted[:], self.sensor_seeds[:] = saved["halted"], saved["sensor_seeds"]
        self.time_step = saved["time_step"]

    @alone("call_lock")
    def set_start(self) -> None:
        """Let the present states be those that `reset` returns to; at first they are those when all began."""
        self._start = self.snapshot()

    @in_section("call_lock")
    def reset(self, keyframe: str | None = None, where: ArrayLike | None = None) -> None:
        """Return to the start, or to a keyframe of the bodies that have one of this name, and to its time.

        Args:
            keyframe: Name of the keyframe; None for the start.
            where: Which worlds: a mask (count,) or their indices; None for all.

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

    @alone("call_lock")
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

    @in_section("call_lock")
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

    # Controls and sensors of all bodies

    @property
    @alone("call_lock")
    def controls(self) -> NamedVector:
        """Controls of all actuators, in the order of the bodies, (count, n): a copy with names and bounds.

        They can be set: (count, n), (n,) or one number for all.
        """
        return control_vector(self, self.count)

    @controls.setter
    @in_section("call_lock")
    def controls(self, values: ArrayLike) -> None:
        set_controls(self, values, self.count)

    @property
    @alone("call_lock")
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
    def sensor_seeds(self) -> NDArray[np.int64]:
        """Seed of the noise of sensors in each world, a view (count,).

        At first `World.parameters.sensor_seed` and the numbers after it: a lone world with the seed of one of
        these has the same noise.
        """
        return self._sensors.own_seeds

    @property
    def gravity(self) -> Array:
        """Gravity of each world in world axes [m/s²], a copy (count, 3)."""
        return self._engine.parameter("model", "gravity_vector", 0)

    @gravity.setter
    @alone("call_lock")
    def gravity(self, value: ArrayLike) -> None:
        self.set_gravity(value)

    @in_section("call_lock")
    def set_gravity(self, gravity: ArrayLike, where: ArrayLike | None = None) -> None:
        """Set the gravity of each world, or of some.

        Args:
            gravity: In world axes [m/s²], (n, 3) for the n worlds chosen, or (3,) for all.
            where: Which worlds: a mask (count,) or their indices; None for all.

        Raises:
            ValueError: The shape does not fit, or something is not finite.
        """
        worlds = self._chosen(where)
        values = worlds.values(np.asarray(self._engine.take(gravity)), (3,), "gravity")
        self._engine.set_parameter("model", "gravity_vector", 0, values, worlds.rows)

    @in_section("call_lock")
    def set_fluid(
        self,
        density: ArrayLike | None = None,
        viscosity: ArrayLike | None = None,
        wind: ArrayLike | None = None,
        where: ArrayLike | None = None,
    ) -> None:
        """Set the fluid in each world, or in some; see `EngineParameters`.

        Args:
            density: [kg/m³], (n,) for the n worlds chosen, or one for all; None to leave it as it is.
            viscosity: [Pa s], likewise.
            wind: Velocity of the fluid in world axes [m/s], (n, 3) or (3,), likewise.
            where: Which worlds: a mask (count,) or their indices; None for all.

        Raises:
            ValueError: A shape does not fit, something is not finite, or a density or viscosity is negative.
        """
        worlds = self._chosen(where)
        found: dict[str, np.ndarray] = {}
        for name, given in (("density", density), ("viscosity", viscosity)):
            if given is not None:
                found[name] = worlds.values(np.asarray(self._engine.take(given)), (), name)
                if (found[name] < 0.0).any():
                    raise ValueError(f"{name} must not be negative")
        if wind is not None:
            found["wind"] = worlds.values(np.asarray(self._engine.take(wind)), (3,), "wind")
        for name, values in found.items():
            self._engine.set_parameter("model", f"fluid_{name}", 0, values, worlds.rows)

    def _chosen(self, where: ArrayLike | None) -> Chosen:
        return Chosen(self._engine.take(where), self.count)

    # Queries

    @alone("call_lock")
    def rays(self, starts: ArrayLike, ends: ArrayLike, *, mask: int = -1) -> RayHits:
        """Results of rays in each world.

        Args:
            starts: Start points in world axes [m], shape (n, 3) for the same rays in all worlds, or (count,
                n, 3).
            ends: End points, likewise.
            mask: Mask of the collision groups that the rays can hit.
        """
        return self._ray_caster(starts, ends, mask)

    @cached_property
    def _ray_caster(self) -> RayCaster:
        return RayCaster(self._engine, self._scene.link_places)

    @alone("call_lock")
    def images(
        self,
        camera: Camera,
        where: ArrayLike | None = None,
        *,
        poses: ArrayLike | Pose | None = None,
        fields_of_view: ArrayLike | None = None,
        lights: Sequence[Light] | None = None,
    ) -> Images:
        """Camera images of each world, drawn on all threads; with soft bodies or skins one after the other.

        Args:
            camera: A `Camera`, mounted on a link of the original world or fixed in the world.
            where: Which worlds: a mask (count,) or their indices; None for all.
            poses: Where the camera is placed in each of the n worlds chosen, in the frame in which it is
                placed otherwise: a `Pose` of n, n of them, or (n, 7). As `camera` says if left out.
            fields_of_view: Vertical fields of view [degrees], (n,).
            lights: The light of each, n of them.

        Raises:
            ValueError: There are not n, a number is out of range, or lamps and parallel lights are mixed.
        """
        numbers = world_numbers(self._engine.take(where), self.count)
        own = of_worlds(camera, len(numbers), poses, fields_of_view, lights)
        return self._take_images(camera, numbers, own)

    def view(
        self,
        *,
        speed: float | None = None,
        title: str = "Carom",
        port: int | None = None,
        host: str = "127.0.0.1",
        **choice: Any,
    ) -> Viewer:
        """Open a window on some of the worlds: a page in the browser, as `World.view`.

        Args:
            speed: Simulated time / real time, which steps wait for; None for as fast as they go.
            title: Title of the page.
            port: Port to listen on; None for any.
            host: Address to listen on; by default only for this machine.
            **choice: `shown`, how many worlds or which ones; `chosen`, the one that is looked at first;
                `arrangement`, "grid" or "overlay"; `spacing` of the grid [m].

        Returns:
            The window, of which `shown` says and sets which worlds are shown.

        Raises:
            OSError: It cannot listen on the address.
            ValueError: There are no such worlds.
            NotImplementedError: They have soft bodies.
        """
        return window(self, speed, title=title, port=port, host=host, **choice)

    @cached_property
    def glimpses(self) -> Glimpses:
        """What a viewer sees of some of the worlds."""
        return Glimpses(self._engine)

    @cached_property
    def _take_images(self) -> ImageTaker:
        return ImageTaker(self._scene, self._engine, self._thread_count)
