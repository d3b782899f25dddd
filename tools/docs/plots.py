"""Draws the figures of the tutorials by running the examples: `python tools/docs/plots.py [EXAMPLE ...]`."""

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


def show(image: Any, axis: Any) -> None:
    """A picture, without axes."""
    axis.imshow(image)
    axis.set_axis_off()


def labelled(axis: Any, y: str, x: str = "time [s]") -> None:
    """Names of the axes, and a grid and a legend."""
    axis.set_xlabel(x)
    axis.set_ylabel(y)
    axis.grid(alpha=0.3)
    axis.legend(fontsize="small")


def panels(*widths: float) -> tuple[Any, Any]:
    """A figure with panels side by side."""
    return pyplot.subplots(
        1, len(widths), figsize=(10, 3.4), width_ratios=widths, layout="constrained", squeeze=True
    )


def draw_camera(record: Record) -> Any:
    figure, axis = pyplot.subplots(figsize=(7, 4.7), layout="constrained")
    show(record["image"], axis)
    return figure


def draw_dropping(record: Record) -> Any:
    """The scene at its end, and the heights."""
    figure, (scene, axis) = panels(1.2, 1.0)
    show(record["image"], scene)
    for name, heights in record.items():
        if name not in ("time", "image"):
            axis.plot(record["time"], heights, label=name)
    labelled(axis, "height [m]")
    return figure


def draw_stacking(record: Record) -> Any:
    """The tower before and after the ball, and the heights of its cubes."""
    figure, (before, after, axis) = panels(1.0, 1.0, 1.1)
    show(record["image"], before)
    show(record["image after"], after)
    axis.plot(record["time"], record["heights"], "C0", linewidth=0.9)
    axis.plot([], [], "C0", label="each cube")
    labelled(axis, "height [m]")
    return figure


def draw_grasping(record: Record) -> Any:
    """The Panda with the cube, heights, and what the fingers do."""
    figure, (scene, heights, fingers) = panels(1.2, 1.0, 1.0)
    show(record["image"], scene)
    heights.plot(record["time"], record["hand"], label="hand")
    heights.plot(record["time"], record["cube"], label="cube")
    labelled(heights, "height [m]")
    fingers.plot(record["time"], [1e3 * opening for opening in record["opening"]], label="opening [mm]")
    fingers.plot(record["time"], record["press"], label="force of one finger [N]")
    labelled(fingers, "")
    return figure


def draw_driving(record: Record) -> Any:
    """The vehicles at the end, and their ways."""
    figure, (scene, axis) = panels(1.2, 1.0)
    show(record["image"], scene)
    for name in ("rover", "car"):
        axis.plot(*zip(*record[name], strict=True), label=name)
    axis.set_aspect("equal")
    labelled(axis, "y [m]", "x [m]")
    return figure


def draw_standing(record: Record) -> Any:
    """The robot on its feet, and how it moves."""
    figure, (scene, axis) = panels(1.2, 1.0)
    show(record["image"], scene)
    axis.plot(record["time"], record["height"], label="height")
    axis.plot(record["time"], record["way aside"], label="way aside")
    labelled(axis, "[m]")
    return figure


def draw_pushing(record: Record) -> Any:
    """The loss, and the ways of the balls before and after learning."""
    figure, (loss, ways) = pyplot.subplots(1, 2, figsize=(9, 3.4), layout="constrained")
    loss.semilogy(record["loss"])
    loss.set_xlabel("iteration")
    loss.set_ylabel("loss [m²]")
    for number, (before, after) in enumerate(zip(record["before"], record["after"], strict=True)):
        colour = f"C{number}"
        ways.plot(before, ":", color=colour)
        ways.plot(after, color=colour)
        ways.plot(len(after) - 1, record["targets"][number], "x", color=colour)
    ways.set_xlabel("step")
    ways.set_ylabel("ball [m]")
    for axis in (loss, ways):
        axis.grid(alpha=0.3)
    return figure


FIGURE_OF = {
    "default_motors": draw_one({"default motor": "-", "motor off": "-"}),
    "control_modes": draw_one({"POSITION": "-", "VELOCITY": "-", "TORQUE": "-", "PD": "-"}),
    "gravity_torque": draw_one({"angle": "-", "balance": "k:"}),
    "one_joint_pid": draw_one({"target": "k:", "PD": "-", "PID": "-"}),
    "panda_control": draw_panda,
    "swing_up": draw_one({"cart": "-", "pole": "-"}),
    "learn_push": draw_pushing,
    "modern_api": draw_one({"path": "k:", "shoulder": "-"}),
    "camera": draw_camera,
    "dropping": draw_dropping,
    "stacking": draw_stacking,
    "grasping": draw_grasping,
    "driving": draw_driving,
    "standing": draw_standing,
}


def main() -> None:
    """Run every example that has a figure and write the figure beside the tutorial."""
    sys.path.insert(0, str(EXAMPLES))
    for example in sys.argv[1:] or FIGURE_OF:
        draw = FIGURE_OF[example]
        figure = draw(__import__(example).main())
        path = FIGURES / f"{example.replace('_', '-')}.png"
        figure.savefig(path, dpi=100)
        pyplot.close(figure)
        print(path.relative_to(ROOT))


if __name__ == "__main__":
    main()
