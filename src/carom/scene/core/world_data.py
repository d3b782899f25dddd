"""The data of a world, and their changes: what is derived from them goes, or stays, with them."""

from __future__ import annotations

from collections.abc import Mapping
from ctypes import addressof, c_double, sizeof
from typing import TYPE_CHECKING, Any
from weakref import proxy

from carom.closed import Closed
from carom.engine.contact_arrays import ContactArrays
from carom.engine.engine import Engine
from carom.engine.integrators import refuse_unsuited
from carom.engine.parameters import (
    BULLET,
    DEFAULT_TIME_STEP,
    EngineParameters,
    check_contact,
    check_integrator,
    usual_integrator,
)
from carom.engine.quick_scene import QuickScene
from carom.errors import StateError
from carom.model.builder import WorldArrays
from carom.native.change import Change, packed_block
from carom.native.clock import Clock
from carom.native.gates import call_lock, gated, new_lock
from carom.native.launch import KernelStructs
from carom.native.tables import ArrayTable
from carom.native.uninterrupted import uninterrupted
from carom.scene.bodies import Bodies
from carom.scene.core.derived import Derived
from carom.scene.joint_constraints import JointConstraints
from carom.scene.observers import Observer, SubstepObserver
from carom.scene.state_views import StateViews
from carom.scene.user_constraints import UserConstraint, UserConstraints
from carom.scene.user_data import UserData

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

STRUCTURE = ("substeps", "minimum_island_size", "contact", "integrator", "noslip_iterations")
"""The parameters that determine which launches a step consists of."""
# Those that not every world can have together.
_OF_INTEGRATORS = frozenset(("integrator", "fluid_density", "fluid_viscosity"))


class WorldData(StateViews, Closed):
    """What a world consists of; `World` describes the attributes."""

    bodies: Bodies[BodyCore]
    listing: dict[int, BodyCore]
    arrays: WorldArrays
    contact_arrays: ContactArrays
    joint_constraints: JointConstraints
    user_constraints: UserConstraints
    user_data: UserData
    free_ids: list[int]
    next_id: int
    links_loaded: int
    engine: Engine
    island_threads: int
    _status: memoryview[int]
    _growths: int

    law_of_contacts: str
    """The law by which the present contacts remember impulses, see `kernels.newton.results`."""

    parameters_set: frozenset[str] = frozenset()
    """The names of the parameters that somebody has set; the options of a file leave them alone."""

    was_left = False
    """Whether the `with` block of the world has ended."""

    def __init__(self, time_step: float = DEFAULT_TIME_STEP, contact: str = BULLET, threads: int = 1) -> None:
        self.island_threads = threads
        self.lock: Any = new_lock()
        self.call_lock: Any = call_lock(self.lock)
        self.parameters: EngineParameters = EngineParameters(
            time_step=time_step, contact=contact, integrator=usual_integrator(contact)
        )
        self.law_of_contacts = contact
        self.bodies = Bodies()
        self.listing = {}
        self._clock = Clock()
        self.observers: list[Observer] = []
        self._substep_observers: list[SubstepObserver] = []
        self._is_in_step = False
        self._viewed: ArrayTable | None = None
        self._replacements = 0
        self._derived: Derived = Derived()
        self._made_for: list[int] | None = None
        self.quick: QuickScene = QuickScene()
        change = Change()
        self._start_empty(change)
        change.commit()

    def _start_empty(self, change: Change) -> None:
        """Remove everything with a change."""
        arrays = WorldArrays()
        change.set_all(
            self,
            joint_constraints=JointConstraints(),
            user_constraints=UserConstraints(),
            user_data=UserData(),
            free_ids=[],
            next_id=0,
            links_loaded=0,
        )
        self.note_time(change, unspent_time=0.0)
        change.refill(self.bodies, {})
        change.refill(self.listing, {})
        self.take_arrays(change, arrays, ContactArrays(arrays))

    def take_arrays(self, change: Change, arrays: WorldArrays, contact_arrays: ContactArrays) -> None:
        """Replace all arrays with a change, which has noted the constraints that go with them."""
        engine = Engine(arrays, contact_arrays, island_threads=self.island_threads)
        engine.keep_times(*self._clock.addresses, self._clock)
        change.set_all(
            self,
            arrays=arrays,
            contact_arrays=contact_arrays,
            engine=engine,
            _status=memoryview(engine.status[0]),
            _growths=0,
        )
        self.change_scene(change)

    def let_go(self) -> None:
        """Free everything as soon as nobody has this world any more, without a garbage collection.

        Bodies keep their world, so that those who have a body need not have that, too. From now on these do
        not, and so they are of no use without it.
        """
        for body in self.bodies.values():
            body.forget_handles()
            vars(body)["world"] = proxy(self)

    def note_time(self, change: Change, time: float | None = None, unspent_time: float | None = None) -> None:
        """Set the simulated time, and the part of it that no substep has covered yet, with a change [s]."""
        for value, address in zip((time, unspent_time), self._clock.addresses, strict=True):
            if value is not None:
                number = c_double(value)
                change.copy_blocks(packed_block(addressof(number), address, sizeof(number)), number)

    def refuse_in_step(self) -> None:
        """Raise `StateError` in the middle of a step, as when observers are told of its substeps."""
        if self._is_in_step:
            raise StateError(
                "the world is in the middle of a step: an observer of substeps can read it and set poses, "
                "joints, motors and forces; before_step and after_step can do everything else"
            )

    def refuse_if_left(self) -> None:
        """Raise `StateError` after the `with` block of the world, which has emptied it."""
        if self.was_left:
            raise StateError("this world was left at the end of its `with` block: make another one")

    def _kernel_structs(self) -> KernelStructs:
        """Structs of the present arrays, by the names of kernel arguments."""
        self.engine.update_settings(self.parameters)
        return self.engine.structs()

    @gated("call_lock")
    def change_parameters(self, **values: Any) -> None:
        """Set some of `parameters` and apply them, all at once."""
        with uninterrupted:
            change = Change()
            self.note_parameters(change, **values)
            change.commit()
            self.resume_step()

    def apply_parameters(self) -> None:
        """Apply changes of `parameters`."""
        self.change_parameters()

    def note_parameters(self, change: Change, **values: Any) -> None:
        """Set parameters with a change, and let the next step use them."""
        contact = values.get("contact", self.parameters.contact)
        follows = "integrator" not in values and "integrator" not in self.parameters_set
        if contact != self.parameters.contact and follows:
            change.set(self.parameters, "integrator", usual_integrator(contact))
        integrator = check_integrator(
            values.get("integrator", change.get(self.parameters, "integrator")), contact
        )
        if not _OF_INTEGRATORS.isdisjoint(values):
            density, viscosity = (
                values.get(name, getattr(self.parameters, name))
                for name in ("fluid_density", "fluid_viscosity")
            )
            refuse_unsuited(
                integrator,
                self.arrays,
                self.contact_arrays,
                touching=self.engine.can_collide,
                fluid=density > 0.0 or viscosity > 0.0,
            )
        if contact != self.law_of_contacts:
            check_contact(contact)
            self.contact_arrays.drop_contacts(change)
            change.set(self, "law_of_contacts", contact)
        if values:
            change.set_all(self.parameters, **values)
            if not self.parameters_set.issuperset(values):
                change.set(self, "parameters_set", self.parameters_set.union(values))
        if len(values) == 1 and "gravity" in values:
            self.refuse_in_step()
            self.engine.note_gravity(change, values["gravity"])
            return
        breaking, *structure = (
            change.get(self.parameters, name) for name in ("contact_breaking_threshold", *STRUCTURE)
        )
        shapes = self.contact_arrays.shapes
        if breaking != shapes.breaking_fraction or structure != self._made_for:
            shapes.set_breaking_fraction(change, breaking)
            self.change_scene(change)
        else:
            self.engine.note_parameters(change)
            self.pause_step(change)

    @gated("call_lock")
    def scene_changed(self) -> None:
        """Discard derived data: bodies, constraints or arrays have changed."""
        change = Change()
        self.change_scene(change)
        change.commit()

    @property
    def scene_version(self) -> object:
        """Another object after each change of bodies, constraints or arrays."""
        return self._derived

    def change_scene(self, change: Change) -> None:
        """Discard derived data with a change of bodies, constraints or arrays, which has noted all else."""
        self.refuse_in_step()
        self.quick.forget(change)
        change.set_all(self, _derived=Derived(), _made_for=None)
        change.get(self, "joint_constraints").rows.forget(change)
        change.get(self, "user_constraints").forget_written(change)
        change.get(self, "engine").note_change(change)
        state = change.get(change.get(self, "arrays"), "state")
        replacements = change.get(state, "replacements")
        if state is not self._viewed or replacements != self._replacements:
            self.view_state(change, state)
            change.set_all(self, _viewed=state, _replacements=replacements)

    @gated("call_lock")
    def constraints_changed(self) -> None:
        """Set the prepared step aside: constraints have changed, and nothing else."""
        change = Change()
        self.change_constraints(change)
        change.commit()

    def change_constraints(self, change: Change) -> None:
        """Set the prepared step aside with a change of constraints, and of nothing else."""
        self.pause_step(change)
        self.engine.note_constraints(change)

    def change_constraint(
        self, constraint: UserConstraint, values: Mapping[str, Any], change: Change | None = None
    ) -> None:
        """Change attributes of a constraint, by name: numbers, which change nothing else; all at once.

        If `change` is stated, it is what does it: one of `first_change`, which raises `Outdated`.
        """
        if change is None:
            change = Change()
        if self.user_constraints.note_values(change, constraint, values, self.contact_arrays):
            change.commit()
            return
        with uninterrupted:
            self.pause_step(change)
            change.commit()
            self.user_constraints.write(self.contact_arrays, self.arrays.state)
            self.resume_step()

    def pause_step(self, change: Change) -> None:
        """Set the prepared step aside with a change, after which it needs other numbers."""
        self.refuse_in_step()
        derived = self._derived
        if derived.step is not None:
            change.set_all(derived, step=None, step_before=derived.step)
        elif derived.removed is not None:
            change.set(derived, "removed", None)
        self.quick.pause_step(change)

    def resume_step(self) -> None:
        """Give a step that was set aside its numbers if that is all it needs; else the next step does."""
        derived = self._derived
        if derived.step is None and derived.step_before is not None and self.engine.is_planned:
            self.engine.update_settings(self.parameters)
            self.quick.resume_step()
            derived.step, derived.removed = derived.step_before, None

    def grow(self, table: ArrayTable, needed: Mapping[str, int]) -> None:
        """Make room for rows of a table of this world; nothing else of the world changes."""
        if table.lacks(needed):
            change = Change()
            table.grow(change, needed)
            self.change_scene(change)
            change.commit()
