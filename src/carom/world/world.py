"""A world: bodies, gravity and time, and the flat arrays that hold their state."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.checks import Array, positive, positive_count, vector
from carom.closed import Listed
from carom.engine.parameters import (
    COMPLIANT,
    DEFAULT_TIME_STEP,
    EngineParameters,
    check_contact,
    check_integrator,
    usual_integrator,
)
from carom.native.change import Change
from carom.native.gates import gated
from carom.native.uninterrupted import uninterrupted
from carom.scene.body import Body
from carom.scene.changes import free_base, remove_body
from carom.scene.named_constraints.named_constraint import NamedConstraint
from carom.scene.shapes import BodyShape
from carom.world.face.asking import Asking
from carom.world.face.constraining import Constraining
from carom.world.face.looking import Looking
from carom.world.face.solving import Solver, solver_from
from carom.world.face.state import FlatState
from carom.world.face.vectors import NamedVector, control_vector, sensor_vector, set_controls
from carom.world.loading import DescriptionLoading

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.scene.link import Link
    from carom.scene.snapshot import Snapshot
    from carom.world.contacts import Contact
    from carom.world.log import Log


# Parameters that `clear` leaves as they are.
_KEPT = frozenset(("time_step", "substeps", "contact", "integrator"))


class World(DescriptionLoading, Constraining, Asking, Looking, metaclass=Listed):
    """Bodies that move under gravity, motors and limits.

    `world["arm"]` is a body by its name, `world.bodies` are all of them.

    - Add files: `load`, and `load_urdf`, which returns one body.
    - Add shapes: `add_box`, `add_sphere`, `add_ellipsoid`, `add_cylinder`,
      `add_capsule`, `add_plane`, `add_heightfield`, `add_mesh`.
    - Add soft bodies: `load_cloth`, `load_rope`, `load_soft_solid`.
    - Tie together: `constrain`, `constraints`. Take away: `remove`, `clear`.
    - Go on: `step`, `time`. Go back: `reset`, `set_start`, `snapshot`,
      `restore`. Keep: `save`, `copy`, `record`, `log`.
    - Drive and sense: `controls`, `sensors`, all of them in one array each.
    - Ask: `contacts`, `force_between`, `ray`, `rays`, `nearest`,
      `overlapping`.
    - Look: `view` opens a window, `image` is what a camera sees.
    - Set: `gravity`, `time_step`, `substeps`, `contact`, `integrator`,
      `solver`; all else by `change_parameters`, which `parameters` tells.
    - Differentiate: `linearize`, `step_vjp`, `inverse_dynamics`.
    - Besides: `state`, flat arrays of all bodies; `lock`, for threads.

    Attributes:
        parameters: Parameters of the engine; `change_parameters` sets them.
        bodies: The bodies in the order they were added; one by its number or name, `world.bodies["arm"]`.
        lock: The lock that every call has from its arguments to its results; hold it to make several calls
            without those of other threads in between. A thread can take it again.

    Args:
        time_step: Duration of one step [s]; 1/240 s, or that of the first file, if left out.
        gravity: In world axes [m/s²], shape (3,); none if left out.
        contact: The law of contacts: "compliant", Coulomb's law solved until it converges, by which what
            stands stands for ever, with MuJoCo's law for contacts of its files; "rigid", Coulomb's law for
            those as well; or "bullet", sweeps as PyBullet makes them. docs/contact.md compares them.
        integrator: "discrete", where damping, springs and servos count implicitly in all equations;
            "midpoint", the same with free rotation that keeps its energy, which worlds with contact="rigid"
            have for "discrete"; or MuJoCo's "euler", "implicitfast", "implicit" or "rk4", or "explicit", its
            Euler with explicit damping. If left out, that which the first file names (MJCF files that name
            none mean "euler"), and else "midpoint", but "discrete" with contact="bullet". docs/solver.md has
            the equations.
        solver: How far contacts and constraints are solved: a `Solver`, or its number of iterations.
        substeps: Number of substeps of each step; one if left out.
        threads: Number of threads that share a step, of worlds of many bodies: islands, which are groups of
            bodies that touch or are tied together, are solved at once, with the same bits for any number. A
            heap is one island, so that little is gained there. Copies have as many; files do not state it.

    Raises:
        TypeError: It is a file, which `load` adds, or the number of threads is not a whole number.
        ValueError: The time step or the number of threads is not positive, a number is not finite, or there
            is no such law or integrator, or it does not suit the law.
    """

    # For the other packages of Carom:
    # links_loaded: Number of links loaded since the world was empty, those of removed bodies included.
    # listing: The bodies in the order in which PyBullet counts them: the last one takes the place of one that
    #     is removed.
    # quick: Addresses of its data for the fast paths in the native library.
    # `position_memory` and so on are the memory of the flat arrays as flat `memoryview`s of doubles.

    # A state, and the bodies that it is of.
    _start: tuple[Snapshot, tuple[int, ...]] | None = None
    # Whether the state before the first step is kept; the drop-in has no use for it.
    _keeps_start: bool = True

    def __init__(
        self,
        time_step: float | None = None,
        *,
        gravity: Sequence[float] | None = None,
        contact: str = COMPLIANT,
        integrator: str | None = None,
        solver: Solver | int | None = None,
        substeps: int | None = None,
        threads: int = 1,
    ) -> None:
        if isinstance(time_step, str | Path):
            raise TypeError("a world is made without a file: world = carom.World(); world.load(file)")
        (seconds,) = positive([DEFAULT_TIME_STEP if time_step is None else time_step], "time_step").tolist()
        check_contact(contact)
        check_integrator(usual_integrator(contact) if integrator is None else integrator, contact)
        super().__init__(seconds, contact, positive_count(threads, "threads"))
        solving = None if solver is None else solver_from(solver).parameters()
        if time_step is not None:
            self.parameters_set = frozenset(["time_step"])
        if integrator is not None:
            self.integrator = integrator
        if solving is not None:
            self.change_parameters(**solving)
        if gravity is not None:
            self.gravity = gravity
        if substeps is not None:
            self.substeps = substeps
        self.__doc__ = _OVERVIEW
        self._close(World)

    def __repr__(self) -> str:
        names = ", ".join(repr(body.name) for body in self.bodies.values())
        return f"<World at {self.time:.4f} s with {names or 'no bodies'}>"

    def __enter__(self) -> World:
        self.refuse_if_left()
        return self

    def __exit__(self, *_: object) -> None:
        with self.call_lock, uninterrupted:
            change = Change()
            self._start_empty(change)
            change.set(self, "was_left", True)
            self._part_with_bodies(change)

    def _part_with_bodies(self, change: Change) -> None:
        """Commit a change that removes all bodies, which then keep nothing of this world."""
        bodies = [*self.bodies.values()]
        change.commit()
        for body in bodies:
            body.forget_handles()

    # Bodies

    @gated("call_lock")
    def save(self, path: str | Path) -> None:
        """Write everything to a file: bodies, meshes, constraints, parameters, colours and textures, state.

        Args:
            path: The file, in Carom's own format, which `load` and `restore` read: end its name in .carom.

        Raises:
            ValueError: The name ends like a file of robots, such as .xml; the message says what writes these.
            OSError: The file cannot be written; an existing file is unchanged.
            carom.errors.StateError: It could not be loaded again, for example since a number is not finite;
                the message says which. An existing file is unchanged.
        """
        from carom.world_files.world_file import refuse_endings_of_others, save_world

        refuse_endings_of_others(Path(path))
        save_world(self, Path(path))

    @gated("call_lock")
    def remove(self, it: Body | NamedConstraint | int | str) -> None:
        """Remove a body, or a constraint, from the world.

        Args:
            it: The body, its number, or its name; or a constraint of `constraints`.

        Raises:
            KeyError: There is no such body.
            ValueError: The constraint is no longer in its world.
        """
        if isinstance(it, NamedConstraint):
            it.remove()
            return
        with uninterrupted:
            remove_body(self, self[it])

    def clear(self) -> None:
        """Remove all bodies; reset all parameters but time step, substeps, law of contacts and integrator."""
        self._clear(None)

    def _clear(self, also: Callable[[Change], None] | None) -> None:
        """`clear`, and what a function notes with the same change."""
        kept = self.parameters
        with self.call_lock, uninterrupted:
            change = Change()
            parameters = EngineParameters(**{name: getattr(kept, name) for name in _KEPT})
            change.set_all(self, parameters=parameters, parameters_set=self.parameters_set & _KEPT)
            self._start_empty(change)
            if also is not None:
                also(change)
            self._part_with_bodies(change)

    @gated("call_lock")
    def copy(self) -> World:
        """An independent world with the same bodies, which continues exactly as this one does.

        The new handles are in `bodies`, under the same numbers. Observers and logs are not copied.
        """
        from carom.world.copying import copy_world

        return copy_world(self)

    def __deepcopy__(self, memo: dict[int, Any]) -> World:
        """As `copy`; observers and logs are left out."""
        other = memo[id(self)] = self.copy()
        return other

    def __reduce__(self) -> tuple[Any, ...]:
        """A pickled world goes through its file."""
        from carom.world.pickling import packed_world, unpacked_world

        return unpacked_world, (type(self), packed_world(self))

    def set_base_freedom(self, body: Body, *, free: bool) -> None:
        """Free the base of a body, or fix it in the world."""
        free_base(self, body, free=free)

    # Controls and sensors of all bodies

    @property
    @gated("call_lock")
    def controls(self) -> NamedVector:
        """Controls of all actuators, in the order of the bodies: a copy, read-only, with names and bounds.

        They can be set, by one number for each or one for all.
        """
        return control_vector(self, None)

    @controls.setter
    @gated("call_lock")
    def controls(self, values: ArrayLike) -> None:
        set_controls(self, values, None)

    @property
    @gated("call_lock")
    def sensors(self) -> NamedVector:
        """What all sensors show now, in the order of the bodies: a copy, with names and slices."""
        return sensor_vector(self, None)

    # State

    @property
    def state(self) -> FlatState:
        """The state of all bodies as flat arrays, which can be written to."""
        return FlatState(self)

    def restore(
        self, state: Snapshot | str | Path, *, update_poses: bool = False, maximal: Collection[int] = ()
    ) -> None:
        """Restore a state. The steps that follow are then the same, bit for bit, as the first time.

        Args:
            state: The state, or a file of `save`, of which only the state is read, or a file of PyBullet's
                `saveBullet`: then bodies, in their order, get their poses, velocities and joint states, and
                contacts are found at the next step.
            update_poses: Compute `state.link_pose` from the coordinates; as saved, it is that of the start of
                the last substep.
            maximal: Of a file of PyBullet: numbers of the bodies that had maximal coordinates there.

        Raises:
            carom.errors.DescriptionError: The file cannot be used; the world is as it was.
            carom.errors.StateError: Bodies were added or removed, or one has other joints now; the
                world is as it was. A body that was removed and loaded again under its number is accepted, but
                contacts are then detected again.
        """
        from carom.scene.snapshot import Snapshot

        if isinstance(state, Snapshot):
            super().restore(state, update_poses=update_poses)
            return
        from carom.world_files.world_file import restore_world

        restore_world(self, Path(state), update_poses=update_poses, maximal=maximal)

    @gated("call_lock")
    def set_start(self) -> None:
        """Let the present state be the one that `reset` returns to, until bodies come or go."""
        self._start = self.snapshot(), tuple(self.bodies.keys())

    @gated("call_lock")
    def reset(self, keyframe: str | None = None) -> None:
        """Return to the start, or to a keyframe of the bodies that have one of this name, and to its time.

        The start is what `set_start` has kept, or else the state before the first step, or the first
        keyframe, since a body came or went. Bodies, parameters and constraints stay as they are; `clear`
        removes them.

        Raises:
            KeyError: No body has a keyframe of this name; the message says which there are.
        """
        if keyframe is not None:
            from carom.scene.keyframes.keyframe import keyframes_of

            keyframes = keyframes_of(list(self.bodies.values()))
            if keyframe not in keyframes:
                known = ", ".join(map(repr, keyframes)) or "none"
                raise KeyError(f"no body has a keyframe {keyframe!r}; there are {known}")
            # It need not be where worlds begin.
            self._keep_start()
            keyframes[keyframe].reset()
        elif self._start is not None and self._start[1] == tuple(self.bodies.keys()):
            self.restore(self._start[0], update_poses=True)
        # Otherwise it has not been stepped: it is there.

    def _prepared_step(self) -> Callable[[Any], bool]:
        """Keep the state before the first step; see `Stepping`."""
        if self._keeps_start:
            self._keep_start()
        return super()._prepared_step()

    def _keep_start(self) -> None:
        if self._start is None or self._start[1] != tuple(self.bodies.keys()):
            self._start = self.snapshot(), tuple(self.bodies.keys())

    def log(self, *names: str, every: int = 1) -> Log:
        """Record state arrays after each step, until the log is stopped.

        Args:
            *names: Names of arrays of `state`: `position`, `velocity`, `link_pose`, `motor_impulse`...
            every: Record every n-th step.

        Raises:
            ValueError: There is no such array, or `every` is less than 1.
        """
        from carom.world.log import Log, check_log

        check_log(names, every)
        return Log(self, names, every)

    # Contacts

    @gated("call_lock")
    def contacts(
        self,
        a: Body | Link | int | str | None = None,
        b: Body | Link | int | str | None = None,
        *,
        now: bool = False,
    ) -> list[Contact]:
        """The contacts of two bodies or links, or of one with anything, or all, as of the last step.

        Points that do not touch yet, but may in the next step, are among them: their distance is positive.

        Args:
            a: A body, its name or number, or a link; None for any. It is `a` of each record.
            b: What it touches, likewise.
            now: Find them for the present coordinates first, without a step; otherwise they are where the
                last step has found them.

        Raises:
            KeyError: There is no such body.
        """
        from carom.world.contacts import contacts_of

        if now:
            self.detect_collisions()
        parts = self._part(a), self._part(b)
        return contacts_of(self.queries(), self.bodies, *parts, self.parameters.substep_time)

    @gated("call_lock")
    def force_between(self, a: Body | Link | int | str, b: Body | Link | int | str | None = None) -> Array:
        """The force on `a` by all its contacts with `b`, or with anything, in the last step.

        Args:
            a: A body, its name or number, or a link.
            b: What it touches, likewise; None for anything.

        Returns:
            In world axes [N], friction included, shape (3,).
        """
        from carom.world.contacts import force_on

        return force_on(self.contacts(a, b))

    def _part(self, it: Body | Link | int | str | None) -> Body | Link | None:
        """A body or link of this world."""
        if it is None or isinstance(it, Body | int | str):
            return None if it is None else self[it]
        if isinstance(it, BodyShape):
            from carom.world.contacts import OF_SHAPES

            raise TypeError(OF_SHAPES)
        return self[it.body].links[it.index]

    # Parameters

    @property
    def time_step(self) -> float:
        """Duration of a step [s]; settable. Drives keep the impulses that their forces were converted to."""
        return self.parameters.time_step

    @time_step.setter
    def time_step(self, value: float) -> None:
        (seconds,) = positive([value], "time_step").tolist()
        self.change_parameters(time_step=seconds)

    @property
    def substeps(self) -> int:
        """Number of substeps of each step; settable.

        Raises:
            ValueError: It is less than 1.
        """
        return self.parameters.substep_count

    @substeps.setter
    def substeps(self, value: int) -> None:
        if value < 1:
            raise ValueError(f"substeps must be at least 1, not {value}")
        self.change_parameters(substeps=int(value))

    @property
    def contact(self) -> str:
        """The law of contacts: "bullet", "rigid" or "compliant". A change makes them forget impulses.

        Raises:
            ValueError: There is no such law, or the integrator does not suit it.
        """
        return self.parameters.contact

    @contact.setter
    def contact(self, contact: str) -> None:
        self.change_parameters(contact=check_contact(contact))

    @property
    def integrator(self) -> str:
        """The integrator, by the names of `World(integrator=)`; settable.

        Raises:
            ValueError: There is no such integrator, or it does not suit the law of contacts.
            NotImplementedError: Something in the world is not built for it; the message says what.
        """
        return self.parameters.integrator

    @integrator.setter
    def integrator(self, integrator: str) -> None:
        self.change_parameters(integrator=integrator)

    @property
    def solver(self) -> Solver:
        """How far contacts and constraints are solved; settable, by a `Solver` or a number of iterations.

        Raises:
            TypeError: What is set is neither.
            ValueError: A number is negative or not finite.
        """
        own = self.parameters
        name = Solver.named(own.contact)
        return Solver(own.solver_iterations, own.solver_residual_threshold, name)

    @solver.setter
    def solver(self, value: Solver | int) -> None:
        self.change_parameters(**solver_from(value).parameters())

    @property
    def gravity(self) -> Array:
        """Gravity in world axes [m/s²], shape (3,)."""
        return np.array(self.parameters.gravity)

    @gravity.setter
    def gravity(self, value: Sequence[float]) -> None:
        x, y, z = vector(value, 3, "gravity").tolist()
        self.change_parameters(gravity=(x, y, z))

    @gated("call_lock")
    def analytics(self) -> list[dict[str, float]]:
        """Statistics of the solver in the last substep, for each group of bodies solved together.

        Returns:
            Dictionaries with `islandId`, `numBodies` (links), `numIterationsUsed` and
            `remainingResidual` (largest squared change of a row's velocity in the last sweep).
        """
        from carom.world.solver_report import solver_report

        return solver_report(self)


# `help(world)` prints this; `help(World)` goes on with what each name does.
_OVERVIEW = (World.__doc__ or "").partition("    Attributes:")[0]
_OVERVIEW += "    help(carom.World) says more of each."
