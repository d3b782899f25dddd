"""PyBullet's interface, implemented with Carom.

The module has the names, arguments, defaults, results and errors of PyBullet 3.2.7, so that scripts
written for it run unmodified. The simulation itself is in `carom`.

Lengths are in metres, masses in kilograms, times in seconds, angles in radians except for cameras;
quaternions are (x, y, z, w). A link has the index of its parent joint; -1 is the base.
"""

# ruff: noqa: F403  (each module lists in __all__ what it exports)

from pybullet._algorithms.algebra import *
from pybullet._algorithms.inverse_kinematics import *
from pybullet._bodies.bodies import *
from pybullet._bodies.dynamics import *
from pybullet._bodies.forces import *
from pybullet._bodies.links import *
from pybullet._bodies.scaling import *
from pybullet._bodies.soft_bodies import *
from pybullet._bodies.user_data import *
from pybullet._calls.constants import *
from pybullet._calls.errors import error as error
from pybullet._cameras.camera import *
from pybullet._cameras.camera_legacy import *
from pybullet._connections.connection import *
from pybullet._contacts.collision_filters import *
from pybullet._contacts.contacts import *
from pybullet._contacts.nearby import *
from pybullet._contacts.rays import *
from pybullet._engine.engine import *
from pybullet._engine.states import *
from pybullet._joints.constraints import *
from pybullet._joints.joints import *
from pybullet._joints.motors import *
from pybullet._joints.motors_multi_dof import *
from pybullet._loading.loading import *
from pybullet._loading.loading_scenes import *
from pybullet._loading.multi_body import *
from pybullet._loading.scene_script import *
from pybullet._loading.soft import *
from pybullet._logs.logging import *
from pybullet._maths.camera_maths import *
from pybullet._maths.maths import *
from pybullet._plugins.plugins import *
from pybullet._shapes.collision_shapes import *
from pybullet._shapes.shape_data import *
from pybullet._shapes.textures import *
from pybullet._shapes.vhacd import *
from pybullet._shapes.visual_shapes import *
from pybullet._window.debug_drawing import *
from pybullet._window.gui import *
