"""The main job: a Franka Panda through effort, velocity and position control, a one-joint arm under PID.

Prints a table of what happened and draws the joint trajectories to demo-output/trajectories.png. It
is written for PyBullet and runs on it unchanged.
"""

import time
from pathlib import Path

import matplotlib
import numpy as np
import one_joint_pid
import panda_control

import pybullet as p

OUTPUT = Path("demo-output")
ARM_TIME_STEPS = (1 / 1000, 1 / 240, 1 / 60)
ARM_TARGET = 1.2


def start():
    """Connect, load the Panda and use the engine once: what that compiles is not to be timed."""
    p.connect(p.DIRECT)
    robot, joints = panda_control.load_panda()
    p.stepSimulation()
    rest = [0.0] * len(joints)
    p.calculateInverseDynamics(robot, rest, rest, rest)
    panda_control.go_home(robot, joints)
    return robot, joints


def run_panda(duration):
    """One result per phase: the path of the seven arm joints and what they made of it."""
    robot, joints = start()
    for name in panda_control.PHASES:
        began = time.perf_counter()
        wanted, measured = panda_control.run_phase(robot, joints, name, duration)
        yield {
            "name": f"Panda, {name} control",
            "wall": time.perf_counter() - began,
            "time": np.arange(1, len(wanted) + 1) * panda_control.TIME_STEP,
            "wanted": wanted[:, :7],
            "measured": measured[:, :7],
        }
    p.disconnect()


def run_arm(duration):
    """One result per time step: the one-joint arm on its way to the target."""
    for time_step in ARM_TIME_STEPS:
        p.connect(p.DIRECT)
        arm = one_joint_pid.load_arm(time_step)
        p.stepSimulation()
        steps = round(duration / time_step)
        controller = one_joint_pid.PID(kp=40, ki=60, kd=8)
        began = time.perf_counter()
        angles, _ = one_joint_pid.swing(arm, controller, ARM_TARGET, steps, time_step)
        yield {
            "name": f"arm, PID at 1/{round(1 / time_step)} s",
            "wall": time.perf_counter() - began,
            "time": np.arange(1, steps + 1) * time_step,
            "wanted": np.full((steps, 1), ARM_TARGET),
            "measured": np.array(angles)[:, None],
        }
        p.disconnect()


def print_table(results):
    print(
        f"{'phase':26} {'steps':>6} {'simulated':>10} {'wall':>9} {'real time':>10} "
        f"{'rms error':>10} {'final error':>12}"
    )
    for result in results:
        error = np.abs(result["measured"] - result["wanted"])
        simulated = result["time"][-1]
        print(
            f"{result['name']:26} {len(result['time']):6d} {simulated:8.2f} s {result['wall']:7.3f} s "
            f"{simulated / result['wall']:9.1f}x {np.sqrt(np.mean(error**2)):6.4f} rad "
            f"{error[-1].max():8.5f} rad"
        )


def draw(panda, arm, path):
    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(2, 2, figsize=(12, 8), layout="constrained")
    for axis, result in zip(axes.flat[:3], panda, strict=True):
        for joint in range(7):
            colour = f"C{joint}"
            axis.plot(result["time"], result["measured"][:, joint], colour, label=f"joint {joint + 1}")
            axis.plot(result["time"], result["wanted"][:, joint], colour, linestyle=":", linewidth=2.5)
        axis.set_title(result["name"] + " (dotted: the path)")
    axes[0, 0].legend(fontsize="small", ncols=2, loc="center left", bbox_to_anchor=(0, 0.33))
    for result in arm:
        axes[1, 1].plot(result["time"], result["measured"], label=result["name"])
    axes[1, 1].axhline(ARM_TARGET, color="black", linestyle=":", label="target")
    axes[1, 1].set_title("one-joint arm, PID on torque")
    axes[1, 1].legend(fontsize="small")
    for axis in axes.flat:
        axis.set_xlabel("time [s]")
        axis.set_ylabel("joint position [rad]")
        axis.grid(alpha=0.3)
    path.parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(path, dpi=110)
    pyplot.close(figure)


def main(duration=2.0, output=OUTPUT):
    """Run everything, `duration` seconds a phase; returns the results and the plot's path."""
    began = time.perf_counter()
    panda = list(run_panda(duration))
    arm = list(run_arm(2 * duration))
    print_table([*panda, *arm])
    plot = Path(output) / "trajectories.png"
    draw(panda, arm, plot)
    print(f"\nin all {time.perf_counter() - began:.1f} s; the joint trajectories are in {plot}")
    return [*panda, *arm], plot


if __name__ == "__main__":
    main()
