"""Quick calls: builtins of CPython whose C code is in the native library.

A builtin of `pybullet` stands for a Python function. For some of them the library has C code that handles the
usual case itself, in a fraction of the time, and calls the Python function in all others:
`native/source/quick_calls.cpp` describes how, and has the same structs. The library is not linked against
Python; this module gives it the addresses of the few functions that it needs, so that one library serves all
versions.
"""

from __future__ import annotations

import builtins
import ctypes
import sys
import sysconfig
from collections.abc import Sequence
from enum import IntEnum
from typing import Any

from carom.native.gates import BuiltinMaker, GateLock, lock_of
from carom.native.library import library
from carom.native.uninterrupted import begin, end, is_our_own
from carom.record import record

MOST_PARAMETERS = 26
MOST_GROUPS = 8


REPORT_SCALARS = ("count", "body_a", "link_a", "body_b", "link_b", "time_step")
"""Query of the kernel that lists contacts: the names of its arguments."""
REPORT_ARRAYS = (
    *("count", "body_a", "body_b", "link_a", "link_b", "point_a", "point_b", "normal", "distance"),
    *("force", "force1", "force2", "direction1", "direction2"),
)
"""Its results: fields of `ContactReport`, without the word for their axis."""


SURFACE = {
    "lateral_friction": "link_lateral_friction",
    "spinning_friction": "link_spinning_friction",
    "rolling_friction": "link_rolling_friction",
    "restitution": "link_restitution",
    "contact_stiffness": "link_stiffness",
    "contact_damping": "link_contact_damping",
}
"""Fields of `LinkDynamics` that quick calls change, with the corresponding fields of `Shapes`."""
DAMPING = ("tree_linear_damping", "tree_angular_damping")
"""Fields of `Model` that quick calls change."""


_Address, _Count = ctypes.c_void_p, ctypes.c_int64


def _fields(kind: Any, names: str) -> tuple[tuple[str, Any], ...]:
    """Fields of one type by their names, which are separated by spaces."""
    return tuple((name, kind) for name in names.split())


class KernelCall(ctypes.Structure):
    """A kernel and its arguments."""

    _fields_ = _fields(_Address, "function bounds arguments")


class Launch(KernelCall):
    """A kernel that is run for one tree."""

    _fields_ = _fields(_Address, "tree")


class ContactReport(KernelCall):
    """The kernel that lists contacts, its query and its results."""

    _fields_ = (
        *((f"asked_{name}", _Address) for name in REPORT_SCALARS),
        ("there", _Address),
        ("room", _Count),
        *((f"found_{name}", _Address) for name in REPORT_ARRAYS),
    )


class Detection(ctypes.Structure):
    """Collision detection at the current coordinates of all bodies."""

    _fields_ = (
        ("run", _Address),
        ("find_poses", KernelCall),
        *_fields(_Address, "poses poses_before"),
        ("pose_count", _Count),
        ("status", _Address),
    )


class Placement(ctypes.Structure):
    """The shapes of all links, and the kernels that place them at the current coordinates."""

    _fields_ = (
        *_fields(KernelCall, "place find_poses"),
        *_fields(_Address, "positions placed_at"),
        ("position_count", _Count),
        *_fields(_Address, "poses poses_before"),
        ("pose_count", _Count),
        *_fields(_Address, "readiness shapes changes_name"),
        ("changes", _Count),
        *_fields(_Address, "lower upper kind link"),
        ("shape_count", _Count),
        *_fields(_Address, "first_shape link_shapes place_body place_link"),
        ("has_bare_links", _Count),
    )


class PairSearch(ctypes.Structure):
    """The kernel that finds nearest points, its query and its results."""

    _fields_ = (
        ("search", KernelCall),
        *_fields(_Address, "count max_distance first second"),
        ("room", _Count),
        *_fields(_Address, "found pairs points"),
    )


class Step(ctypes.Structure):
    """A step of the world with one substep, as `carom.engine.interpreter` performs it."""

    _fields_ = _fields(_Address, "run status duration time observers contact_count")


class Scene(ctypes.Structure):
    """Data derived from the bodies and arrays of a world."""

    _fields_ = (
        *_fields(Launch, "find_poses find_twists"),
        *_fields(_Address, "contact_count contact_warm_starts"),
        ("contact_room", _Count),
        ("tree_resets", _Address),
        *_fields(_Address * len(SURFACE), "surface surface_names"),
        ("damping", _Address * len(DAMPING)),
        *_fields(_Address, "mass inertia mass_name inertia_name fixed_base_name"),
        ("report", ContactReport),
        ("detection", Detection),
        ("placement", Placement),
        ("nearest", PairSearch),
        ("step", Step),
    )


class Link(ctypes.Structure):
    """A link other than a base."""

    _fields_ = (*_fields(ctypes.c_double * 7, "inertial_frame from_inertial_frame"), ("is_turned", _Count))


class _MassTerm(ctypes.Structure):
    _fields_ = (("divisor", ctypes.c_double), ("factors", ctypes.c_double * 3))


class Moments(ctypes.Structure):
    """The moments of inertia that a link's shapes have at a mass, see `carom.model.inertia.MassTerm`."""

    _fields_ = (("terms", _MassTerm * 2 * 3), ("is_known", _Count))


class Box(ctypes.Structure):
    """The box around the shapes of a link, in its inertial frame."""

    _fields_ = (*_fields(ctypes.c_double * 3, "center half"), *_fields(_Count, "is_moved is_turned"))


class Joint(ctypes.Structure):
    """A joint: indices of its first coordinates in its body, and bounds of target positions."""

    _fields_ = (
        *_fields(ctypes.c_int32, "position velocity dof_count has_sensor"),
        *_fields(ctypes.c_double, "lower upper"),
    )


class MotorGroup(ctypes.Structure):
    """Joints that are commanded together, and the kernel for their commands."""

    _fields_ = (
        ("command", KernelCall),
        *_fields(_Address, "mode given time_step refused position velocity force kp kd indices"),
        ("count", _Count),
    )


class Body(ctypes.Structure):
    """Addresses of the state of a body.

    `links` and `boxes` are null until they are first needed, `moments` until a mass is first changed.
    """

    _fields_ = (
        *_fields(_Address, "position velocity pose twist wrench motor pd torque motor_impulse reaction"),
        *_fields(_Address, "links joints motors"),
        *_fields(_Count, "link_count tree first_link"),
        *_fields(_Address, "dynamics handle derived moments boxes"),
    )


class Client(ctypes.Structure):
    """A world, its bodies by number, and its lock."""

    _fields_ = (
        *_fields(_Address, "scene bodies"),
        ("body_count", _Count),
        *_fields(_Address, "gate connection time_step_name"),
        ("reports_analytics", _Count),
        *_fields(_Address, "world_bodies joint_count_name encoded_names_name"),
    )


class _Parameter(ctypes.Structure):
    _fields_ = (
        ("name", _Address),
        ("missing", ctypes.c_double),
        *_fields(ctypes.c_int32, "kind is_required"),
    )


class _QuickCall(ctypes.Structure):
    _fields_ = (
        *_fields(_Address, "kernel maker"),
        ("parameter_count", _Count),
        ("parameters", _Parameter * MOST_PARAMETERS),
        ("groups", ctypes.c_int32 * (MOST_GROUPS + 1)),
        ("is_flat", ctypes.c_int32),
    )


class _Guard(ctypes.Structure):
    _fields_ = _fields(ctypes.c_int32, "conduct client_place is_known")


class Conduct(IntEnum):
    """What a function does to a world; `native/source/gate.h` has the same numbers, and explains them."""

    FREE, READS, CHANGES = range(3)


@record
class Parameter:
    """A parameter of a quick call.

    Attributes:
        name: Its name, interned as CPython does with names of parameters.
        kind: A letter: `i` integer, `r` number, `3` and `4` so many numbers, `q` quaternion whose length is
            not zero, `s` list, tuple or range, `v` any number of numbers or None, `b` number of a body, `c`
            of a connection, `-` not used.
        missing: Default for each of its numbers; NaN for None. None if it is required.
    """

    name: str
    kind: str
    missing: float | None


class QuickCalls:
    """The quick calls of this process, in a table of the library, with pointers to what they need of Python.

    Attributes:
        clients: Address of a `Client`, by number; 0 if Python has to handle its calls.
        gates: Address of a `Gate`, by number of the connection; 0 if it is none of this process.
        is_paused: Its value is not 0 while Python has to handle all calls that name a connection.
    """

    def __init__(
        self, symbols: Any, calls: int, guards: int, clients: int, python: dict[str, ctypes.c_void_p]
    ) -> None:
        self.clients: Any = (ctypes.c_void_p * symbols.carom_most_clients()).from_address(clients)
        symbols.carom_gates.restype = ctypes.c_void_p
        self.gates: Any = (ctypes.c_void_p * len(self.clients)).from_address(symbols.carom_gates())
        self.is_paused: ctypes.c_int32 = ctypes.c_int32.in_dll(symbols, "carom_quick_calls_paused")
        self._symbols = symbols
        count = symbols.carom_most_quick_calls()
        self._calls = (_QuickCall * count).from_address(calls)
        self._guards = (_Guard * count).from_address(guards)
        symbols.carom_quick_entry.restype = ctypes.c_void_p
        symbols.carom_meet_host.argtypes = [ctypes.py_object] * 3
        symbols.carom_meet_host(begin, end, is_our_own)
        self._python = python
        # Memory that the library points to.
        self._kept: list[Any] = [begin, end, is_our_own]
        self._made = 0

    def guard(self, conduct: Conduct, client_place: int) -> int:
        """The address of the C code of a builtin whose Python function has the world for itself.

        `client_place` is that of the connection among its positional arguments; -1 if it is none of them.
        """
        guard = self._guards[self._made]
        guard.conduct, guard.client_place = conduct, client_place
        self._made += 1
        return self._symbols.carom_quick_entry(self._made - 1)

    def quicken(
        self, kernel: str, parameters: Sequence[Parameter], groups: Sequence[int] | None, *, flat: bool
    ) -> None:
        """Let the builtin that is guarded next try a kernel first.

        The kernel's name is without the prefix `carom_`; parameters are in the order of the Python function.
        `groups` are the lengths of the tuples in the result, 0 for a number in place of a tuple; empty if the
        result is None, and None if the kernel makes the result itself. If `flat`, its group is the result.
        """
        made = self._calls[self._made]
        function = ctypes.cast(self._symbols[f"carom_{kernel}"], ctypes.c_void_p)
        if groups is None:
            made.maker = function
        else:
            made.kernel = function
            made.groups[: len(groups) + 1] = [*groups, -1]
        made.parameter_count = len(parameters)
        for parameter, given in zip(made.parameters, parameters, strict=False):
            self._kept.append(given.name)
            parameter.name = id(given.name)
            parameter.kind = ord(given.kind)
            parameter.is_required = given.missing is None
            parameter.missing = given.missing or 0.0
        made.is_flat = flat

    def new_lock(self, new_builtin: BuiltinMaker) -> GateLock:
        """A lock of a world, which the library takes as well."""
        return lock_of(self._symbols, new_builtin)

    def meet_numpy(self) -> None:
        """Accept arrays as arguments, too, if NumPy has been imported."""
        numpy = sys.modules.get("numpy")
        for name in ("ndarray", "float64") if numpy else ():
            self._kept.append(getattr(numpy, name))
            self._python[name].value = id(self._kept[-1])


def quick_calls(vectorcall: int) -> QuickCalls | None:
    """The quick calls of this process, for the first caller; None for others, and if there are none.

    They need a usual build of CPython: in others the header of objects differs, or threads run in parallel.
    They point to objects of one interpreter, so other interpreters of the process have none. `vectorcall` is
    the address of the function that calls a Python function.
    """
    if (
        sys.implementation.name != "cpython"
        or hasattr(sys, "getobjects")
        or sysconfig.get_config_var("Py_GIL_DISABLED")
    ):
        return None
    symbols: ctypes.CDLL | None = library().symbols
    if symbols is None:
        # The library is in another process; see `tools.wheels.elsewhere`.
        return None
    python, calls, guards, clients = (ctypes.c_void_p() for _ in range(4))
    if not symbols.carom_claim_quick_calls(*map(ctypes.byref, (python, calls, guards, clients))):
        return None
    functions, objects = (
        ctypes.string_at(_address(symbols, f"carom_python_{kind}")).decode().split()
        for kind in ("functions", "objects")
    )
    size = ctypes.sizeof(ctypes.c_void_p)
    places = {
        name: ctypes.c_void_p.from_address((python.value or 0) + place * size)
        for place, name in enumerate((*functions, *objects))
    }
    for name in functions:
        places[name].value = vectorcall if name == "PyObject_Vectorcall" else _address(ctypes.pythonapi, name)
    for name in objects:
        if hasattr(builtins, name):
            places[name].value = id(getattr(builtins, name))
    return QuickCalls(symbols, calls.value or 0, guards.value or 0, clients.value or 0, places)


def _address(symbols: Any, name: str) -> int:
    return ctypes.addressof(ctypes.c_char.in_dll(symbols, name))
