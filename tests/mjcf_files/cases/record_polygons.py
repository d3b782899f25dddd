"""Records what MuJoCo makes of the files in `polygon.py`: python record_polygons.py, with mujoco 4.0."""

import json
import tempfile
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
from polygon import PRISMS, WAYS, model, obj, polygons

FLAT = (
    '<mujoco><asset><mesh name="m" file="faces.obj" inertia="shell"/></asset><worldbody><body><geom '
    'type="mesh" mesh="m"/></body></worldbody></mujoco>'
)


def load(folder: Path, text: str) -> mujoco.MjModel:
    (folder / "file.xml").write_text(text)
    return mujoco.MjModel.from_xml_path(str(folder / "file.xml"))


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "faces.obj").write_text(obj(polygons()))
        answers = {"faces": load(folder, FLAT).mesh_face.tolist(), "masses": {}}
        for prism, text in PRISMS.items():
            (folder / f"{prism}.obj").write_text(text)
            for way in WAYS:
                m = load(folder, model(prism, way))
                answers["masses"][f"{prism} {way}"] = [
                    m.body_mass[1],
                    *m.body_ipos[1].tolist(),
                    *sorted(m.body_inertia[1].tolist()),
                ]
    Path(__file__).with_name("polygon_answers.json").write_text(json.dumps(answers) + "\n")
