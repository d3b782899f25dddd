"""A robot of our tables as the text of a URDF file."""

from __future__ import annotations

from xml.sax.saxutils import quoteattr

from tools.assets.parts import (
    ONE,
    ZERO,
    Box,
    Capsule,
    Cylinder,
    Geometry,
    Inertial,
    Joint,
    Link,
    Mesh,
    Paint,
    Plane,
    Robot,
    Shape,
    Sphere,
    Vector3,
)

INDENT = "  "


def urdf_text(robot: Robot) -> str:
    """The whole file: links first, then joints, every colour spelled out where it first appears."""
    known: dict[str, Paint] = {}
    body = [line for link in robot.links for line in _link(link, known)]
    body += [line for joint in robot.joints for line in _joint(joint)]
    head = ['<?xml version="1.0"?>', f"<!-- {robot.about} Written by tools/assets of Carom; MIT licence. -->"]
    return "\n".join([*head, f"<robot name={quoteattr(robot.name)}>", *_deeper(body), "</robot>", ""])


def _number(value: float) -> str:
    return f"{value:.13g}"


def _numbers(values: tuple[float, ...]) -> str:
    return '"' + " ".join(_number(value) for value in values) + '"'


def _deeper(lines: list[str]) -> list[str]:
    return [INDENT + line for line in lines]


def _element(tag: str, children: list[str], attributes: str = "") -> list[str]:
    opening = f"{tag} {attributes}" if attributes else tag
    if not children:
        return [f"<{opening}/>"]
    return [f"<{opening}>", *_deeper(children), f"</{tag}>"]


def _origin(xyz: Vector3, rpy: Vector3) -> list[str]:
    if xyz == ZERO and rpy == ZERO:
        return []
    turned = f" rpy={_numbers(rpy)}" if rpy != ZERO else ""
    return [f"<origin xyz={_numbers(xyz)}{turned}/>"]


def _link(link: Link, known: dict[str, Paint]) -> list[str]:
    children: list[str] = []
    if link.contact:
        children += _element("contact", [_contact(tag, value) for tag, value in link.contact.items()])
    if link.inertial:
        children += _inertial(link.inertial)
    for shape in link.seen:
        children += _element("visual", _shape(shape) + _material(shape.paint, known))
    for shape in link.touching:
        children += _element("collision", _shape(shape), _filter(shape))
    return _element("link", children, f"name={quoteattr(link.name)}")


def _contact(tag: str, value: float | None) -> str:
    return f"<{tag}/>" if value is None else f'<{tag} value="{_number(value)}"/>'


def _inertial(inertial: Inertial) -> list[str]:
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    tensor = " ".join(
        f'{name}="{_number(value)}"' for name, value in zip(names, inertial.tensor, strict=True)
    )
    mass = f'<mass value="{_number(inertial.mass)}"/>'
    return _element("inertial", [*_origin(inertial.xyz, inertial.rpy), mass, f"<inertia {tensor}/>"])


def _filter(shape: Shape) -> str:
    pairs = (("group", shape.group), ("mask", shape.mask))
    return " ".join(f'{name}="{value}"' for name, value in pairs if value is not None)


def _shape(shape: Shape) -> list[str]:
    return [*_origin(shape.xyz, shape.rpy), f"<geometry>{_geometry(shape.geometry)}</geometry>"]


def _geometry(geometry: Geometry) -> str:
    match geometry:
        case Box(size):
            return f"<box size={_numbers(size)}/>"
        case Sphere(radius):
            return f'<sphere radius="{_number(radius)}"/>'
        case Cylinder(radius, length):
            return f'<cylinder radius="{_number(radius)}" length="{_number(length)}"/>'
        case Capsule(radius, length):
            return f'<capsule radius="{_number(radius)}" length="{_number(length)}"/>'
        case Plane(normal):
            return f"<plane normal={_numbers(normal)}/>"
        case Mesh(file, scale):
            scaled = f" scale={_numbers(scale)}" if scale != ONE else ""
            return f"<mesh filename={quoteattr(file)}{scaled}/>"


def _material(paint: Paint | None, known: dict[str, Paint]) -> list[str]:
    if paint is None:
        return []
    if known.setdefault(paint.name, paint) != paint:
        raise ValueError(f"two colours are called {paint.name!r}")
    shine = [f"<specular rgb={_numbers(paint.specular)}/>"] if paint.specular else []
    return _element(
        "material", [f"<color rgba={_numbers(paint.rgba)}/>", *shine], f"name={quoteattr(paint.name)}"
    )


def _joint(joint: Joint) -> list[str]:
    children = [
        f"<parent link={quoteattr(joint.parent)}/>",
        f"<child link={quoteattr(joint.child)}/>",
        *_origin(joint.xyz, joint.rpy),
    ]
    if joint.axis is not None:
        children.append(f"<axis xyz={_numbers(joint.axis)}/>")
    if joint.limit:
        bounds = " ".join(f'{name}="{_number(value)}"' for name, value in joint.limit.items())
        children.append(f"<limit {bounds}/>")
    dynamics = [
        f'{name}="{_number(value)}"'
        for name, value in (("damping", joint.damping), ("friction", joint.friction))
        if value is not None
    ]
    if dynamics:
        children.append(f"<dynamics {' '.join(dynamics)}/>")
    if joint.soft_limits:
        names = ("soft_lower_limit", "soft_upper_limit", "k_position", "k_velocity")
        soft = " ".join(f'{n}="{_number(v)}"' for n, v in zip(names, joint.soft_limits, strict=True))
        children.append(f"<safety_controller {soft}/>")
    if joint.mimic:
        children.append(f"<mimic joint={quoteattr(joint.mimic)}/>")
    return _element("joint", children, f"name={quoteattr(joint.name)} type={quoteattr(joint.type)}")
