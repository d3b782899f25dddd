"""PyBullet's interface, on Carom.

The module has the names, arguments, defaults, results and errors of PyBullet 3.2.7, so that scripts
written for it run unmodified. Physics is in `carom`; here is what scripts see of it.

Lengths are in metres, masses in kilograms, times in seconds, angles in radians except for cameras;
quaternions are (x, y, z, w). A link has the index of the joint that carries it; -1 is the base.
"""

# ruff: noqa: F403  (each module lists in __all__ what it exports)

from pybullet._algebra import *
from pybullet._bodies import *
from pybullet._camera import *
from pybullet._camera_legacy import *
from pybullet._camera_maths import *
from pybullet._collision_filters import *
from pybullet._collision_shapes import *
from pybullet._connection import *
from pybullet._constants import *
from pybullet._constraints import *
from pybullet._contacts import *
from pybullet._debug_drawing import *
from pybullet._dynamics import *
from pybullet._engine import *
from pybullet._errors import error as error
from pybullet._forces import *
from pybullet._gui import *
from pybullet._inverse_kinematics import *
from pybullet._joints import *
from pybullet._links import *
from pybullet._loading import *
from pybullet._loading_scenes import *
from pybullet._logging import *
from pybullet._maths import *
from pybullet._motors import *
from pybullet._motors_multi_dof import *
from pybullet._multi_body import *
from pybullet._nearby import *
from pybullet._plugins import *
from pybullet._rays import *
from pybullet._scaling import *
from pybullet._scene_script import *
from pybullet._shape_data import *
from pybullet._soft_bodies import *
from pybullet._states import *
from pybullet._textures import *
from pybullet._unavailable import *
from pybullet._user_data import *
from pybullet._vhacd import *
from pybullet._visual_shapes import *
