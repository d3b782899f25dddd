"""Pick up a cube with a Panda, and put it down somewhere else."""

import carom

world = carom.World(gravity=(0, 0, -9.81), time_step=0.002)
world.add_plane()
cube = world.add_box((0.02, 0.02, 0.02), (0.5, 0.2, 0.02), mass=0.1, friction=1)
panda = world.load_urdf("franka_panda/panda.urdf", fixed_base=True)
arm, fingers = panda.joints[:7], panda.joints["panda_finger*"]
arm.positions = [0, -0.4, 0, -2.2, 0, 1.9, 0.8]


def reach(x: float, y: float, z: float) -> None:
    pose = carom.Pose((x, y, z), (1, 0, 0, 0))
    found = panda.inverse_kinematics("panda_grasptarget", pose)
    arm.servo(found.positions[:7], kp=4000, kd=400)
    world.step(500)


def grip(width: float) -> None:
    fingers.servo(width, kp=1000, kd=50)
    world.step(250)


grip(0.04)
reach(0.5, 0.2, 0.15)
reach(0.5, 0.2, 0.02)
grip(0.0)
reach(0.5, 0.2, 0.15)
reach(0.5, -0.2, 0.15)
reach(0.5, -0.2, 0.025)
grip(0.04)
reach(0.5, -0.2, 0.15)
print(cube.pose)
