"""The comparison itself: it must see differences, and only differences."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from .compare import compare
from .golden import Golden, read, write
from .scenario import REGISTRY, Kind, Scenario, Trace, scenario, under


def _scenario(kind: Kind = Kind.MOTION, single_precision: tuple[str, ...] = ()) -> Scenario:
    return Scenario("example", lambda p: {}, kind, single_precision, "group", "title")


def _error(golden: object, measured: object, kind: Kind = Kind.MOTION) -> float:
    (agreement,) = compare(_scenario(kind), {"x": np.asarray(golden)}, {"x": np.asarray(measured)})
    return agreement.error


def test_motion_is_judged_by_the_scale_of_the_whole_series() -> None:
    golden = [[10.0, 0.0], [0.0, 1e-3]]
    measured = [[10.0, 1e-6], [0.0, 1e-3]]
    assert _error(golden, measured) == pytest.approx(1e-7)


def test_information_is_judged_row_by_row() -> None:
    golden = [[10.0, 0.0], [0.0, 1e-3]]
    measured = [[10.0, 0.0], [0.0, 1.001e-3]]
    assert _error(golden, measured, Kind.INFO) == pytest.approx(1e-3)
    assert _error(golden, measured) == pytest.approx(1e-7)


def test_rounding_around_zero_is_no_difference() -> None:
    assert _error([0.0, 0.0], [1e-17, -1e-17], Kind.INFO) < 1e-9


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_non_finite_values_never_agree(bad: float) -> None:
    golden, measured = {"x": np.array([1.0, 2.0])}, {"x": np.array([1.0, bad])}
    (agreement,) = compare(_scenario(), golden, measured)
    assert not agreement.holds
    assert agreement.sample == 1


def test_shapes_text_and_whole_numbers_must_be_equal() -> None:
    assert _error([1.0, 2.0], [1.0]) == np.inf
    assert _error(["base"], ["Base"]) == np.inf
    assert _error([3, 4], [3, 5]) == np.inf
    assert _error(["base"], ["base"]) == 0.0


def test_a_series_of_one_side_only_is_a_difference() -> None:
    agreements = compare(_scenario(), {"x": np.ones(2)}, {"y": np.ones(2)})
    assert [agreement.series for agreement in agreements] == ["x", "y"]
    assert not any(agreement.holds for agreement in agreements)


def test_first_sample_beyond_tolerance_is_named() -> None:
    golden = {"x": np.ones(5)}
    measured = {"x": np.array([1.0, 1.0, 1.1, 1.0, 2.0])}
    (agreement,) = compare(_scenario(), golden, measured)
    assert agreement.sample == 2
    assert agreement.error == pytest.approx(1.0)


def test_single_precision_fields_have_their_own_tolerance() -> None:
    golden, measured = {"case/frame": np.ones(1)}, {"case/frame": np.array([1.0 + 1e-7])}
    (strict,) = compare(_scenario(Kind.INFO), golden, measured)
    (single,) = compare(_scenario(Kind.INFO, ("frame",)), golden, measured)
    assert not strict.holds
    assert single.holds


def test_a_scenario_may_have_a_tolerance_of_its_own() -> None:
    loose = replace(_scenario(), tolerance=1e-3)
    (agreement,) = compare(loose, {"x": np.ones(2)}, {"x": np.array([1.0, 1.0005])})
    assert agreement.holds
    (agreement,) = compare(loose, {"x": np.ones(2)}, {"x": np.array([1.0, 1.0015])})
    assert not agreement.holds


def test_tolerances_may_go_by_the_endings_of_names() -> None:
    mixed = replace(_scenario(), tolerance={"way": 1e-2})
    golden = {name: np.ones(2) for name in ("fast/way", "fast/speed")}
    measured = {name: np.array([1.0, 1.005]) for name in golden}
    assert {a.series: a.holds for a in compare(mixed, golden, measured)} == {
        "fast/way": True,
        "fast/speed": False,
    }


def test_archive_gives_back_what_was_written(tmp_path: Path) -> None:
    series = {
        "case/real": np.array([[1.5, -0.0], [np.pi, 1e-300]]),
        "whole": np.array([1, -2]),
        "text": np.array(["link", "ünïcode"]),
        "empty": np.array([]),
        "more": np.array([0.25]),
    }
    first, second = tmp_path / "a.npz", tmp_path / "b.npz"
    write(first, Golden("pybullet 1", series))
    write(second, read(first))
    assert first.read_bytes() == second.read_bytes()
    restored = read(first)
    assert restored.engine == "pybullet 1"
    assert list(restored.series) == list(series)
    for name, values in series.items():
        np.testing.assert_array_equal(restored.series[name], values)


def test_archive_refuses_what_is_not_a_number_or_text(tmp_path: Path) -> None:
    with pytest.raises(TypeError, match="series bad"):
        write(tmp_path / "a.npz", Golden("pybullet 1", {"bad": np.array([None])}))


def test_trace_keeps_every_stride_th_and_the_last_sample() -> None:
    trace = Trace(stride=4)
    for step in range(11):
        trace.sample({"step": step, "pair": ((step, 0.5), (1.0,))})
    series = trace.series()
    assert series["step"].tolist() == [0, 4, 8, 10]
    assert series["pair"].shape == (4, 3)


def test_names_of_scenarios_are_unique() -> None:
    def new_scenario(p: object) -> dict[str, object]:
        """A title."""
        return {}

    scenario()(new_scenario)
    try:
        with pytest.raises(ValueError, match="two scenarios"):
            scenario()(new_scenario)
    finally:
        del REGISTRY["new_scenario"]


def test_cases_are_named_by_prefix() -> None:
    assert under("slow", {"speed": 1}) == {"slow/speed": 1}
