"""Data classes that leave the printing to their base print as those do that the decorator gives a method."""

from dataclasses import dataclass, field

import pytest

from carom.description import Box, Pose, Robot
from carom.description.printed import Printed
from carom.engine.parameters import EngineParameters
from carom.model.link_dynamics import LinkDynamics


@dataclass(repr=False, slots=True)
class Ours(Printed):
    first: float
    inner: object = None
    items: list[int] = field(default_factory=list)


@dataclass(slots=True)
class Usual:
    first: float
    inner: object = None
    items: list[int] = field(default_factory=list)


def test_it_prints_what_the_decorator_would() -> None:
    ours, usual = (made(0.5, made(1), [2, 3]) for made in (Ours, Usual))
    assert repr(ours) == repr(usual).replace("Usual", "Ours")


def test_descriptions_print_their_fields() -> None:
    assert repr(Box((1.0, 2.0, 3.0))) == "Box(half_extents=(1.0, 2.0, 3.0))"
    assert repr(Pose()) == "Pose(position=(0.0, 0.0, 0.0), orientation=(0.0, 0.0, 0.0, 1.0))"


@pytest.mark.parametrize("made", [Box, Pose, Robot, EngineParameters, LinkDynamics])
def test_the_decorator_compiles_no_method_for_it(made: type) -> None:
    assert "__repr__" not in vars(made)
    assert made.__repr__ is Printed.__repr__
