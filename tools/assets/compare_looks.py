"""Draw our robots and things and the originals from 24 sides in real PyBullet, and print how alike they are.

Run `.oracle/bin/python tools/assets/compare_looks.py`, with an interpreter that has PyBullet and the original
pybullet_data. Of each file it prints, over all pictures, the share of pixels that both silhouettes have among
those that one of them has, that share in the worst picture, the mean colours, and how many pixels of either
silhouette differ by more than 24 of 255 in a channel. `compare_looks.py record` writes the silhouettes of the
original robots for the tests.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

import pybullet as p
import pybullet_data

ROOT = Path(__file__).resolve().parents[2]
OURS = ROOT / "src" / "pybullet_data"
RECORD = ROOT / "tests" / "pybullet_data" / "silhouettes.npz"
ORIGINALS = Path(pybullet_data.getDataPath())
EDGE = 160
"""Of a picture [pixels]."""
PITCHES, FLOOR_PITCHES = (-50.0, -20.0, 15.0), (-70.0, -45.0, -20.0)
YAWS = range(10, 370, 45)
"""Cameras stand so [degrees], floors are seen from above."""
FLOOR = ((0.3, 0.2, 0.0), 3.0)
"""Middle and radius of what is looked at of a floor [m]."""
DIFFERENT = 24

ROBOTS = (
    "franka_panda/panda.urdf",
    "kuka_iiwa/model.urdf",
    "kuka_iiwa/kuka_with_gripper2.sdf",
    "xarm/xarm6_robot.urdf",
    "xarm/xarm6_with_gripper.urdf",
    "r2d2.urdf",
)
FILES = (
    *ROBOTS,
    "plane.urdf",
    "plane100.urdf",
    "table/table.urdf",
    "table_square/table_square.urdf",
    "tray/tray.urdf",
    "tray/traybox.urdf",
    "tray/tray_textured2.urdf",
)
Ball = tuple[tuple[float, ...], float]
Pictures = tuple[NDArray[np.bool_], NDArray[np.int_]]


def load(path: Path) -> int:
    """The first body of a file, alone in the world."""
    p.resetSimulation()
    if path.suffix == ".sdf":
        return int(p.loadSDF(str(path))[0])
    return int(p.loadURDF(str(path), useFixedBase=True))


def room(body: int) -> Ball:
    """Middle and radius of a ball around a body [m]."""
    boxes = np.array([p.getAABB(body, link) for link in range(-1, p.getNumJoints(body))])
    low, high = boxes[:, 0].min(axis=0), boxes[:, 1].max(axis=0)
    return tuple(((low + high) / 2.0).tolist()), float(np.linalg.norm(high - low)) / 2.0


def pictures(ball: Ball, pitches: tuple[float, ...]) -> Pictures:
    """Silhouettes (n, EDGE, EDGE) and colours (n, EDGE, EDGE, 3), 0 to 255, of what is in the world."""
    middle, radius = ball
    lens = p.computeProjectionMatrixFOV(45.0, 1.0, 0.5 * radius, 10.0 * radius)
    masks, colours = [], []
    for pitch in pitches:
        for yaw in YAWS:
            view = p.computeViewMatrixFromYawPitchRoll(middle, 3.0 * radius, yaw, pitch, 0.0, 2)
            image = p.getCameraImage(EDGE, EDGE, view, lens, renderer=p.ER_TINY_RENDERER)
            masks.append(np.reshape(image[4], (EDGE, EDGE)) >= 0)
            colours.append(np.reshape(image[2], (EDGE, EDGE, 4))[..., :3].astype(int))
    return np.array(masks), np.array(colours)


def row(file: str, theirs: Pictures, ours: Pictures) -> str:
    """A row of the table."""
    (mask, colour), (our_mask, our_colour) = theirs, ours
    both, either = mask & our_mask, mask | our_mask
    worst = (both.sum(axis=(1, 2)) / either.sum(axis=(1, 2))).min()
    means = [
        ", ".join(f"{channel:.0f}" for channel in picture[shown].mean(axis=0))
        for picture, shown in ((colour, mask), (our_colour, our_mask))
    ]
    apart = (np.abs(colour - our_colour).max(axis=-1) > DIFFERENT)[either].mean()
    shares = f"{both.sum() / either.sum():.3f} | {worst:.3f}"
    return f"| `{file}` | {shares} | {means[0]} | {means[1]} | {100.0 * apart:.0f} % |"


def record() -> None:
    """Write silhouettes of the original robots, as bits, and the balls that were looked at."""
    arrays: dict[str, Any] = {}
    for file in ROBOTS:
        middle, radius = room(load(ORIGINALS / file))
        name = file.replace("/", "__")
        arrays[f"{name}:ball"] = np.array((*middle, radius))
        arrays[name] = np.packbits(pictures((middle, radius), PITCHES)[0])
    np.savez_compressed(RECORD, **arrays)


def main(task: str) -> None:
    p.connect(p.DIRECT)
    if task == "record":
        record()
        return
    print("| file | overlap | worst | its mean colour | ours | other colour |")
    print("|---|---|---|---|---|---|")
    for file in FILES:
        body = load(ORIGINALS / file)
        floor = file.startswith("plane")
        ball, pitches = (FLOOR, FLOOR_PITCHES) if floor else (room(body), PITCHES)
        theirs = pictures(ball, pitches)
        load(OURS / file)
        print(row(file, theirs, pictures(ball, pitches)))


if __name__ == "__main__":
    main(sys.argv[1] if len(sys.argv) > 1 else "compare")
