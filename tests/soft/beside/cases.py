"""The grid of parameters: around one choice for each experiment, each parameter goes its way."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import Any

_CLOTH: dict[str, Any] = {
    "mass": 1.0,
    "springElasticStiffness": 100.0,
    "springDampingStiffness": 0.5,
    "springDampingAllDirections": 1,
}
_BENT = {"useBendingSprings": 1}
_SOLID: dict[str, Any] = {"useNeoHookean": 1, "mass": 1.5, "NeoHookeanDamping": 0.05}
_DROPPED: dict[str, Any] = {"mass": 4.0, "NeoHookeanDamping": 0.1}


@dataclass(frozen=True)
class Case:
    """An experiment with its parameters.

    Attributes:
        name: What is particular about it.
        experiment: Name of the function in `measure`.
        options: Its arguments.
    """

    name: str
    experiment: str
    options: dict[str, Any]


# What the parameters are called in names of cases.
_SHORT = {
    "springElasticStiffness": "k",
    "springDampingStiffness": "damping",
    "springBendingStiffness": "bending",
    "springDampingAllDirections": "all directions",
    "NeoHookeanMu": "mu",
    "NeoHookeanLambda": "lambda",
    "NeoHookeanDamping": "damping",
    "collisionMargin": "margin",
}
_UNSAID = {"useBendingSprings", "useMassSpring", "useNeoHookean", "ball", "seconds"}


def _mu(mu: float, lam: float) -> dict[str, Any]:
    return {"NeoHookeanMu": mu, "NeoHookeanLambda": lam}


def _cases(title: str, experiment: str, base: dict[str, Any], *changes: dict[str, Any]) -> Iterator[Case]:
    for change in changes:
        said = [
            f"{_SHORT.get(key, key)} {_text(value)}" for key, value in change.items() if key not in _UNSAID
        ]
        yield Case(", ".join([title, *said]), experiment, base | change)


def _text(value: Any) -> str:
    return "x".join(map(str, value)) if isinstance(value, tuple) else f"{value:g}"


def _springs(*stiffness: float, rates: tuple[int, ...] = (240,)) -> list[dict[str, Any]]:
    return [{"springElasticStiffness": k, "rate": rate} for k, rate in product(stiffness, rates)]


def _all() -> Iterator[Case]:
    yield from _cases(
        "cloth by an edge",
        "cloth_by_an_edge",
        _CLOTH,
        *_springs(20, 100, 400, 2000, 20000, rates=(60, 240)),
        {"rate": 480},
        *({"side": side} for side in (5, 13)),
        *({"mass": mass} for mass in (0.1, 0.3, 3.0)),
        *(_BENT | {"springBendingStiffness": bending} for bending in (2.0, 20.0, 100.0, 1000.0)),
        *({"springDampingStiffness": damping} for damping in (0.1, 2.0)),
    )
    yield from _cases(
        "cloth by two corners",
        "cloth_by_two_corners",
        _CLOTH | {"springDampingStiffness": 0.2},
        *_springs(40, 100, 400, 1000, 10000),
        *({"rate": rate} for rate in (60, 120, 480)),
        *({"side": side} for side in (5, 13)),
        *({"mass": mass} for mass in (0.3, 3.0)),
        *(_BENT | {"springBendingStiffness": bending} for bending in (1.0, 10.0, 100.0)),
        {"springDampingStiffness": 1.0},
    )
    yield from _cases(
        "cloth swings",
        "cloth_swings",
        {"mass": 1.0, "springElasticStiffness": 200.0, "springDampingStiffness": 0.0},
        *_springs(50, 100, 400, 2000),
        *({"rate": rate} for rate in (60, 120, 480)),
        *({"side": side} for side in (5, 13)),
        *({"mass": mass} for mass in (0.3, 3.0)),
        *({"springDampingStiffness": damping} for damping in (0.05, 0.5)),
        *(_BENT | {"springBendingStiffness": bending} for bending in (2.0, 20.0)),
    )
    yield from _cases(
        "cantilever",
        "cantilever",
        _SOLID | _mu(4000.0, 4000.0),
        *(_mu(mu, mu) for mu in (2e3, 8e3)),
        *(_mu(mu, mu) | {"seconds": 1.5} for mu in (1e5, 1e6, 1e7)),
        *(_mu(mu, mu) | {"seconds": 1.5, "NeoHookeanDamping": 5e-4} for mu in (1e5, 1e6)),
        *(_mu(*both) for both in ((2e3, 8e3), (8e3, 2e3))),
        _mu(1e3, 1e5) | {"NeoHookeanDamping": 0.01},
        *({"cells": cells} for cells in ((2, 1, 1), (6, 3, 3))),
        *({"rate": rate} for rate in (30, 60, 120, 480)),
        *({"mass": mass} for mass in (0.05, 0.5, 4.0)),
        *({"NeoHookeanDamping": damping} for damping in (0.02, 0.2)),
    )
    yield from _cases(
        "cantilever of springs",
        "cantilever",
        _CLOTH | {"useMassSpring": 1, "mass": 1.5, "springElasticStiffness": 400.0},
        *_springs(200, 400, 1000, 4000),
        *({"rate": rate} for rate in (60, 480)),
        *(_BENT | {"springBendingStiffness": bending} for bending in (20.0, 200.0, 2000.0)),
    )
    for title, ball in (("cube dropped", False), ("ball dropped", True)):
        yield from _cases(
            title,
            "dropped",
            _DROPPED | {"ball": ball} | _mu(1500.0, 1500.0),
            *(_mu(mu, mu) for mu in (800.0, 4e3, 2e4)),
            *(_mu(mu, mu) | {"seconds": 1.5} for mu in (1e5, 1e6)),
            *(_mu(mu, mu) | {"seconds": 1.5, "NeoHookeanDamping": 5e-4} for mu in (1e5,)),
            *(_mu(*both) for both in ((1.5e3, 6e3), (6e3, 1.5e3))),
            {"cells": 5},
            *({"rate": rate} for rate in (60, 120, 480)),
            *({"mass": mass} for mass in (0.1, 1.0, 8.0)),
            *({"NeoHookeanDamping": damping} for damping in (0.02, 0.3)),
            *({"collisionMargin": margin} for margin in (0.001, 0.02)),
        )


CASES: dict[str, Case] = {case.name: case for case in _all()}
