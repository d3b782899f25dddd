"""Lets the native library perform steps of a world by itself."""

from __future__ import annotations

from typing import Any

from carom.engine.engine import Engine
from carom.engine.parameters import EngineParameters
from carom.engine.quick_scene import QuickScene

# Without contacts, a step of so few links ends within some microseconds.
_FEW_LINKS, _FEW_SWEEPS = 32, 100


def show_steps(engine: Engine, quick: QuickScene, observers: list[Any], parameters: EngineParameters) -> None:
    """Let the native library perform steps, until the scene changes.

    Args:
        engine: The engine, prepared.
        quick: The addresses of the world.
        observers: The objects that are told of each step; while there are any, quick calls leave steps to
            Python.
        parameters: Parameters of the world.
    """
    contacts = engine.contact_arrays.contacts.struct()
    substeps = parameters.substep_count
    sweeps = parameters.solver_iterations * parameters.noncontact_inner_iterations * substeps
    is_small = engine.arrays.used["link"] <= _FEW_LINKS and not engine.contact_arrays.soft.bodies
    count = contacts.count_contacts.data if is_small and sweeps <= _FEW_SWEEPS else None
    quick.set_step_addresses(engine.step_addresses(), observers, count, (engine, contacts), substeps=substeps)
