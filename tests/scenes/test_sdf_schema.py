"""Each element and attribute of the SDF specification 1.12 is taken, or reported with its consequence.

`data/sdf_schema.txt` has their names, indented as they are in each other; `+` is before those that hold a
value. One that stands without what is in it has the content of the first one of its name.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

import pytest

from carom.formats.reading.cursor import Cursor
from carom.formats.sdf.document import Document
from carom.formats.sdf.rules import SDF_RULES
from carom.formats.search import AssetSearch

SCHEMA = Path(__file__).with_name("data") / "sdf_schema.txt"
VALUES = {
    **dict.fromkeys(("pose", "pos"), ""),
    **dict.fromkeys(
        ("xyz", "normal", "scale", "gravity", "magnetic_field", "linear_velocity", "radii"), "0 0 1"
    ),
    **dict.fromkeys(("fdir1", "custom_rpy", "grav_dir_x"), "1 0 0"),
    **dict.fromkeys(("static", "kinematic", "self_collide", "enable_orientation"), "0"),
    **dict.fromkeys(("diffuse", "specular", "ambient", "emissive"), "1 1 1 1"),
    "parent": "world",
    "child": "its link",
    "uri": "nowhere.dae",
    "size": "1 1 1",
    "samples": "1",
    "frame": "child",
    "measure_direction": "parent_to_child",
    "point": "0 0",
}
ATTRIBUTES = {"joint": "its joint", "auto": "0", "merge": "0", "degrees": "0", "version": "1.12"}
ATTRIBUTES |= dict.fromkeys(("relative_to", "attached_to", "expressed_in", "placement_frame"), "")
ATTRIBUTES |= {"canonical_link": "its link", "rotation_format": "euler_rpy", "axis": "axis"}
SHAPES = {
    "polyline": "<point>0 0</point><point>1 0</point><point>0 1</point><height>1</height>",
    "plane": "<normal>0 0 1</normal><size>1 1</size>",
    "image": "<uri>a.png</uri><scale>1</scale><threshold>1</threshold><height>1</height>",
}
SENSORS = ("imu", "camera", "lidar", "contact", "altimeter", "magnetometer", "navsat", "air_pressure")


@dataclass
class Node:
    tag: str
    attributes: list[str]
    is_value: bool = False
    children: list[Node] = field(default_factory=list)


def schema() -> tuple[Node, dict[str, Node]]:
    root, whole = Node("", []), dict[str, Node]()
    open_nodes = [root]
    for line in SCHEMA.read_text().splitlines():
        depth = len(line) - len(line.lstrip())
        del open_nodes[depth + 1 :]
        first, *others = line.split()
        if first == "+":
            open_nodes[-1].children += [Node(tag, [], is_value=True) for tag in others]
            continue
        node = Node(first, [name[1:] for name in others])
        open_nodes[-1].children.append(node)
        open_nodes.append(node)
    pending = [root]
    while pending:
        node = pending.pop(0)
        if node.children:
            whole.setdefault(node.tag, node)
        pending += node.children
    return root.children[0], whole


class Writer:
    """Writes a document with everything, each kind of shape and sensor in turn."""

    def __init__(self, shape: str, sensor: str) -> None:
        self.root, self._whole = schema()
        self._shape = shape
        self._sensor = sensor

    def text(self, node: Node, around: tuple[str, ...] = ()) -> str:
        tag = node.tag
        attributes = "".join(f' {name}="{self._attribute(name, tag, around)}"' for name in node.attributes)
        if node.is_value:
            value = "1" if (tag, around[-1]) == ("gravity", "link") else VALUES.get(tag, "1")
            return f"<{tag}>{value}</{tag}>"
        if tag == "geometry":
            shape = SHAPES.get(self._shape, "")
            return f"<geometry><{self._shape}>{shape}</{self._shape}></geometry>"
        children = node.children or getattr(self._whole.get(tag), "children", [])
        value = "" if children else VALUES.get(tag, "")
        if tag == "xyz":
            value = VALUES["xyz"]
        below = (*around, tag)
        # A model in a model again would have no end, and one document has one world.
        inside = "".join(
            self.text(child, below)
            for child in children
            if child.tag not in below and not (tag == "sdf" and child.tag != "world")
        )
        return f"<{tag}{attributes}>{value}{inside}</{tag}>"

    def _attribute(self, name: str, tag: str, around: tuple[str, ...]) -> str:
        if name == "name":
            return f"its {tag}"
        if name == "type":
            known = {"joint": "revolute2", "sensor": self._sensor, "noise": "gaussian"}
            return "force_torque" if tag == "sensor" and "joint" in around else known.get(tag, "1")
        return ATTRIBUTES.get(name, "1")


@pytest.mark.parametrize(
    ("shape", "sensor"),
    [
        *((it, "imu") for it in ("box", "sphere", "cylinder", "cone", *SHAPES)),
        *(("box", it) for it in SENSORS[1:]),
    ],
)
def test_nothing_of_the_format_is_unknown(tmp_path: Path, shape: str, sensor: str):
    writer = Writer(shape, sensor)
    file = tmp_path / "all.sdf"
    file.write_text(writer.text(writer.root))
    cursor = Cursor(SDF_RULES)
    scene = Document(1.0, AssetSearch(), cursor).read(file)
    unknown = {
        (it.element, it.attributes)
        for it in cursor.ignored()
        if it.reason.startswith(("no element", "no attr"))
    }
    assert not unknown
    (model,) = scene.models
    assert {it.name for robot in model.robots for it in robot.robot.joints} >= {"its joint"}


def test_what_is_not_in_the_format_is_unknown(tmp_path: Path):
    file = tmp_path / "m.sdf"
    file.write_text('<sdf><model name="m"><link name="a"><wings/></link></model></sdf>')
    cursor = Cursor(SDF_RULES)
    Document(1.0, AssetSearch(), cursor).read(file)
    assert [(it.element, it.consequence) for it in cursor.ignored()] == [("link/wings", "it has no effect")]
