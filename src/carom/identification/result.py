"""What an identification found: values, bounds, and what cannot be told apart."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from statistics import NormalDist
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from numpy.typing import NDArray

from carom.checks import Array
from carom.identification.least_squares import combinations
from carom.identification.unknowns import Unknowns

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

_LISTED = 4


class _Problem(Protocol):
    channels: tuple[str, ...]

    @property
    def cutoff(self) -> float | None: ...

    @property
    def noise(self) -> Array: ...

    def fit(self, p: Array) -> tuple[slice | NDArray[np.intp], Array, Array]: ...

    def spread(self, p: Array) -> Array | None: ...


@dataclass(frozen=True, eq=False, slots=True)
class Combination:
    """A sum of parameters that data determine.

    Attributes:
        factors: By the names of the parameters; that of the first is 1.
        value: The sum.
        bound: It is within this of the true sum.
        deviation: Standard deviation.
    """

    factors: dict[str, float]
    value: float
    bound: float
    deviation: float

    def __str__(self) -> str:
        terms = [
            f"{'' if factor == 1.0 else f'{factor:+.4g} '}{name}" for name, factor in self.factors.items()
        ]
        more = f" + {len(terms) - _LISTED} more" if len(terms) > _LISTED else ""
        return " ".join(terms[:_LISTED]) + more


@dataclass(frozen=True, eq=False, slots=True)
class IdentificationResult:
    """What `carom.identify` found.

    Attributes:
        values: By the names of the parameters.
        starts: What they were in the world.
        bounds: Each value is within this of the true one, all together with the probability `confidence`;
            infinite for parameters that cannot be told from others.
        deviations: Their standard deviations, likewise.
        combinations: What data determine: single parameters, and sums of those that cannot be told apart.
        ineffective: Parameters that change nothing in this log.
        at_bound: Parameters whose value is at its lower bound.
        delays: Delays of controls [s], by control.
        confidence: Probability that all bounds hold.
        noise: Standard deviations of residuals, by what was compared.
        cutoff: Cut-off of the filter that positions and torques have passed [Hz]; None for none.
        time: Times of what was compared [s], (m,).
        measured: (m, channels).
        fitted: Likewise.
        covariance: Of the combinations.
    """

    values: dict[str, float]
    starts: dict[str, float]
    bounds: dict[str, float]
    deviations: dict[str, float]
    combinations: list[Combination]
    ineffective: list[str]
    at_bound: list[str]
    delays: dict[str, float]
    confidence: float
    noise: dict[str, float]
    cutoff: float | None
    time: Array
    measured: Array
    fitted: Array
    covariance: Array
    _unknowns: Unknowns
    _p: Array

    def apply(self, world: World, body: Body | str | None = None) -> None:
        """Give a world the values; delays are left to the user, a world has none.

        Args:
            world: The world that was given, or another one with the robot.
            body: The robot there; by default the one with the same number.

        Raises:
            ValueError: There is no such body, or its links are others.
            NotImplementedError: Something is fixed to inertial frames of its links, so centres cannot move.
        """
        own = self._unknowns.body
        if body is None:
            target = world.bodies.get(own.id)
            if target is None:
                raise ValueError(f"the world has no body {own.id}: say which one is the robot")
        elif isinstance(body, str):
            named = [it for it in world.bodies.values() if it.name == body]
            if len(named) != 1:
                raise ValueError(f"{len(named)} bodies have the name {body!r}")
            target = named[0]
        else:
            target = body
        if [it.name for it in target.spec.links] != [it.name for it in own.spec.links]:
            raise ValueError(f"{target.name!r} has other links than {own.name!r}")
        self._unknowns.write(world, target, self._p)

    def report(self) -> str:
        """A table of all parameters, and of sums of those that cannot be told apart."""
        alone = [name for name in self.values if np.isfinite(self.bounds[name])]
        width = max((len(name) for name in self.values), default=0)
        lines = [f"{'':{width}}  {'start':>11} {'found':>11} {'within ±':>11}"]
        for name, value in self.values.items():
            known = name in alone
            bound = f"{self.bounds[name]:11.3g}" if known else f"{'-':>11}"
            note = "  at its bound" if name in self.at_bound else ""
            lines.append(f"{name:{width}}  {self.starts[name]:11.5g} {value:11.5g} {bound}{note}")
        sums = [it for it in self.combinations if len(it.factors) > 1]
        if sums:
            lines += ["", "Cannot be told apart; their sums are known:"]
            lines += [f"  {it} = {it.value:.5g} ± {it.bound:.2g}" for it in sums]
        if self.ineffective:
            lines += ["", "Without effect in this log: " + ", ".join(self.ineffective)]
        lines += ["", f"All bounds together hold with a probability of {self.confidence:.0%}. Noise:"]
        lines += [f"  {name}: {value:.3g}" for name, value in self.noise.items()]
        if self.cutoff is not None:
            lines.append(
                f"Positions and torques have passed a filter with a cut-off of {self.cutoff:.3g} Hz."
            )
        return "\n".join(lines)

    def __str__(self) -> str:
        return self.report()

    def plot(self, path: str | Path) -> None:
        """Draw what was measured, what was fitted and the residuals; Matplotlib does it.

        Args:
            path: A file `.svg`, `.png` or `.pdf`.

        Raises:
            ImportError: Matplotlib is not installed.
            OSError: The file cannot be written.
        """
        _draw(self, Path(path))


def result_of(
    unknowns: Unknowns,
    p: Array,
    at_bound: NDArray[np.bool_],
    matrix: Array,
    problem: _Problem,
    times: Array,
    confidence: float,
) -> IdentificationResult:
    """Collect the results of a fit.

    Raises:
        ValueError: Data determine nothing.
    """
    names = unknowns.names
    found = combinations(matrix, unknowns.scale)
    count = len(found.factors)
    if not count:
        raise ValueError("the log does not depend on any of the parameters")
    # Bonferroni's inequality: together they hold with at least this probability.
    quantile = NormalDist().inv_cdf(1.0 - 0.5 * (1.0 - confidence) / count)
    covariance, spread = found.covariance, problem.spread(p)
    variances = np.diag(covariance)
    if spread is not None:
        # That of correlated noise; estimated, so that it is no reason for bounds less than those without.
        covariance = covariance @ spread[np.ix_(found.rows, found.rows)] @ covariance
        variances = np.maximum(variances, np.diag(covariance))
    sizes = np.sqrt(variances)
    sums: list[Combination] = []
    bounds, deviations = dict.fromkeys(names, np.inf), dict.fromkeys(names, np.inf)
    for factors, size in zip(found.factors, sizes.tolist(), strict=True):
        places = np.flatnonzero(factors)
        places = sorted(places.tolist(), key=lambda place: (factors[place] != 1.0, place))
        own = {names[place]: float(factors[place]) for place in places}
        sums.append(Combination(own, float(factors @ p), quantile * size, size))
        if len(own) == 1:
            bounds[names[places[0]]], deviations[names[places[0]]] = quantile * size, size
    used = np.any(found.factors, axis=0)
    rows, seen, fitted = problem.fit(p)
    values = dict(zip(names, p.tolist(), strict=True))
    return IdentificationResult(
        values=values,
        starts=dict(zip(names, unknowns.start.tolist(), strict=True)),
        bounds=bounds,
        deviations=deviations,
        combinations=sums,
        ineffective=[name for name, it in zip(names, used, strict=True) if not it],
        at_bound=[name for name, it in zip(names, at_bound.tolist(), strict=True) if it],
        delays={control: float(p[place]) for control, place in unknowns.delays.items()},
        confidence=confidence,
        noise=dict(zip(problem.channels, problem.noise.tolist(), strict=True)),
        cutoff=problem.cutoff,
        time=times[rows],
        measured=seen,
        fitted=fitted,
        covariance=covariance,
        _unknowns=unknowns,
        _p=p,
    )


def _draw(result: IdentificationResult, path: Path) -> None:
    """Draw measured and fitted values and residuals of each channel, and the single parameters.

    Raises:
        ImportError: Matplotlib is not installed.
    """
    try:
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        from matplotlib.figure import Figure
    except ImportError:
        raise ImportError("plots need Matplotlib: pip install 'carom[plot]'") from None
    channels = list(result.noise)
    known = [name for name, bound in result.bounds.items() if np.isfinite(bound)]
    heights = [1.6] * len(channels) + ([0.6 + 0.16 * len(known)] if known else [])
    figure: Any = Figure(figsize=(10.0, sum(heights) + 0.6), layout="constrained")
    FigureCanvasAgg(figure)
    grid = figure.add_gridspec(len(heights), 2, height_ratios=heights)
    for row, channel in enumerate(channels):
        values, errors = figure.add_subplot(grid[row, 0]), figure.add_subplot(grid[row, 1])
        values.plot(result.time, result.measured[:, row], lw=0.8, label="measured")
        values.plot(result.time, result.fitted[:, row], lw=0.8, label="fitted")
        values.set_ylabel(channel, fontsize="small")
        errors.plot(result.time, (result.measured - result.fitted)[:, row], lw=0.6, color="tab:red")
        for side in (-2.0, 2.0):
            errors.axhline(side * result.noise[channel], color="gray", lw=0.6, ls="--")
        if row == 0:
            values.legend(fontsize="small", loc="upper right")
            errors.set_title("residuals, and twice their deviation", fontsize="small")
        if row == len(channels) - 1:
            values.set_xlabel("time [s]")
            errors.set_xlabel("time [s]")
    if known:
        _draw_parameters(figure.add_subplot(grid[len(channels), :]), result, known)
    figure.savefig(path)


def _draw_parameters(axes: Any, result: IdentificationResult, known: list[str]) -> None:
    """Changes of parameters with their bounds, relative to the greater of start and value."""
    sizes = np.array([max(abs(result.starts[name]), abs(result.values[name]), 1e-12) for name in known])
    change = np.array([result.values[name] - result.starts[name] for name in known]) / sizes
    bound = np.array([result.bounds[name] for name in known]) / sizes
    axes.errorbar(change, range(len(known)), xerr=np.minimum(bound, 2.0), fmt="o", ms=3, lw=1.0)
    axes.axvline(0.0, color="gray", lw=0.6)
    axes.set_yticks(range(len(known)), known, fontsize="x-small")
    axes.invert_yaxis()
    axes.set_xlabel("change by the identification, relative, and its bound")
