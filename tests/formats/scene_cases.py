"""Scenes that are loaded for the comparison with PyBullet, and what is asked about them: runs with either."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from recording import plain

DATA = Path(__file__).with_name("data")


@dataclass(frozen=True)
class SceneCase:
    """One call of a loader of scenes.

    Attributes:
        loader: Name of PyBullet's function.
        file: The file, in the folder of test data.
        options: Further arguments.
        shapes: Whether it is also asked where collision shapes are.
    """

    loader: str
    file: str
    options: dict[str, Any] = field(default_factory=dict)
    shapes: bool = False

    @property
    def name(self) -> str:
        return f"{self.file} {self.options}"


CASES = [
    SceneCase("loadSDF", "sdf/world.sdf"),
    SceneCase("loadSDF", "sdf/world.sdf", {"globalScaling": 2.5}),
    SceneCase("loadSDF", "sdf/arm.sdf"),
    SceneCase("loadSDF", "sdf/arm.sdf", {"globalScaling": 0.5}),
    SceneCase("loadSDF", "sdf/sloppy.sdf"),
    SceneCase("loadMJCF", "mjcf/walker.xml"),
    SceneCase("loadMJCF", "mjcf/walker.xml", {"flags": 512}),
    SceneCase("loadMJCF", "mjcf/walker.xml", {"flags": 128}),
    SceneCase("loadMJCF", "mjcf/walker.xml", {"flags": 2}),
    SceneCase("loadMJCF", "mjcf/walker.xml", {"flags": 131072}),
    SceneCase("loadMJCF", "mjcf/scene.xml"),
    SceneCase("loadMJCF", "mjcf/scene.xml", {"flags": 2}),
    SceneCase("loadMJCF", "mjcf/no_compiler.xml"),
    SceneCase("loadMJCF", "mjcf/turned.xml"),
    # PyBullet ends when asked where hulls of two balls are, which capsules are without this flag.
    SceneCase("loadMJCF", "mjcf/hanging.xml", {"flags": 128}, shapes=True),
]


def ask(p: Any, case: SceneCase, client: int) -> list[dict[str, Any]]:
    """What the getters say about the bodies of a scene, in an empty world, which is emptied again."""
    bodies = getattr(p, case.loader)(str(DATA / case.file), physicsClientId=client, **case.options)
    answers = []
    for body in bodies:
        count = p.getNumJoints(body, physicsClientId=client)
        answers.append(
            {
                "id": body,
                "names": plain(p.getBodyInfo(body, physicsClientId=client)),
                "pose": plain(p.getBasePositionAndOrientation(body, physicsClientId=client)),
                "joints": [
                    plain(p.getJointInfo(body, index, physicsClientId=client)) for index in range(count)
                ],
                # The last two fields, body type and margin, do not come from the file.
                "dynamics": [
                    plain(p.getDynamicsInfo(body, index, physicsClientId=client)[:10])
                    for index in range(-1, count)
                ],
                "links": [
                    plain(p.getLinkState(body, index, physicsClientId=client)) for index in range(count)
                ],
            }
        )
        if case.shapes:
            answers[-1]["shapes"] = [
                plain(p.getCollisionShapeData(body, index, physicsClientId=client))
                for index in range(-1, count)
            ]
    p.resetSimulation(physicsClientId=client)
    return answers


_LINK = (
    '<link name="{0}"><pose>{1}</pose><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz>'
    "</inertia></inertial></link>"
)
_A, _B = _LINK.format("a", "0 0 1 0 0 0"), _LINK.format("b", "0 0 2 0 0 0")


def sdf(*parts: str) -> str:
    return "<sdf version='1.6'><model name='m'>\n" + "\n".join(parts) + "\n</model></sdf>"


def sdf_joint(inside: str = "", kind: str = "continuous", parent: str = "a", child: str = "b") -> str:
    return f'<joint name="j" type="{kind}"><parent>{parent}</parent><child>{child}</child>{inside}</joint>'


def sdf_collision(shape: str) -> str:
    return f'<link name="a"><collision name="c"><geometry>{shape}</geometry></collision></link>'


# Broken files, by what is wrong with them. PyBullet refuses every one.
REFUSED_SDF = {
    "not sdf": "<robot name='r'/>",
    "cut off": sdf(_A)[:-4],
    "model without name": f"<sdf><model>{_A}</model></sdf>",
    "no links": sdf(),
    "link without name": sdf("<link/>"),
    "duplicate link": sdf(_A, _A),
    "duplicate joint": sdf(_A, _B, _LINK.format("c", "0 0 3 0 0 0"), sdf_joint(), sdf_joint(child="c")),
    "unknown child": sdf(_A, sdf_joint(child="z")),
    "unknown parent": sdf(_A, sdf_joint(parent="z", child="a")),
    "joint without type": sdf(_A, _B, "<joint name='j'><parent>a</parent><child>b</child></joint>"),
    "joint without name": sdf(_A, _B, "<joint type='fixed'><parent>a</parent><child>b</child></joint>"),
    "unknown joint type": sdf(_A, _B, sdf_joint(kind="universal")),
    "revolute without limit": sdf(_A, _B, sdf_joint("<axis><xyz>0 0 1</xyz></axis>", "revolute")),
    "prismatic without limit": sdf(_A, _B, sdf_joint("<axis><xyz>0 0 1</xyz></axis>", "prismatic")),
    "short axis": sdf(_A, _B, sdf_joint("<axis><xyz>0 1</xyz></axis>")),
    "empty dynamics": sdf(_A, _B, sdf_joint("<axis><xyz>0 0 1</xyz><dynamics/></axis>")),
    "inertial without mass": sdf('<link name="a"><inertial/></link>'),
    "inertial without inertia": sdf('<link name="a"><inertial><mass>1</mass></inertial></link>'),
    "inertia without izz": sdf(
        '<link name="a"><inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy></inertia></inertial></link>'
    ),
    "collision without geometry": sdf('<link name="a"><collision name="c"/></link>'),
    "geometry without shape": sdf(sdf_collision("")),
    "unknown shape": sdf(sdf_collision("<empty/>")),
    "sphere without radius": sdf(sdf_collision("<sphere/>")),
    "box without size": sdf(sdf_collision("<box/>")),
    "plane without size": sdf(sdf_collision("<plane><normal>0 0 1</normal></plane>")),
    "mesh without uri": sdf(sdf_collision("<mesh/>")),
    "missing mesh": sdf(sdf_collision("<mesh><uri>nowhere.obj</uri></mesh>")),
}
