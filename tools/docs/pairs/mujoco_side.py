"""Draws scenes by MuJoCo's own renderer: `MUJOCO_GL=egl python mujoco_side.py PAIRS FOLDER`.

It needs `mujoco`, and nothing of Carom. PAIRS is a JSON list of scenes: name, file, and azimuth, elevation,
distance and target of the camera. A picture NAME.ppm of each comes into FOLDER, and beside it NAME.json with
the camera.
"""

from __future__ import annotations

import json
import sys
from math import cos, radians, sin
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]

WIDTH, HEIGHT = 480, 360


def main() -> None:
    """Draws all scenes."""
    pairs, folder = json.loads(Path(sys.argv[1]).read_text()), Path(sys.argv[2])
    for pair in pairs:
        model = mujoco.MjModel.from_xml_path(pair["file"])
        data = mujoco.MjData(model)
        mujoco.mj_forward(model, data)
        model.vis.global_.offwidth, model.vis.global_.offheight = WIDTH, HEIGHT
        camera = mujoco.MjvCamera()
        camera.lookat[:], camera.distance = pair["target"], pair["distance"]
        camera.azimuth, camera.elevation = pair["azimuth"], pair["elevation"]
        with mujoco.Renderer(model, HEIGHT, WIDTH) as renderer:
            renderer.update_scene(data, camera)
            pixels = renderer.render()
        (folder / f"{pair['name']}.ppm").write_bytes(b"P6 %d %d 255\n" % (WIDTH, HEIGHT) + pixels.tobytes())
        turn, rise = radians(camera.azimuth), radians(camera.elevation)
        ahead = (cos(rise) * cos(turn), cos(rise) * sin(turn), sin(rise))
        facts = {
            "eye": [
                at - camera.distance * way for at, way in zip(camera.lookat.tolist(), ahead, strict=True)
            ],
            "target": camera.lookat.tolist(),
            "field_of_view": float(model.vis.global_.fovy),
        }
        (folder / f"{pair['name']}.json").write_text(json.dumps(facts))


main()
