"""Addresses for quick calls of a world: of kernels that update its poses, and of its contacts."""

from __future__ import annotations

from ctypes import addressof, c_char, c_int32, c_int64, c_void_p, cast
from functools import cache
from sys import intern
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.layouts.dynamics_parameters import OF_BODY, SURFACE
from carom.layouts.quick.world import ContactColumns, ContactQuery, Scene, TreeCall
from carom.native.change import Change, blank, packed_run
from carom.native.kernel_builtins import step_taker
from carom.native.kernels import forward_kinematics_kernel
from carom.native.launch import KernelStructs, TreeLaunch
from carom.native.library import library

if TYPE_CHECKING:
    from collections.abc import Callable

    from carom.engine.contact_arrays import ContactArrays
    from carom.engine.interpreter import Interpreter
    from carom.engine.queries.question import Question
    from carom.model.builder import WorldArrays
    from carom.native.launch import Launch as KernelLaunch


# Names of attributes are interned.
_NAMES = [intern(name) for name in SURFACE]
_MASS, _INERTIA, _FIXED_BASE = intern("mass"), intern("inertia"), intern("fixed_base")
# Fields of the record without which the other addresses are not used.
_RUN = "step.run"
_OF_STEP = _RUN, "detection.run"
_CHANGES = "placement.changes"
_ALL = (
    "find_poses.call.function",
    "find_twists.call.function",
    *_OF_STEP,
    "report.call.function",
    "placement.place.function",
    _CHANGES,
    "nearest.search.function",
)
_MINUS_ONE = c_int64(-1)
# Where a function that is none of a tree finds the number of one.
_NO_TREE = c_int32(0)


class QuickScene:
    """Addresses that are valid until bodies, constraints or arrays of the world change.

    Attributes:
        place: The address of `record`, a float, as C code reads it without an error.
        record: The addresses; unknown functions are null.
        take_step: Performs a step, whose addresses are known, and lets the time go on; returns whether
            it has. If not, nothing has happened, and Python has to perform it. The caller has the lock of
            the world.
    """

    __slots__ = (
        "_cold_start",
        "_detection",
        "_is_empty",
        "_kept",
        "_known_blanks",
        "_posed",
        "_posing",
        "_resumption",
        "_run",
        "_step",
        "_stepped",
        "place",
        "record",
        "take_step",
    )

    def __init__(self) -> None:
        self.record = Scene()
        self.place = float(self.address)
        self._cold_start = b""
        # The objects that the addresses point to.
        self._kept: list[Any] = []
        self._stepped: tuple[Any, ...] = ()
        # The function that performs steps, also while it must not be called because constraints have changed.
        self._run: int | None = None
        self._step, self._detection = self.record.step, self.record.detection
        self.take_step: Callable[[], bool] = step_taker(self._step)
        # The last launch that updates link poses, and the structs that it and other addresses are made for.
        self._posing: TreeLaunch | None = None
        self._posed: tuple[Any, ...] = ()
        self._known_blanks: dict[tuple[str, ...], bytes] = {}
        # An address of a step, the memory that it is in, and the block that lets steps be performed by it.
        self._resumption: tuple[int | None, Any, bytes] = None, None, b""
        # Nothing was set since everything was forgotten.
        self._is_empty = True

    @property
    def cold_start(self) -> bytes:
        """The packed record of a function for changes: contacts are not warm started in the next step.

        It is for bodies that are moved. The addresses for poses have to be known.
        """
        if not self._cold_start:
            self._cold_start = packed_run(_start_cold(), self.address, 0, addressof(_NO_TREE), 0)
        return self._cold_start

    def forget(self, change: Change) -> None:
        """Forget all addresses with a change, after which the world is another."""
        if self._is_empty:
            return
        change.copy_blocks(self._blanks(_ALL), self.record)
        change.set_all(self, _run=None, _stepped=(), _kept=[], _is_empty=True)

    def pause_step(self, change: Change) -> None:
        """Forget the addresses that detect collisions, and perform no steps until they are known again."""
        if self._is_empty:
            return
        change.copy_blocks(self._blanks(_OF_STEP), self.record)

    def _blanks(self, fields: tuple[str, ...]) -> bytes:
        """Blocks of memory that blank some fields of the record."""
        known = self._known_blanks.get(fields)
        if known is None:
            known = b"".join(
                blank(self.record, field, _MINUS_ONE) if field == _CHANGES else blank(self.record, field)
                for field in fields
            )
            self._known_blanks[fields] = known
        return known

    @property
    def was_broken_off(self) -> bool:
        """Whether `take_step` has broken the step off for handlers of signals, which come before the next."""
        return bool(self._step.was_broken_off)

    def forget_step(self) -> None:
        """Let Python perform steps until their addresses are set again."""
        self._step.run = self._run = None

    def resume_step(self) -> None:
        """Perform steps again as before `pause_step`."""
        self._step.run = self._run

    def note_resumed_step(self, change: Change) -> None:
        """The same with a change."""
        run, _, block = self._resumption
        if run != self._run or not block:
            run = self._run
            value = c_int64(run or 0)
            block = blank(self.record, _RUN, value)
            self._resumption = run, value, block
        change.copy_blocks(block, self._resumption)

    def forget_queries(self) -> None:
        """Forget the addresses for queries of contacts and shapes, which will be replaced."""
        self.record.report.call.function = None
        self.record.placement.place.function = None
        self.record.placement.changes = -1
        self.record.nearest.search.function = None

    def set_pose_addresses(self, arrays: WorldArrays, contact_arrays: ContactArrays) -> TreeLaunch:
        """Set the addresses that update the link poses of a body, and those of contacts and surfaces.

        Returns:
            A launch that updates the link poses of a body.
        """
        contacts, shapes = contact_arrays.contacts.struct(), contact_arrays.shapes.table.struct()
        structs = arrays.model.struct(), arrays.state.struct(), contacts, shapes
        launch = self._posing
        # Structs are the same objects until arrays are replaced; most changes of a scene leave them there.
        if launch is None or structs != self._posed:
            self._posing = None
            launch = self._address_poses(*structs, contact_arrays)
            self._posed, self._posing = structs, launch
        self._is_empty = False
        _know(self.record.find_poses, launch)
        return launch

    def _address_poses(
        self, model: Any, state: Any, contacts: Any, shapes: Any, contact_arrays: ContactArrays
    ) -> TreeLaunch:
        """Set the addresses that depend on these structs only, and return their launch."""
        self.record.position, self.record.velocity = state.position.data, state.dof_velocity.data
        self.record.surface[:] = [getattr(shapes, field).data for field in SURFACE.values()]
        self.record.node_friction = shapes.link_node_friction.data
        self.record.surface_first = shapes.link_first_shape.data
        self.record.surface_shapes = shapes.link_shape_count.data
        self.record.surface_names[:] = [id(name) for name in _NAMES]
        self.record.of_body[:] = [getattr(model, field).data for field in OF_BODY.values()]
        self.record.mass, self.record.inertia = model.link_mass.data, model.link_inertia.data
        self.record.mass_name, self.record.inertia_name = id(_MASS), id(_INERTIA)
        self.record.fixed_base_name = id(_FIXED_BASE)
        self.record.contact_count = contacts.count_contacts.data
        self.record.contact_warm_starts = contacts.contact_warm_start.data
        self.record.contact_room = contact_arrays.contacts.capacity["contact"]
        self.record.tree_resets = state.tree_reset.data
        return TreeLaunch(forward_kinematics_kernel, KernelStructs(model=model, state=state))

    def set_step_addresses(
        self,
        step: tuple[int, int],
        observers: list[Any],
        contacts: int | None,
        keep: Any,
        *,
        substeps: int,
        long: bool,
    ) -> None:
        """Set the addresses for steps.

        Args:
            step: Those of the arguments and of the status of a step.
            observers: While there are any, Python performs steps.
            contacts: Address of the number of contacts; None if steps take long even without any.
            keep: What these addresses point to.
            substeps: Number of substeps in a step.
            long: Whether steps may take so long that handlers of signals should not wait for their end.
        """
        self._stepped = keep, observers
        self._is_empty = False
        record = self._step
        run, record.status = step
        record.observers, record.contact_count, record.substeps = id(observers), contacts, substeps
        record.is_long = long
        # Last: without it the other addresses are not used.
        record.run = self._run = run

    def set_twist_addresses(self, launch: TreeLaunch) -> None:
        """Set the addresses that update the link velocities of a body."""
        self.keep(launch)
        _know(self.record.find_twists, launch)

    def set_detection_addresses(
        self, detector: Interpreter, find_poses: KernelLaunch, poses: memoryview[int], status: np.ndarray
    ) -> None:
        """Set the addresses that detect collisions.

        Args:
            detector: Its program detects collisions in a world.
            find_poses: The kernel that computes the link poses for the current coordinates.
            poses: The memory of the link poses.
            status: The status of the world.
        """
        poses_before = np.empty(poses.nbytes // 8)
        self.keep(detector, find_poses, poses, poses_before, status)
        record = self._detection
        called = record.find_poses
        called.function, called.bounds, called.arguments = find_poses.addresses()
        record.poses, record.poses_before = addressof(c_char.from_buffer(poses)), poses_before.ctypes.data
        record.pose_count, record.status = len(poses_before), status.ctypes.data
        # Last: without it the other addresses are not used.
        record.run = detector.address

    def keep(self, *what: Any) -> None:
        """Keep the memory that addresses in the record point to, until they are forgotten."""
        self._is_empty = False
        self._kept += what

    def set_contact_addresses(self, question: Question, there: int, keep: Any) -> None:
        """Set the addresses that list contacts.

        Args:
            question: The query, whose arrays are a `layouts.queries.ContactReport`.
            there: Address of the number of contacts.
            keep: The object that this address points to.
        """
        report = question.arrays.struct()
        launch = question.launch
        self.keep(launch, report, keep)
        record = self.record.report
        function, record.call.bounds, record.call.arguments, *asked = launch.addresses(*ContactQuery.fields)
        for name, address in zip(ContactQuery.fields, asked, strict=True):
            setattr(record.asked, name, address)
        for name in ContactColumns.fields:
            setattr(record.found, name, getattr(report, f"report_{name}").data)
        record.there, record.room = there, question.room
        # Last: without it the other addresses are not used.
        record.call.function = function

    @property
    def address(self) -> int:
        """Address of the record, which lives as long as this object."""
        return addressof(self.record)


def _know(record: TreeCall, launch: TreeLaunch) -> None:
    # The function last: without it the other addresses are not used.
    function, record.call.bounds, record.call.arguments, record.tree = launch.addresses()
    record.call.function = function


@cache
def _start_cold() -> int | None:
    return cast(library().symbols.carom_start_cold, c_void_p).value
