"""What P, I and D each do: three arms with one controller each, three plots side by side, three sliders.

The first arm has the proportional term alone, the second the derivative term beside it, the third all three.
"""

import time

from carom import World
from carom.control import PID
from carom.examples import robot_file
from carom.examples.window import TIME_STEP, wants_window
from carom.viewer import Viewer

ARM = robot_file("one_joint_arm.urdf")
NAMES = ("P", "PD", "PID")


def main(duration=float("inf"), window=True, gains=(40.0, 60.0, 8.0), target=1.2):
    world = World(TIME_STEP)
    world.gravity = (0, 0, -9.81)
    arms = [world.load_urdf(ARM, (0, 1.5 * place, 0), fixed_base=True) for place in (-1, 0, 1)]
    for arm in arms:
        arm.joints.free()
    viewer = Viewer(world, title="P, I and D") if window else None
    sliders = None
    if viewer is not None:
        print(f"The simulation is shown at {viewer.address}")
        viewer.open_browser()
        names = ("kp", "ki", "kd", "target [rad]")
        ranges = ((0, 100), (0, 100), (0, 20), (-3, 3))
        starts = (*gains, target)
        sliders = [viewer.slider(n, *r, s) for n, r, s in zip(names, ranges, starts, strict=True)]

    controllers = [PID(kp=0, output_limits=(-30, 30)) for _ in arms]
    record = {name: [] for name in NAMES}
    began = time.perf_counter()
    while world.time < duration and (viewer is None or viewer.is_open):
        kp, ki, kd, wanted = (*gains, target) if sliders is None else (s.value for s in sliders)
        for name, arm, controller in zip(NAMES, arms, controllers, strict=True):
            controller.kp = kp
            controller.kd = kd if "D" in name else 0.0
            controller.ki = ki if "I" in name else 0.0
            joint = arm.joints[0]
            torque = controller.update(wanted, joint.position, TIME_STEP)
            joint.set_torque(torque)
            record[name].append(joint.position)
            if viewer is not None:
                viewer.plot(f"error of {name} [rad]", wanted - joint.position)
        world.step()
        if viewer is not None:
            time.sleep(max(0.0, began + world.time - time.perf_counter()))
    if viewer is not None:
        viewer.close()
    return record


if __name__ == "__main__":
    main(window=wants_window(), duration=float("inf") if wants_window() else 4.0)
