"""Load a Panda and let it hold a pose against gravity."""

import carom

world = carom.World(gravity=(0, 0, -9.81))
panda = world.load_urdf("franka_panda/panda.urdf", fixed_base=True)
arm = panda.joints[:7]
arm.servo([0, -0.4, 0, -2.2, 0, 1.9, 0.8], kp=4000, kd=400)
world.step(480)
print(arm.positions)
