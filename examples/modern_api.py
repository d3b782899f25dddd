"""The same one-joint arm with Carom's own interface: joints by name, NumPy in and out.

A trapezoidal path is followed by a PID controller on torque, fed forward with the torque that
holds the arm against gravity.
"""

import numpy as np

from carom import World
from carom.control import PID, TrapezoidalTrajectory
from carom.examples import robot_file

ARM = robot_file("one_joint_arm.urdf")


def main(duration=3.0):
    record = {"time": [], "path": [], "shoulder": []}
    with World(time_step=1 / 240) as world:
        world.gravity = (0, 0, -9.81)
        arm = world.load_urdf(ARM, fixed_base=True)
        shoulder, rod = arm.joints["shoulder"], arm.links["rod"]
        shoulder.free()

        path = TrapezoidalTrajectory(start=0.0, goal=1.2, max_velocity=1.0, max_acceleration=2.0)
        pid = PID(kp=60, ki=80, kd=10, derivative_on="error", output_limits=(-50, 50))
        lever = np.linalg.norm(rod.inertial_frame.position)
        while world.time < duration:
            wanted = path.sample(world.time).position
            gravity = rod.mass * 9.81 * lever * np.sin(shoulder.position)
            torque = pid.update(wanted, shoulder.position, world.parameters.time_step, feed_forward=gravity)
            shoulder.set_torque(torque)
            world.step()
            record["time"].append(world.time)
            record["path"].append(float(wanted))
            record["shoulder"].append(shoulder.position)

        position, orientation = rod.pose
        print(f"shoulder at {shoulder.position:.4f} rad after {world.time:.2f} s, limits {shoulder.limits}")
        print(f"rod at {position}, turned by {orientation}; centre of mass at {rod.inertial_pose.position}")
    return record


if __name__ == "__main__":
    main()
