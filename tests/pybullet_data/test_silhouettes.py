"""Robots of our own have the silhouettes of PyBullet's, from 24 sides."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from tests.each import each
from tools.assets.compare_looks import EDGE, PITCHES, load, pictures

import pybullet as p
import pybullet_data

DATA = Path(pybullet_data.getDataPath())
RECORD = Path(__file__).with_name("silhouettes.npz")
"""Written by `.oracle/bin/python tools/assets/compare_looks.py record`."""
LEAST = {
    "franka_panda/panda.urdf": 0.97,
    "kuka_iiwa/model.urdf": 0.975,
    "kuka_iiwa/kuka_with_gripper2.sdf": 0.96,
    "xarm/xarm6_robot.urdf": 0.935,
    "xarm/xarm6_with_gripper.urdf": 0.93,
    "r2d2.urdf": 0.965,
}
"""The share of pixels that both silhouettes have, among those that one of them has."""


@each("file", sorted(LEAST))
def test_silhouettes_overlap_pybullets(file: str) -> None:
    with np.load(RECORD) as record:
        name = file.replace("/", "__")
        *middle, radius = record[f"{name}:ball"].tolist()
        theirs = np.unpackbits(record[name]).reshape(-1, EDGE, EDGE).astype(bool)
    p.connect(p.DIRECT)
    try:
        load(DATA / file)
        ours, _ = pictures((tuple(middle), radius), PITCHES)
    finally:
        p.disconnect()
    assert theirs.shape == ours.shape
    assert (theirs & ours).sum() / (theirs | ours).sum() > LEAST[file]
