"""Performs programs of launches on the CPU, world after world, without Python in between.

A launch on the CPU is a C function, called with the addresses of its bounds and of its arguments. What
calls these functions in turn is a kernel as well, whose one function is written in C: nothing else can call
an address. A thread takes chunks of worlds from a list that all threads share, so that uneven ones even out,
and takes each world through all of its steps while it is in the processor's caches.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
import warp as wp

from carom.engine.program import Program
from carom.model.launch import Launch, argument_indices
from carom.model.real import kernel
from carom.model.status import STEPS_DONE

# Numbers of a program before its launches: address of the first world's status, bytes from one status to
# the next, and the ends of the five parts.
_HEADER = 7
# Numbers of a launch: addresses of the function, the bounds, the arguments, and among these of the world and
# of the number of substeps, 0 if it has none.
_PER_LAUNCH = 5
if TYPE_CHECKING:
    Numbers = Any
    Indices = Any
else:
    Numbers = wp.array(dtype=wp.int64)
    Indices = wp.array(dtype=wp.int32)

# More than any program has.
_MOST_LAUNCHES = 32

_PERFORM = f"""
    typedef void (*Function)(void*, void*);
    const long long* launches = program.data + {_HEADER};
    auto perform = [&](long long from, long long to, int world, int substeps, const int* status) {{
        for (long long i = from; i < to; ++i) {{
            const long long* launch = launches + {_PER_LAUNCH} * i;
            *(int*)launch[3] = world;
            if (launch[4])
                *(int*)launch[4] = substeps;
            ((Function)launch[0])((void*)launch[1], (void*)launch[2]);
            if (status && *status)
                return false;
        }}
        return true;
    }};
    const long long begin_end = program.data[2], detection_end = program.data[3];
    const long long motion_end = program.data[4], end_end = program.data[5], abandon_end = program.data[6];
    int next = 0;
    for (;;) {{
        int from = next;
        if (shared != 0)
            from = __atomic_fetch_add(counter.data, chunk, __ATOMIC_RELAXED);
        next = from + chunk;
        if (from >= world_count)
            return;
        for (int i = from; i < next && i < world_count; ++i) {{
            const int world = worlds.data[i];
            int* status = (int*)(program.data[0] + world * program.data[1]);
            if (resumed == 0)
                status[{STEPS_DONE}] = 0;
            for (int step = status[{STEPS_DONE}]; step < step_count; ++step) {{
                const int substeps = due.data[step], rounds = substeps > 0 ? substeps : 1;
                const long long round_end = substeps > 0 ? motion_end : detection_end;
                bool well = first_substep > 0 || perform(0, begin_end, world, substeps, status);
                for (int k = first_substep; well && k < end_substep && k < rounds; ++k)
                    well = perform(begin_end, round_end, world, substeps, status);
                if (well && end_substep >= rounds)
                    well = perform(motion_end, end_end, world, substeps, status);
                if (!well) {{
                    perform(end_end, abandon_end, world, substeps, nullptr);
                    break;
                }}
                status[{STEPS_DONE}] = step + 1;
            }}
        }}
    }}
"""


@wp.func_native(_PERFORM)
def _perform(
    program: Numbers,
    worlds: Indices,
    due: Indices,
    counter: Indices,
    world_count: wp.int32,
    step_count: wp.int32,
    chunk: wp.int32,
    shared: wp.int32,
    resumed: wp.int32,
    first_substep: wp.int32,
    end_substep: wp.int32,
) -> None: ...


@kernel
def perform_kernel(
    program: Numbers,
    worlds: Indices,
    due: Indices,
    counter: Indices,
    world_count: wp.int32,
    step_count: wp.int32,
    chunk: wp.int32,
    shared: wp.int32,
    resumed: wp.int32,
    first_substep: wp.int32,
    end_substep: wp.int32,
) -> None:
    """Take worlds through steps.

    Args:
        program: The launches, as `Interpreter` writes them.
        worlds: Which worlds.
        due: Substeps of each step; where it is 0, contacts are found and nothing moves.
        counter: Place in `worlds` of the next chunk, if threads share them.
        world_count: How many worlds.
        step_count: How many steps.
        chunk: Worlds in a chunk.
        shared: 1 if threads share the worlds.
        resumed: 1 to go on after the steps that each world has done already.
        first_substep: The first substep to perform; if it is not 0, a step has begun already.
        end_substep: The substep after the last one; a step ends with its last.
    """
    _perform(
        program,
        worlds,
        due,
        counter,
        world_count,
        step_count,
        chunk,
        shared,
        resumed,
        first_substep,
        end_substep,
    )


ALL_SUBSTEPS = 2**31 - 1


class Stepper(Protocol):
    """What performs programs.

    Attributes:
        run: Performs what has been asked for.
        program: What was loaded last.
    """

    run: Callable[[], None]
    program: Program

    def load(self, program: Program) -> None:
        """Perform another program from now on."""
        ...

    def ask(self, **asked: int) -> None:
        """Set scalars of `perform_kernel` for all later runs."""
        ...


class Interpreter(Stepper):
    """Performs a program on worlds, in one thread.

    Args:
        status: `State.status_entry`.
        worlds: Numbers of the worlds; changed in place.
        due: Substeps of the steps; changed in place.
        counter: One number that all threads share; None for a thread alone.
    """

    def __init__(
        self, status: np.ndarray, worlds: np.ndarray, due: np.ndarray, counter: np.ndarray | None
    ) -> None:
        self._status = status
        self._numbers = np.zeros(_HEADER + _PER_LAUNCH * _MOST_LAUNCHES, dtype=np.int64)
        self.program = Program([], [], [], [], [])
        shared = counter is not None
        arrays = [
            wp.array(numbers, dtype=kind, device="cpu", copy=False)
            for numbers, kind in (
                (self._numbers, wp.int64),
                (worlds, wp.int32),
                (due, wp.int32),
                (np.zeros(1, dtype=np.int32) if counter is None else counter, wp.int32),
            )
        ]
        self._asked: dict[str, int] = {
            "world_count": len(worlds),
            "step_count": 1,
            "chunk": len(worlds),
            "shared": int(shared),
            "resumed": 0,
            "first_substep": 0,
            "end_substep": ALL_SUBSTEPS,
        }
        self._launch = Launch(perform_kernel, 1, [*arrays, *self._asked.values()])
        # What it does is changed in place, so that it never changes itself.
        self.run: Callable[[], None] = self._launch.function

    def load(self, program: Program) -> None:  # noqa: D102
        ends = np.cumsum([len(part) for part in program])
        numbers: list[int] = [self._status.ctypes.data, self._status.strides[0], *ends.tolist()]
        for part in program:
            for launch in part:
                numbers.extend(launch.addresses("first_world", "substeps"))
        self._numbers[: len(numbers)] = numbers
        self.program = program

    def ask(self, **asked: int) -> None:  # noqa: D102
        for name, value in asked.items():
            if self._asked[name] != value:
                self._launch.replace(argument_indices(perform_kernel)[name], value)
                self._asked[name] = value
