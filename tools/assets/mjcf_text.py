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
        touch: Groups it is in, and those it touches, where they are not those of the model.
    """

    type: Literal["box", "capsule", "sphere", "cylinder", "plane"]
    size: tuple[float, ...]
    name: str = ""
    pos: Vector3 = ZERO
    ends: tuple[Vector3, Vector3] | None = None
    turn: tuple[Vector3, float] | None = None
    rgba: tuple[float, float, float, float] | None = None
    touch: tuple[int, int] | None = None


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
        name: May be empty: PyBullet then numbers its link.
        free: Name of the joint that lets it fly, if it has one; the name may be empty.
        held: Name of the joint that holds it in the world, if it has one.
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
    held: str | None = None


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
    touch = "" if model.touch == (1, 1) else _touch(model.touch)
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
    opening = f'<mujoco model="{model.name}">' if model.name else "<mujoco>"
    return "\n".join([about, opening, *_deeper(body), "</mujoco>", ""])


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(f"{value:.10g}" for value in values)


def _deeper(lines: list[str]) -> list[str]:
    return [INDENT + line for line in lines]


def _item(item: Body | Geom) -> list[str]:
    return [_geom(item)] if isinstance(item, Geom) else _body(item)


def _body(body: Body) -> list[str]:
    opening = "<body" + _name(body.name) + _vector("pos", body.pos)
    if body.quat is not None:
        opening += f' quat="{_numbers(body.quat)}"'
    roots = ((body.free, "free"), (body.held, "fixed"))
    inside = [
        f'<joint{_name(name)} type="{kind}" limited="false"/>' for name, kind in roots if name is not None
    ]
    if body.mass is not None:
        inside.append(f'<inertial pos="0 0 0" mass="{body.mass:g}"/>')
    inside += [_joint(joint) for joint in body.joints]
    inside += [_geom(geom) for geom in body.geoms]
    inside += [line for child in body.bodies for line in _body(child)]
    return [opening + ">", *_deeper(inside), "</body>"]


def _name(name: str) -> str:
    return f' name="{name}"' if name else ""


def _touch(touch: tuple[int, int]) -> str:
    return f' contype="{touch[0]}" conaffinity="{touch[1]}"'


def _vector(name: str, value: Vector3) -> str:
    return "" if value == ZERO else f' {name}="{_numbers(value)}"'


def _joint(joint: Hinge) -> str:
    kind = "slide" if joint.slides else "hinge"
    reach = 'limited="false"' if joint.reach is None else f'limited="true" range="{_numbers(joint.reach)}"'
    place = _vector("pos", joint.pos)
    return f'<joint name="{joint.name}" type="{kind}" axis="{_numbers(joint.axis)}"{place} {reach}/>'


def _geom(geom: Geom) -> str:
    text = "<geom" + _name(geom.name) + f' type="{geom.type}"'
    text += f' size="{_numbers(geom.size)}"' + _vector("pos", geom.pos)
    if geom.ends is not None:
        text += f' fromto="{_numbers(geom.ends[0] + geom.ends[1])}"'
    if geom.turn is not None:
        axis, angle = geom.turn
        text += f' axisangle="{_numbers(axis)} {angle:.13g}"'
    if geom.rgba is not None:
        text += f' rgba="{_numbers(geom.rgba)}"'
    if geom.touch is not None:
        text += _touch(geom.touch)
    return text + "/>"
