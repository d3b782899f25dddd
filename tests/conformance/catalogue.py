"""All scenarios there are."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterable

from . import scenarios
from .scenario import REGISTRY, Scenario


def all_scenarios() -> dict[str, Scenario]:
    """Every scenario by name, in the order of modules and then of definition."""
    within = f"{scenarios.__name__}."
    for name in sorted(module.name for module in pkgutil.walk_packages(scenarios.__path__, within)):
        importlib.import_module(name)
    return dict(REGISTRY)


def select(names: Iterable[str]) -> list[Scenario]:
    """The scenarios with these names (all if there are none); an unknown name is an error."""
    known = all_scenarios()
    wanted = list(names) or list(known)
    unknown = [name for name in wanted if name not in known]
    if unknown:
        raise SystemExit(f"no such scenario: {', '.join(unknown)}")
    return [known[name] for name in wanted]
