"""Write docs/conformance: a table of all scenarios, and plots of Carom over PyBullet.

    .venv/bin/python -m tests.conformance.report

PyBullet's side is the recorded goldens; Carom runs here and now.
"""

from __future__ import annotations

import importlib
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from . import golden
from .catalogue import select
from .compare import Agreement, compare
from .scenario import Kind, Scenario, Series

OUTPUT = Path(__file__).resolve().parents[2] / "docs" / "conformance"


@dataclass(frozen=True)
class Plot:
    """A series worth looking at; `stride` and `time_step` are those of its scenario."""

    scenario: str
    series: str
    title: str
    quantity: str
    stride: int = 8
    time_step: float = 1.0 / 240.0

    def times(self, samples: int) -> np.ndarray:
        """Times of the samples in seconds: every stride-th step, and the last of whole seconds."""
        times = (1 + self.stride * np.arange(samples)) * self.time_step
        times[-1] = min(times[-1], round(times[-1] * 4) / 4)
        return times


PLOTS = (
    Plot("arm_falls_freely", "from 1.2 rad at 0.0 rad/s/position", "One joint falls freely", "angle [rad]"),
    Plot("pid_at_240_hz", "position", "PID on the torque at 240 Hz", "angle [rad]"),
    Plot(
        "position_control_grid",
        "kp 0.1, kd 1.0, 14.0 N m/position",
        "POSITION_CONTROL at its force limit",
        "angle [rad]",
        stride=16,
    ),
    Plot("double_pendulum_swings", "file/position", "Double pendulum", "angles [rad]"),
    Plot("panda_position", "position", "Panda, interpolated position targets", "angles [rad]"),
    Plot("panda_effort", "velocity", "Panda under joint torques", "velocities [rad/s]"),
    Plot(
        "limits_hit_at_speed",
        "(-9.0, -12.0, 6.0) rad/s/position",
        "Limits hit at speed",
        "positions [rad, m]",
    ),
    Plot("floating_tree_tumbles", "gravity 0.0/base_spin", "Floating tree, thrown", "spin [rad/s]"),
    Plot("sensors_on_free_arm", "force", "Force-torque sensors of a swinging arm", "forces [N]"),
)


def measure(scenario: Scenario) -> tuple[Series, Series, list[Agreement]]:
    """PyBullet's series, Carom's, and how they agree."""
    expected = golden.read(golden.path_of(scenario.name)).series
    measured = scenario.series(importlib.import_module("pybullet"))
    return expected, measured, compare(scenario, expected, measured)


def draw(plot: Plot, expected: np.ndarray, measured: np.ndarray) -> str:
    """Draw Carom's series as lines and PyBullet's as rings; returns the file's name."""
    import matplotlib

    matplotlib.use("svg")
    matplotlib.rcParams["svg.hashsalt"] = "carom"
    matplotlib.rcParams["svg.fonttype"] = "none"
    from matplotlib import pyplot

    times = plot.times(len(expected))
    figure, axes = pyplot.subplots(figsize=(6.0, 3.2), layout="constrained")
    ours, theirs = measured.reshape(len(times), -1), expected.reshape(len(times), -1)
    for column in range(ours.shape[1]):
        colour = f"C{column % 10}"
        label = ("Carom", "PyBullet") if column == 0 else (None, None)
        axes.plot(times, ours[:, column], color=colour, linewidth=1.4, label=label[0])
        axes.plot(
            times[::2],
            theirs[::2, column],
            "o",
            color=colour,
            markersize=4,
            fillstyle="none",
            label=label[1],
        )
    axes.set(title=plot.title, xlabel="time [s]", ylabel=plot.quantity)
    axes.grid(alpha=0.3)
    axes.legend(frameon=False)
    name = f"{plot.scenario}.svg"
    figure.savefig(OUTPUT / name, metadata={"Date": None})
    pyplot.close(figure)
    return name


def row(scenario: Scenario, agreements: list[Agreement]) -> str:
    """The scenario's row of the table: its worst series against what is promised for it."""
    worst = max(agreements, key=lambda agreement: agreement.error / agreement.tolerance)
    verdict = "yes" if all(agreement.holds for agreement in agreements) else "**no**"
    return (
        f"| {scenario.title} | `{scenario.name}` | {len(agreements)} | {worst.error:.1e} "
        f"| {worst.tolerance:.0e} | {verdict} |"
    )


def page(engine: str, rows: dict[str, list[str]], pictures: dict[Plot, str], holding: int) -> str:
    """The report as Markdown."""
    count = sum(len(lines) for lines in rows.values())
    parts = [
        "# Conformance",
        "",
        f"Every scenario below ran in {engine} (recorded) and in Carom; {holding} of {count} agree as",
        "promised. The error is that of the series nearest to its bound: the greatest difference",
        "divided by the greatest magnitude PyBullet's series reaches, or, for tables of facts, link by",
        "link. [How it is measured](method.md). This page is made by `make report`.",
        "",
        "Lines are Carom, rings are PyBullet.",
        "",
    ]
    parts += [f"![{plot.title}]({pictures[plot]})" for plot in PLOTS]
    for group, lines in rows.items():
        parts += [
            "",
            f"## {group.replace('_', ' ').capitalize()}",
            "",
            "| scenario | name | series | error | promised | holds |",
            "|---|---|---:|---:|---:|---|",
            *lines,
        ]
    return "\n".join(parts) + "\n"


def main() -> None:
    """Run everything and write the pages."""
    OUTPUT.mkdir(parents=True, exist_ok=True)
    rows: dict[str, list[str]] = {}
    pictures: dict[Plot, str] = {}
    engine, holding = "", 0
    for scenario in select([]):
        expected, measured, agreements = measure(scenario)
        engine = golden.read(golden.path_of(scenario.name)).engine.replace("pybullet", "PyBullet")
        rows.setdefault(scenario.group, []).append(row(scenario, agreements))
        holding += all(agreement.holds for agreement in agreements)
        for plot in PLOTS:
            if plot.scenario == scenario.name:
                pictures[plot] = draw(plot, expected[plot.series], measured[plot.series])
        print(f"{scenario.name:40} {'facts' if scenario.kind is Kind.INFO else 'motion'}", flush=True)
    (OUTPUT / "index.md").write_text(page(engine, rows, pictures, holding), encoding="utf-8")


if __name__ == "__main__":
    main()
