"""Carom's own assets, under the file names PyBullet scripts use.

`p.setAdditionalSearchPath(pybullet_data.getDataPath())` makes them available to `loadURDF` and the
other loading functions.
"""

import os
import sys
from types import ModuleType

from pybullet_data._copies import data_folder

__all__ = ["getDataPath"]

# PyBullet's folders of settings, policies and recordings are packages without code. Their files are not here.
_EMPTY = """configs configs_v2 configs_v2.base configs_v2.robots configs_v2.scenes configs_v2.tasks
configs_v2.wrappers policies policies.ppo policies.ppo.minitaur_reactive_env
policies.ppo.minitaur_trotting_env testdata testdata.test_imu_state_estimator"""


def getDataPath() -> str:
    """The folder of the assets: robots, floors, objects, meshes and textures.

    They are Carom's own, or those of PyBullet if `python -m carom data --from-pybullet` or the environment
    variable `CAROM_PYBULLET_DATA` says so.

    Raises:
        FileNotFoundError: That copy of PyBullet's files is no longer there, or is something else.
    """
    return data_folder(os.path.dirname(os.path.abspath(__file__)))


def _add_empty_packages() -> None:
    for name in _EMPTY.split():
        module = ModuleType(f"{__name__}.{name}", "A folder of PyBullet's; its files are not in Carom.")
        module.__path__ = []
        parent, _, last = module.__name__.rpartition(".")
        sys.modules[module.__name__] = module
        setattr(sys.modules[parent], last, module)


_add_empty_packages()
