"""The loader of the library robot_descriptions, on robots that need not be fetched."""

from __future__ import annotations

import sys
from pathlib import Path
from types import ModuleType

import pytest

import pybullet as p
import pybullet_data

loaders = pytest.importorskip("robot_descriptions.loaders.pybullet", reason="its loader is tried")

ROBOTS = {
    "panda_description": "franka_panda/panda.urdf",
    "iiwa14_description": "kuka_iiwa/model.urdf",
    "a1_description": "a1/a1.urdf",
    "laikago_description": "laikago/laikago.urdf",
}


@pytest.mark.parametrize("name", ROBOTS)
def test_a_description_is_loaded_as_its_file_is(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    path = Path(pybullet_data.getDataPath()) / ROBOTS[name]
    description = ModuleType(f"robot_descriptions.{name}")
    description.__dict__.update(URDF_PATH=str(path), PACKAGE_PATH=str(path.parent))
    monkeypatch.setitem(sys.modules, description.__name__, description)
    p.connect(p.DIRECT)
    try:
        described = loaders.load_robot_description(name, useFixedBase=True)
        loaded = p.loadURDF(str(path), useFixedBase=True)
        joints = range(p.getNumJoints(loaded))
        assert joints
        assert [p.getJointInfo(described, joint) for joint in joints] == [
            p.getJointInfo(loaded, joint) for joint in joints
        ]
    finally:
        p.disconnect()
