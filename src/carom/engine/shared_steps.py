"""Steps of a lone world of which several threads perform shares.

A share is an island of a launch that solves constraints, or some trees of one that moves trees. What becomes
of it depends on nothing that happens in others, so bits do not depend on the number of threads, nor on which
of them takes what. `native/source/team.cpp` has the threads; the order of all launches is that of the
program, which the thread that takes the step goes through as ever.
"""

from __future__ import annotations

import os
import weakref
from ctypes import addressof, c_int32, c_void_p
from itertools import chain
from typing import Any

import numpy as np

from carom.engine.interpreter import Interpreter, Stepper
from carom.engine.program import Plan, Program, step_program
from carom.engine.workspace import Workspace
from carom.layouts.programs import COUNTER_STRIDE, Helper, KernelCall, ShareCall, Shares, Team
from carom.layouts.status import STATUS
from carom.native.arrays import c_array
from carom.native.host import host
from carom.native.kernels import (
    constraints_kernel,
    converged_constraints_kernel,
    explicit_motion_kernel,
    free_motion_kernel,
    integration_kernel,
    midpoint_integration_kernel,
    midpoint_motion_kernel,
)
from carom.native.launch import Launch
from carom.native.library import library

FEWEST_LINKS = 64
"""With fewer links nothing is shared."""
# Nor are constraints in steps with fewer contacts and constraints of joints and users in all: others that are
# woken up would come too late.
_FEWEST_ROWS = 200
# Trees take so little time that only many links are shared.
_FEWEST_MOVING = 512
_SOLVING = frozenset((constraints_kernel, converged_constraints_kernel))
_MOVING = frozenset(
    (
        explicit_motion_kernel,
        free_motion_kernel,
        integration_kernel,
        midpoint_integration_kernel,
        midpoint_motion_kernel,
    )
)


class SharedSteps:
    """The threads that share the steps of a world, and what each needs: workspace and launches.

    The threads begin with the first step that is shared, and end with this object.

    Args:
        threads: Number of threads, the one that takes the step included; at least 2.
    """

    def __init__(self, threads: int) -> None:
        self._count = threads
        self._team: _Threads | None = None
        # What workspaces and launches are made for.
        self._made_for: Any = None
        self._members: list[Workspace] = []
        self._kept: list[Any] = []
        # The records of launches that solve constraints.
        self._solving: list[Shares] = []

    def fit(
        self, stepper: Stepper, workspace: Workspace, status: np.ndarray, plan: Plan, loaded_for: Any
    ) -> None:
        """Let threads share the launches of a stepper, if that saves time.

        Args:
            stepper: It has loaded its program.
            workspace: Its workspace.
            status: `State.status_entry` of the only world.
            plan: That of the program.
            loaded_for: What the program is made for.
        """
        if not isinstance(stepper, Interpreter):
            return
        settings = workspace.structs["settings"]
        links, constraints = settings.link_count, settings.constraint_count + settings.user_count
        # Without the host the library has no threads.
        is_shared = host is not None and plan.coupled and not plan.soft and links >= FEWEST_LINKS
        kernels = _SOLVING | _MOVING if links >= _FEWEST_MOVING else _SOLVING
        making_for = (loaded_for, kernels) if is_shared else None
        if making_for != self._made_for:
            # Nothing is left in place if there is no memory for what follows.
            stepper.share({})
            self._made_for, self._members, self._kept, self._solving = None, [], [], []
            if is_shared:
                stepper.share(self._make(workspace, status, plan, kernels))
            self._made_for = making_for
        for record in self._solving:
            record.fewest = _FEWEST_ROWS - constraints

    def settings_changed(self) -> None:
        """Update the launches after the settings of kernels have changed."""
        for member in self._members:
            member.structs.changed("settings")

    def _make(
        self, workspace: Workspace, status: np.ndarray, plan: Plan, kernels: frozenset[Any]
    ) -> dict[int, int]:
        """The address of the shares of each launch that is shared, by its place in the program."""
        if self._team is None:
            self._team = _Threads(self._count)
        taken = self._team.taken
        first = workspace.with_own_launches()
        first.bind(workspace.structs)
        first.share_by(taken)
        # Those of different threads are in different cache lines.
        own = np.zeros((self._count, 1, COUNTER_STRIDE), dtype=np.int32)
        others = [workspace.for_share(taken, one) for one in own[1:]]
        self._members = [first, *others]
        programs = [step_program(member.structs, plan) for member in self._members]
        places = [status[0, STATUS:].ctypes.data, *(one[0, STATUS:].ctypes.data for one in own[1:])]
        contacts = workspace.structs["contacts"]
        shares: dict[int, Shares] = {}
        self._kept = [own, programs, contacts, shares]
        for place, launches in enumerate(zip(*map(_launches, programs), strict=True)):
            if launches[0].kernel in kernels:
                calls = c_array(ShareCall, self._count, map(_share, launches, places))
                self._kept.append(calls)
                count = contacts.count_contacts.data
                shares[place] = record = Shares(self._team.address, addressof(calls), count)
                if launches[0].kernel in _SOLVING:
                    self._solving.append(record)
        return {place: addressof(record) for place, record in shares.items()}


def _launches(program: Program) -> list[Launch]:
    return list(chain.from_iterable(program))


def _share(launch: Launch, status: int) -> ShareCall:
    *call, first_world = launch.addresses("first_world")
    return ShareCall(KernelCall(*call), first_world, status)


class _Threads:
    """A `Team`; its threads, which know nothing of Python, end with this object.

    Attributes:
        address: Address of the team.
        taken: Number of shares of the present launch that threads have taken, shape (1, n), in a cache line.
    """

    def __init__(self, count: int) -> None:
        _count_forks()
        self._helpers = c_array(Helper, count - 1)
        self.taken: np.ndarray = np.zeros((1, COUNTER_STRIDE), dtype=np.int32)
        self._team = Team(
            helpers=addressof(self._helpers), helper_count=count - 1, taken=self.taken.ctypes.data
        )
        self.address: int = addressof(self._team)
        for number, helper in enumerate(self._helpers, start=1):
            helper.team, helper.number = self.address, number
        weakref.finalize(self, _end, self._team, self._helpers, self.taken).atexit = False


def _end(team: Team, *_kept: object) -> None:
    library().symbols.carom_end_team(c_void_p(addressof(team)))


_counts_forks: list[bool] = []


def _count_forks() -> None:
    """Let the library know of forks from now on: a forked process has to begin threads of its own."""
    if _counts_forks or not hasattr(os, "register_at_fork"):
        return
    forks = c_int32.in_dll(library().symbols, "carom_forks")

    def count() -> None:
        forks.value += 1

    _counts_forks.append(True)
    os.register_at_fork(after_in_child=count)
