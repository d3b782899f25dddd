"""Draws the figures of the tutorials by running the examples: `python tools/docs/plots.py`."""

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

from matplotlib import pyplot

ROOT = Path(__file__).parents[2]
EXAMPLES = ROOT / "examples"
FIGURES = ROOT / "docs" / "tutorials"

Record = dict[str, Any]


def draw_series(record: Record, names: dict[str, str], axis: Any) -> None:
    """Draw the named series over time; each name comes with its line style."""
    for name, style in names.items():
        axis.plot(record["time"], record[name], style, label=name)
    axis.set_xlabel("time [s]")
    axis.set_ylabel("joint angle [rad]")
    axis.grid(alpha=0.3)
    axis.legend(fontsize="small")


def draw_one(names: dict[str, str]) -> Callable[[Record], Any]:
    """A figure with one axis that shows the named series."""

    def draw(record: Record) -> Any:
        figure, axis = pyplot.subplots(figsize=(7, 3.4), layout="constrained")
        draw_series(record, names, axis)
        return figure

    return draw


def draw_panda(record: Record) -> Any:
    """How far each arm joint is from its path, one panel for each kind of control."""
    figure, axes = pyplot.subplots(1, len(record), figsize=(10, 3.4), sharey=True, layout="constrained")
    for axis, (name, phase) in zip(axes, record.items(), strict=True):
        error = (phase["measured"] - phase["wanted"])[:, :7]
        for joint in range(7):
            axis.plot(phase["time"], 1e3 * error[:, joint], label=f"joint {joint + 1}")
        axis.set_title(name)
        axis.set_xlabel("time [s]")
        axis.grid(alpha=0.3)
    axes[0].set_ylabel("distance from the path [mrad]")
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside right center", fontsize="small")
    return figure


FIGURE_OF = {
    "default_motors": draw_one({"default motor": "-", "motor off": "-"}),
    "control_modes": draw_one({"POSITION": "-", "VELOCITY": "-", "TORQUE": "-", "PD": "-"}),
    "gravity_torque": draw_one({"angle": "-", "balance": "k:"}),
    "one_joint_pid": draw_one({"target": "k:", "PD": "-", "PID": "-"}),
    "panda_control": draw_panda,
    "modern_api": draw_one({"path": "k:", "shoulder": "-"}),
}


def main() -> None:
    """Run every example that has a figure and write the figure beside the tutorial."""
    sys.path.insert(0, str(EXAMPLES))
    for example, draw in FIGURE_OF.items():
        figure = draw(__import__(example).main())
        path = FIGURES / f"{example.replace('_', '-')}.png"
        figure.savefig(path, dpi=100)
        pyplot.close(figure)
        print(path.relative_to(ROOT))


if __name__ == "__main__":
    main()
