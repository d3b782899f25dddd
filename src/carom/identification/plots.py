"""Plots of an identification."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from carom.identification.result import IdentificationResult


def draw(result: IdentificationResult, path: Path) -> None:
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
