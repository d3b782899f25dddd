"""Programs as native code reads them."""

from __future__ import annotations

from itertools import accumulate, chain

from carom.engine.program import Program
from carom.layouts.programs import KernelCall, WorldCall
from carom.layouts.programs import Program as ProgramRecord
from carom.native.launch import Launch


def write_program(record: ProgramRecord, program: Program) -> None:
    """Put the launches of a program into its record; both have to exist as long as the record is used."""
    record.part_ends[:] = list(accumulate(map(len, program)))
    for place, launch in enumerate(chain.from_iterable(program)):
        record.launches[place] = world_call(launch)


def world_call(launch: Launch) -> WorldCall:
    """A launch for one world; it has to exist as long as the record is used."""
    *call, first_world, substeps = launch.addresses("first_world", "substeps")
    return WorldCall(KernelCall(*call), first_world, substeps)
