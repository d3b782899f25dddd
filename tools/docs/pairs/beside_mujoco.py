"""Pictures of scenes in the viewer beside those of MuJoCo's renderer, as one sheet.

    PYTHONPATH=. python tools/docs/pairs/beside_mujoco.py REPOSITORIES --mujoco PYTHON [--only NAME]

REPOSITORIES is a folder with checkouts of the repositories of `SCENES`, each as OWNER+NAME; the files are not
Carom's, and only the pictures are kept. PYTHON is one with `mujoco` installed. Needs Chromium. The pictures
alone, of full size, come into the folder for temporary files with `--keep FOLDER`.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from PIL import Image, ImageDraw
from tests.viewer.browser import Page, chromium

from carom import Camera, World
from carom.viewer import Viewer

ROOT = Path(__file__).resolve().parents[3]
SHEET = ROOT / "docs" / "beside-mujoco.jpg"
WIDTH, HEIGHT = 480, 360
# Of a picture on the sheet, and of the line above it [pixels].
SMALL, LINE = (320, 240), 16
# Until a picture is as sharp as it gets.
STILL = 3_000
SUITE = "google-deepmind+dm_control/dm_control/suite"
GYM = "Farama-Foundation+Gymnasium/gymnasium/envs/mujoco/assets"
ROBOTICS = "Farama-Foundation+Gymnasium-Robotics/gymnasium_robotics/envs/assets"
WARP = "google-deepmind+mujoco_warp/benchmarks"


def scene(
    name: str,
    file: str,
    azimuth: float,
    elevation: float,
    distance: float,
    target: tuple[float, float, float],
) -> dict[str, Any]:
    """A scene, and where it is seen from."""
    return {
        "name": name,
        "file": file,
        "azimuth": azimuth,
        "elevation": elevation,
        "distance": distance,
        "target": target,
    }


# Azimuth and elevation [degrees], distance and target [m] of the camera, as in MuJoCo.
SCENES: list[dict[str, Any]] = [
    scene("ALOHA", f"{WARP}/aloha_pot/scene.xml", 90, -25, 1.7, (0, -0.1, 0.2)),
    scene("Shadow hand", f"{ROBOTICS}/hand/reach.xml", 125, -30, 0.75, (1.0, 1.0, 0.17)),
    scene("manipulator", f"{SUITE}/manipulator.xml", 90, -15, 1.6, (0, 0, 0.45)),
    scene("humanoid", f"{WARP}/humanoid/humanoid.xml", 130, -15, 2.8, (0, 0, 0.8)),
    scene("Humanoid-v5", f"{GYM}/humanoid.xml", 130, -15, 3.5, (0, 0, 0.9)),
    scene("Ant-v5", f"{GYM}/ant.xml", 130, -30, 3.5, (0, 0, 0.5)),
    scene("quadruped", f"{SUITE}/quadruped.xml", 130, -20, 3.5, (0, 0, 0.4)),
    scene("walker", f"{SUITE}/walker.xml", 60, -15, 3.2, (0, 0, 0.8)),
]


def main() -> None:
    """Draws the pairs, and puts them together."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("repositories", type=Path)
    parser.add_argument("--mujoco", required=True, help="a Python with mujoco")
    parser.add_argument("--only", help="one scene, by its name")
    parser.add_argument("--keep", type=Path, help="a folder for the pictures of full size")
    arguments = parser.parse_args()
    os.environ["CI"] = "true"
    chosen = [
        {**scene, "file": str(arguments.repositories / scene["file"])}
        for scene in SCENES
        if arguments.only in (None, scene["name"])
    ]
    with TemporaryDirectory() as temporary, chromium() as browser:
        folder = arguments.keep or Path(temporary)
        folder.mkdir(exist_ok=True)
        (folder / "pairs.json").write_text(json.dumps(chosen))
        subprocess.run(
            [arguments.mujoco, Path(__file__).with_name("mujoco_side.py"), folder / "pairs.json", folder],
            check=True,
            env={**os.environ, "MUJOCO_GL": os.environ.get("MUJOCO_GL", "egl")},
        )
        pictures = [(scene["name"], *pair(scene, folder, browser)) for scene in chosen]
        if arguments.only is None:
            sheet(pictures).save(SHEET, quality=82, optimize=True)


def pair(scene: dict[str, Any], folder: Path, browser: Any) -> tuple[Image.Image, Image.Image]:
    """The picture of MuJoCo and that of the viewer, from the same camera."""
    name = scene["name"]
    facts = json.loads((folder / f"{name}.json").read_text())
    lens = Camera.with_field_of_view(WIDTH, HEIGHT, facts["field_of_view"])
    world = World()
    world.load_mjcf(scene["file"])
    viewer = Viewer(world, port=0)
    viewer.show_camera("pair", lens.look_at(tuple(facts["eye"]), tuple(facts["target"])))
    page = Page(browser, viewer.address, WIDTH, HEIGHT)
    page.until("window.app?.scene.poses.length > 0 && app.lenses.lenses.size > 0")
    page.until("[...app.lenses.lenses.values()].some(({ name }) => name === 'pair')")
    page.page.evaluate(
        "app.lenses.toggle([...app.lenses.lenses.values()].find(({ name }) => name === 'pair').lens)"
    )
    for element in ("panel", "labels", "timeline", "previews"):
        page.page.evaluate(f"document.getElementById('{element}').style.opacity = 0")
    page.until_drawn()
    page.page.wait_for_timeout(STILL)
    page.page.screenshot(path=folder / f"{name}.png")
    page.page.close()
    viewer.close()
    with Image.open(folder / f"{name}.ppm") as theirs, Image.open(folder / f"{name}.png") as ours:
        return theirs.convert("RGB"), ours.convert("RGB")


def sheet(pictures: list[tuple[str, Image.Image, Image.Image]]) -> Image.Image:
    """All pairs, two in each row: of each the left one is MuJoCo's."""
    (width, height), columns = SMALL, 2
    rows = -(-len(pictures) // columns)
    made = Image.new("RGB", (columns * (2 * width + 8), rows * (height + LINE)), "white")
    draw = ImageDraw.Draw(made)
    for index, (name, theirs, ours) in enumerate(pictures):
        x, y = index % columns * (2 * width + 8), index // columns * (height + LINE)
        draw.text((x + 4, y + 2), f"{name}: MuJoCo", fill="black")
        draw.text((x + width + 4, y + 2), "Carom", fill="black")
        for at, picture in ((x, theirs), (x + width, ours)):
            made.paste(picture.resize(SMALL, Image.Resampling.LANCZOS), (at, y + LINE))
    return made


if __name__ == "__main__":
    main()
