"""The words our tables of MJCF files are written in, and their text."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from tools.assets.parts import ZERO, Vector3

INDENT = "  "


@dataclass(frozen=True)
class Geom:
    """A shape; `size` is as in MJCF, `ends` are the centres of the round ends of a capsule or of the rims.

    Attributes:
        turn: Axis and angle [rad]; PyBullet takes it for radians whatever the model says.
    """

    type: Literal["capsule", "sphere", "cylinder", "plane"]
    size: tuple[float, ...]
    name: str = ""
    pos: Vector3 = ZERO
    ends: tuple[Vector3, Vector3] | None = None
    turn: tuple[Vector3, float] | None = None
    rgba: tuple[float, float, float, float] | None = None


@dataclass(frozen=True)
class Hinge:
    """A joint, a slide where `slides`; `reach` are its bounds [m, or the angles of the model]."""

    name: str
    axis: Vector3
    reach: tuple[float, float] | None = None
    pos: Vector3 = ZERO
    slides: bool = False


@dataclass(frozen=True)
class Body:
    """A body, its joints, its geoms and the bodies on it.

    Attributes:
        free: Name of the joint that lets it fly, if it has one.
        mass: Instead of what the volume of its geoms weighs [kg].
    """

    name: str
    pos: Vector3 = ZERO
    quat: tuple[float, float, float, float] | None = None
    joints: tuple[Hinge, ...] = ()
    geoms: tuple[Geom, ...] = ()
    bodies: tuple[Body, ...] = ()
    free: str | None = None
    mass: float | None = None


@dataclass(frozen=True)
class Model:
    """A file: what stands in the world, in its order.

    Attributes:
        angle: Unit of the bounds of joints.
        touch: The groups that shapes are in, and those they touch, as bits (contype and conaffinity).
    """

    name: str
    about: str
    world: tuple[Body | Geom, ...]
    friction: Vector3 = (1.0, 0.005, 0.0001)
    rgba: tuple[float, float, float, float] = (0.8, 0.6, 0.4, 1.0)
    angle: Literal["degree", "radian"] = "radian"
    touch: tuple[int, int] = (1, 1)


def mjcf_text(model: Model) -> str:
    """The whole file; colours and friction are defaults at its top."""
    friction, rgba = _numbers(model.friction), _numbers(model.rgba)
    group, mask = model.touch
    touch = "" if model.touch == (1, 1) else f' contype="{group}" conaffinity="{mask}"'
    world = [line for item in model.world for line in _item(item)]
    body = [
        f'<compiler angle="{model.angle}" coordinate="local" inertiafromgeom="true"/>',
        "<default>",
        f'{INDENT}<geom friction="{friction}" rgba="{rgba}"{touch}/>',
        "</default>",
        "<worldbody>",
        *_deeper(world),
        "</worldbody>",
    ]
    about = f"<!-- {model.about} Written by tools/assets of Carom; MIT licence. -->"
    return "\n".join([about, f'<mujoco model="{model.name}">', *_deeper(body), "</mujoco>", ""])


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(f"{value:.10g}" for value in values)


def _deeper(lines: list[str]) -> list[str]:
    return [INDENT + line for line in lines]


def _item(item: Body | Geom) -> list[str]:
    return [_geom(item)] if isinstance(item, Geom) else _body(item)


def _body(body: Body) -> list[str]:
    opening = f'<body name="{body.name}"' + _vector("pos", body.pos)
    if body.quat is not None:
        opening += f' quat="{_numbers(body.quat)}"'
    inside = [] if body.free is None else [f'<joint name="{body.free}" type="free" limited="false"/>']
    if body.mass is not None:
        inside.append(f'<inertial pos="0 0 0" mass="{body.mass:g}"/>')
    inside += [_joint(joint) for joint in body.joints]
    inside += [_geom(geom) for geom in body.geoms]
    inside += [line for child in body.bodies for line in _body(child)]
    return [opening + ">", *_deeper(inside), "</body>"]


def _vector(name: str, value: Vector3) -> str:
    return "" if value == ZERO else f' {name}="{_numbers(value)}"'


def _joint(joint: Hinge) -> str:
    kind = "slide" if joint.slides else "hinge"
    reach = 'limited="false"' if joint.reach is None else f'limited="true" range="{_numbers(joint.reach)}"'
    place = _vector("pos", joint.pos)
    return f'<joint name="{joint.name}" type="{kind}" axis="{_numbers(joint.axis)}"{place} {reach}/>'


def _geom(geom: Geom) -> str:
    text = "<geom" + (f' name="{geom.name}"' if geom.name else "") + f' type="{geom.type}"'
    text += f' size="{_numbers(geom.size)}"' + _vector("pos", geom.pos)
    if geom.ends is not None:
        text += f' fromto="{_numbers(geom.ends[0] + geom.ends[1])}"'
    if geom.turn is not None:
        axis, angle = geom.turn
        text += f' axisangle="{_numbers(axis)} {angle:.13g}"'
    if geom.rgba is not None:
        text += f' rgba="{_numbers(geom.rgba)}"'
    return text + "/>"
