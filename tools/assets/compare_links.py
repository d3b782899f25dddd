"""Draw each link of our arms and of the originals alone, from 24 sides in real PyBullet, and compare them.

Run `.oracle/bin/python tools/assets/compare_links.py [FILE ...]`, with an interpreter that has PyBullet and
the original pybullet_data. Of each link that is seen it prints, over all pictures, the share of pixels that
both silhouettes have among those that one of them has, that share in the worst picture, and the shares that
ours lacks and has too many.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from xml.etree import ElementTree

from compare_looks import ORIGINALS, OURS, PITCHES, Ball, Pictures, pictures, room

import pybullet as p

FILES = ("franka_panda/panda.urdf", "kuka_iiwa/model.urdf")

MASS = "<inertial><mass value='1'/><inertia ixx='1' ixy='0' ixz='0' iyy='1' iyz='0' izz='1'/></inertial>"


def seen(file: Path) -> dict[str, str]:
    """Of each link that is seen, by name: a robot of that link alone, which touches with what is seen."""
    found: dict[str, str] = {}
    for link in ElementTree.parse(file).getroot().iter("link"):
        visuals = link.findall("visual")
        for mesh in (mesh for visual in visuals for mesh in visual.iter("mesh")):
            stated = mesh.get("filename", "").removeprefix("package://")
            folders = (file.parent, *file.parents)
            mesh.set(
                "filename", str(next(folder / stated for folder in folders if (folder / stated).exists()))
            )
        shapes = "".join(ElementTree.tostring(visual, encoding="unicode") for visual in visuals)
        touching = shapes.replace("<visual", "<collision").replace("</visual", "</collision")
        if visuals:
            body = f"<link name='one'>{MASS}{shapes}{touching}</link>"
            found[link.get("name", "")] = f"<robot name='one'>{body}</robot>"
    return found


def load(robot: str, folder: Path) -> int:
    """A robot by its text, alone in the world. PyBullet keeps what it read by name: each gets its own."""
    file = folder / f"{len(list(folder.iterdir()))}.urdf"
    file.write_text(robot)
    p.resetSimulation()
    return int(p.loadURDF(str(file), useFixedBase=True))


def row(link: str, theirs: Pictures, ours: Pictures) -> str:
    """A row of the table."""
    mask, our_mask = theirs[0], ours[0]
    both, either = mask & our_mask, mask | our_mask
    worst = (both.sum(axis=(1, 2)) / either.sum(axis=(1, 2))).min()
    shares = [part.sum() / either.sum() for part in (both, mask & ~our_mask, our_mask & ~mask)]
    return f"| `{link}` | {shares[0]:.3f} | {worst:.3f} | {shares[1]:.3f} | {shares[2]:.3f} |"


def main(files: tuple[str, ...]) -> None:
    p.connect(p.DIRECT)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file in files:
            print(f"\n| {file} | overlap | worst | lacking | too many |\n|---|---|---|---|---|")
            originals, ours = seen(ORIGINALS / file), seen(OURS / file)
            for link in (link for link in originals if link in ours):
                ball: Ball = room(load(originals[link], folder))
                theirs = pictures(ball, PITCHES)
                load(ours[link], folder)
                print(row(link, theirs, pictures(ball, PITCHES)))


if __name__ == "__main__":
    main(tuple(sys.argv[1:]) or FILES)
