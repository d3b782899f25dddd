"""What is loaded for the comparison with PyBullet. Uses the standard library only: both sides import it."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

DATA = Path(__file__).with_name("data")

INERTIA_FROM_FILE = 2
IMPLICIT_CYLINDER = 128
MAINTAIN_LINK_ORDER = 131072
MERGE_FIXED_LINKS = 524288
IGNORE_VISUAL_SHAPES = 1048576
IGNORE_COLLISION_SHAPES = 2097152


@dataclass(frozen=True)
class LoadCase:
    """One call of loadURDF."""

    file: str
    flags: int = 0
    scale: float = 1.0
    fixed_base: bool = False

    @property
    def name(self) -> str:
        return f"{self.file} flags={self.flags} scale={self.scale} fixed={self.fixed_base}"


CASES = [
    *(
        LoadCase(file)
        for file in ("joints.urdf", "tensors.urdf", "shapes.urdf", "contact.urdf", "sloppy.urdf")
    ),
    LoadCase("joints.urdf", scale=2.5),
    LoadCase("joints.urdf", fixed_base=True),
    LoadCase("joints.urdf", INERTIA_FROM_FILE, fixed_base=True),
    LoadCase("tensors.urdf", INERTIA_FROM_FILE),
    LoadCase("tensors.urdf", INERTIA_FROM_FILE, scale=0.5),
    LoadCase("tensors.urdf", INERTIA_FROM_FILE, fixed_base=True),
    LoadCase("shapes.urdf", IMPLICIT_CYLINDER),
    LoadCase("shapes.urdf", IGNORE_COLLISION_SHAPES | IGNORE_VISUAL_SHAPES),
    LoadCase("shapes.urdf", scale=0.3),
    LoadCase("contact.urdf", INERTIA_FROM_FILE),
    LoadCase("order.urdf"),
    LoadCase("order.urdf", MAINTAIN_LINK_ORDER),
    LoadCase("fixed_links.urdf"),
    LoadCase("fixed_links.urdf", MERGE_FIXED_LINKS),
    LoadCase("fixed_links.urdf", MERGE_FIXED_LINKS | INERTIA_FROM_FILE),
    LoadCase("fixed_links.urdf", MERGE_FIXED_LINKS | MAINTAIN_LINK_ORDER),
    LoadCase("fixed_links.urdf", MERGE_FIXED_LINKS, fixed_base=True),
    LoadCase("sloppy.urdf", MERGE_FIXED_LINKS | INERTIA_FROM_FILE, scale=3.0),
]

_A = '<link name="a"/>'
_B = '<link name="b"/>'


def robot(*parts: str) -> str:
    return "<robot name='r'>\n" + "\n".join(parts) + "\n</robot>"


def joint(inside: str = "", kind: str = "continuous", child: str = "b") -> str:
    return f'<joint name="j" type="{kind}"><parent link="a"/><child link="{child}"/>{inside}</joint>'


def collision(shape: str) -> str:
    return f'<link name="a"><collision><geometry>{shape}</geometry></collision></link>'


# Broken files, by what is wrong with them. PyBullet refuses every one.
REFUSED = {
    "empty": "",
    "no robot": "<sdf/>",
    "no robot name": f"<robot>{_A}</robot>",
    "no links": robot(),
    "link without name": robot("<link/>"),
    "duplicate link": robot(_A, _A),
    "duplicate joint": robot(_A, _B, '<link name="c"/>', joint(), joint(child="c")),
    "duplicate attribute": robot('<link name="a" name="b"/>'),
    "unclosed link": robot('<link name="a">'),
    "mismatched end tag": robot('<link name="a"></joint>'),
    "cut off": robot(_A)[:-3],
    "cut off in attribute": robot('<link name="a'),
    "attribute without quotes": robot("<link name=a/>"),
    "text after the end": robot(_A) + " more",
    "late declaration": f'<!-- first -->\n<?xml version="1.0"?>{robot(_A)}',
    "too deep": robot(_A, "<x>" * 120 + "</x>" * 120),
    "loop": robot(
        _A,
        _B,
        joint(),
        joint(child="b")
        .replace('"j"', '"k"')
        .replace('link="a"', 'link="b"')
        .replace('child link="b"', 'child link="a"'),
    ),
    "unknown child": robot(_A, joint(child="z")),
    "unknown parent": robot(_B, joint()),
    "joint without child": robot(_A, _B, '<joint name="j" type="fixed"><parent link="a"/></joint>'),
    "joint without type": robot(_A, _B, '<joint name="j"><parent link="a"/><child link="b"/></joint>'),
    "unknown joint type": robot(_A, _B, joint(kind="screw")),
    "revolute without limit": robot(_A, _B, joint(kind="revolute")),
    "prismatic without limit": robot(_A, _B, joint(kind="prismatic")),
    "short axis": robot(_A, _B, joint('<axis xyz="0 1"/>')),
    "empty dynamics": robot(_A, _B, joint("<dynamics/>")),
    "inertial without mass": robot(
        '<link name="a"><inertial><inertia ixx="1" iyy="1" izz="1"/></inertial></link>'
    ),
    "inertial without inertia": robot('<link name="a"><inertial><mass value="1"/></inertial></link>'),
    "inertia without izz": robot(
        '<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1"/></inertial></link>'
    ),
    "mass without value": robot(
        '<link name="a"><inertial><mass/><inertia ixx="1" iyy="1" izz="1"/></inertial></link>'
    ),
    "contact without value": robot('<link name="a"><contact><lateral_friction/></contact></link>'),
    "collision without geometry": robot('<link name="a"><collision/></link>'),
    "geometry without shape": robot(collision("")),
    "unknown shape": robot(collision('<cone radius="1"/>')),
    "sphere without radius": robot(collision("<sphere/>")),
    "box without size": robot(collision("<box/>")),
    "cylinder without length": robot(collision('<cylinder radius="1"/>')),
    "capsule without radius": robot(collision('<capsule length="1"/>')),
    "plane without normal": robot(collision("<plane/>")),
    "mesh without file name": robot(collision("<mesh/>")),
    "missing mesh": robot(collision('<mesh filename="nowhere.obj"/>')),
    "unknown mesh kind": robot(collision('<mesh filename="mesh.xyz"/>')),
    "visual material without name": robot(
        '<link name="a"><visual><geometry><sphere radius="1"/></geometry><material/></visual></link>'
    ),
}


def _limits(**changes: str | None) -> str:
    limit: dict[str, str | None] = {"lower": "-1", "upper": "1", "effort": "5", "velocity": "2"}
    limit |= changes
    stated = " ".join(f'{name}="{text}"' for name, text in limit.items() if text is not None)
    return robot(_A, _B, joint(f"<limit {stated}/>", kind="revolute"))


_TEXTS = (
    *("-inf", "inf", "+Infinity", "-INFINITY", "infinite", "1e400", "-1e400", "1e308", "1e31", "1e-400"),
    *("", "pi", "--1", "${limit}", "e5", ".", "0x", "0x10", "-0x1p3", "0x.8", "0x1p9999", "-0x1p9999"),
    *(" 1 ", "1.0 2.0", "1,5", "+1", ".5", "5.", "1e", "1e+", "5abc", "1d3", "1_0"),
)
# Files with limits that are none, or no plain numbers, by what is unusual about them.
LIMITS = {
    f"{name}={text!r}": _limits(**{name: text})
    for name in ("lower", "upper", "effort", "velocity")
    for text in (None, *_TEXTS)
}
