"""What a new installation has to be able to do: a step, a contact, an image. Prints what it was done with.

Runs on its own, with the Python that Carom is installed in: `python -I first_steps.py`.
"""

import importlib.util
import platform

import pybullet as p
import pybullet_data
from carom.native.library import PACKAGED, library
from carom.version import __version__

assert p.connect(p.DIRECT) == 0
p.setAdditionalSearchPath(pybullet_data.getDataPath())
p.setGravity(0, 0, -9.81)
plane = p.loadURDF("plane.urdf")
robot = p.loadURDF("r2d2.urdf", [0, 0, 0.6])
p.stepSimulation()
height = p.getBasePositionAndOrientation(robot)[0][2]
assert 0.59 < height < 0.6, f"after a step R2D2 is at {height} m"
for _ in range(240):
    p.stepSimulation()
weight = sum(contact[9] for contact in p.getContactPoints(robot, plane))
assert weight > 1, f"the floor holds R2D2 with {weight} N"

view = p.computeViewMatrix([2, 2, 1], [0, 0, 0.3], [0, 0, 1])
projection = p.computeProjectionMatrixFOV(60, 1, 0.1, 10)
image = p.getCameraImage(64, 64, view, projection)
bodies = {int(number) for number in image[4].ravel()}
assert {plane, robot} <= bodies, f"the image shows {bodies}"
p.disconnect()

assert library().path.parent == PACKAGED, f"the library is {library().path}"
assert importlib.util.find_spec("warp") is None, "the code generator was installed with it"
print(f"Carom {__version__} runs on Python {platform.python_version()} with {library().path.name}")
