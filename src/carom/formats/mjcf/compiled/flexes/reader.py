"""`<flexcomp>`: what it makes, as nodes, springs and tetrahedra."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.description.transform import rotation_matrix
from carom.errors import DescriptionError
from carom.files.budget import charge
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.flexes.flex import FileFlex
from carom.formats.mjcf.compiled.flexes.gmsh import read_gmsh
from carom.formats.mjcf.compiled.flexes.pins import read_pins
from carom.formats.mjcf.compiled.flexes.points import (
    circle_points,
    disc_points,
    grid_points,
    shell_points,
)
from carom.formats.mjcf.compiled.looks.material import read_material
from carom.formats.mjcf.compiled.softness import read_compliance
from carom.formats.robot.context import shown
from carom.meshes import read_mesh
from carom.native.products import product

Floats = NDArray[np.float64]
Ints = NDArray[np.int32]
_SHELLS = ("box", "cylinder", "ellipsoid")
_TYPES = ("grid", *_SHELLS, "disc", "circle", "mesh", "gmsh", "direct")
_LOST, _CABLE, _CLOTH, _SOLID = "it is missing", 1, 2, 3
_NETWORK_RATIO, _ROUNDING = 1.0 / 3.0, 1e-3
_YIELDS = ("gap", "margin", "passive", "priority", "solimp", "solmix", "solref")
_STRETCHES, _BENDS = ("stretch", "both"), ("bend", "both")


def read_flex(scope: Scope, element: Element, body: str) -> FileFlex | None:
    """The flex that a `<flexcomp>` in a body makes; None for kinds that are reported as left out.

    One that is rigid has all its nodes pinned.

    Raises `DescriptionError`.
    """
    context, attributes = scope.context, element.attributes
    element.note()
    freedom, kind = attributes.get("dof", "full"), attributes.get("type", "grid")
    if kind not in _TYPES:
        raise context.error(element, f"type={shown(kind)} must be one of {', '.join(_TYPES)}")
    if freedom != "full":
        context.leave_out_all(element, _LOST, f'only flexes with dof="full" are built, and not "{freedom}"')
        return None
    if attributes.get("mesh"):
        context.leave_out_all(element, _LOST, "flexes are made of files, and not of mesh assets")
        return None
    dimensions = int(context.number(element, attributes, "dim", 2.0))
    if not _CABLE <= dimensions <= _SOLID:
        raise context.error(element, f"dim={dimensions} must be 1, 2 or 3")
    if kind == "mesh" and dimensions == _CABLE:
        context.leave_out_all(element, _LOST, "cables of mesh files are not built")
        return None
    points, cells = _made(scope, element, kind, dimensions)
    pins = read_pins(context, element, kind, dimensions, len(points))
    points, cells, pins = _used(points, cells, pins)
    if context.flag(element, attributes, "rigid", False):
        pins = set(range(len(points)))
    pose = scope.pose(element, attributes)
    nodes = product(points, np.array(rotation_matrix(pose.orientation)).T) + np.array(pose.position)
    mass = context.number(element, attributes, "mass", 1.0)
    if mass <= 0.0:
        raise context.error(element, f"mass={mass} must be positive")
    radius = context.number(element, attributes, "radius", 0.005)
    flex = FileFlex(
        scope.name(element),
        body,
        nodes,
        cells,
        dict.fromkeys(sorted(pins), body),
        np.full(len(nodes), mass / len(nodes)),
        radius,
        material=read_material(context, element, attributes),
    )
    if len(pins) < len(points):
        tie(scope, element, flex)
        touch(scope, element, flex)
    return flex


def _made(scope: Scope, element: Element, kind: str, dimensions: int) -> tuple[Floats, Ints]:
    """Points, scaled but where the file has them, and cells."""
    context, attributes = scope.context, element.attributes
    if kind in ("direct", "mesh", "gmsh"):
        points, cells = _stated(scope, element, kind, dimensions)
        return points * context.numbers(element, "scale", attributes.get("scale", "1 1 1"), 3, 3), cells
    given = context.numbers(element, "count", attributes.get("count", "10 10 10"), 1, 3)
    counts = [max(int(count), 1) for count in (*given, 1, 1)[:3]]
    spacing = np.array(context.numbers(element, "spacing", attributes.get("spacing", "0.02 0.02 0.02"), 3, 3))
    needed = {"grid": dimensions, "circle": 1, "disc": 2}.get(kind, 3)
    least = 3 if kind in (*_SHELLS, "circle") else 2
    counts[needed:] = [1] * (3 - needed)
    if min(counts[:needed]) < least:
        raise context.error(element, f"count needs {least} or more points along each axis")
    if kind in ("disc", "circle") and dimensions != needed:
        raise context.error(element, f'type="{kind}" needs dim="{needed}"')
    if kind in _SHELLS and dimensions == _CABLE:
        raise context.error(element, f'type="{kind}" needs dim="2" or "3"')
    whole = (counts[0], counts[1], counts[2])
    charge("vertices", counts[0] * counts[1] * counts[2])
    if kind == "grid":
        return grid_points(whole, spacing, dimensions)
    if kind == "circle":
        return circle_points(counts[0], float(spacing[0]))
    if kind == "disc":
        return disc_points(whole, spacing)
    return shell_points(kind, whole, spacing, is_solid=dimensions == _SOLID)


def _stated(scope: Scope, element: Element, kind: str, dimensions: int) -> tuple[Floats, Ints]:
    """The points and cells that a file or the element itself lists."""
    context, attributes = scope.context, element.attributes
    if kind == "direct":
        points = np.array(context.singles(element, "point", context.required(element, "point")))
        cells = np.array(context.singles(element, "element", context.required(element, "element")))
        if len(points) % 3 or len(cells) % (dimensions + 1) or not len(cells):
            raise context.error(
                element,
                f"point needs 3 numbers for each point, and element {dimensions + 1} for each element",
            )
        points = points.reshape(-1, 3)
    else:
        name = context.required(element, "file")
        path = context.asset_file(element, name, context.compiler.mesh_directory)
        if path is None:
            raise context.not_found(element, name)
        points, cells = read_gmsh(path) if kind == "gmsh" else _surface(path)
        if kind == "mesh" and dimensions == _SOLID:
            if "origin" not in attributes:
                raise context.error(element, 'a solid of type="mesh" needs an origin')
            origin = context.numbers(element, "origin", attributes["origin"], 3, 3)
            middle = np.full((len(cells), 1), len(points), np.int32)
            points = np.concatenate([points, np.array([origin])])
            cells = np.concatenate([cells, middle], axis=1)
    if not 0 <= cells.min() <= cells.max() < len(points):
        raise context.error(element, f"an element names a point that is not there; there are {len(points)}")
    width = cells.shape[1] if cells.ndim == 2 else dimensions + 1
    return points, cells.reshape(-1, width).astype(np.int32)


def _surface(path: Path) -> tuple[Floats, Ints]:
    parts = read_mesh(path, by_ears=True)
    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
    triangles = [part.triangles + start for part, start in zip(parts, starts, strict=False)]
    if not sum(map(len, triangles)):
        raise DescriptionError("it has no triangles", file=path)
    return np.concatenate([part.vertices for part in parts]), np.concatenate(triangles).astype(np.int32)


def _used(points: Floats, cells: Ints, pins: set[int]) -> tuple[Floats, Ints, set[int]]:
    """Without the points of no cell, of which MuJoCo makes nothing."""
    used, numbers = np.unique(cells, return_inverse=True)
    if len(used) == len(points):
        return points, cells, pins
    places = {number: place for place, number in enumerate(used.tolist())}
    kept = {places[pin] for pin in pins if pin in places}
    return points[used], numbers.reshape(cells.shape).astype(np.int32), kept


def tie(scope: Scope, element: Element, flex: FileFlex) -> None:
    """Give a flex what its `<edge>` and `<elasticity>` mean."""
    context = scope.context
    dimensions = flex.cells.shape[1] - 1
    edge = element.first("edge")
    if edge is not None:
        stated = edge.attributes
        if dimensions == _CABLE:
            flex.edge_stiffness = context.number(edge, stated, "stiffness", 0.0)
        flex.edge_damping = context.number(edge, stated, "damping", 0.0)
        holds = stated.get("equality", "false")
        compliance = read_compliance(scope, edge, stated)
        if holds in ("true", "vert"):
            flex.edges = compliance
        if holds not in ("false", "true"):
            consequence = {
                "vert": "each edge holds by itself, instead of the mean of those at a node",
                "strain": "nothing holds its strain",
            }.get(holds)
            if consequence is None:
                raise context.error(edge, f"equality={shown(holds)} must be true, false, vert or strain")
            context.leave_out(edge, consequence, "constraints of strains and nodes are not built", "equality")
    elasticity = element.first("elasticity")
    if elasticity is not None:
        _resist(scope, elasticity, flex)


def _resist(scope: Scope, element: Element, flex: FileFlex) -> None:
    context, stated = scope.context, element.attributes
    dimensions = flex.cells.shape[1] - 1
    young = context.number(element, stated, "young", 0.0)
    poisson = context.number(element, stated, "poisson", 0.0)
    damping = context.number(element, stated, "damping", 0.0)
    if young < 0.0 or not 0.0 <= poisson < 0.5:
        raise context.error(element, "young has to be 0 or more, and poisson from 0 to less than 0.5")
    if dimensions == _SOLID:
        flex.young, flex.poisson, flex.damping = young, poisson, damping
    elif dimensions == _CABLE and young:
        context.leave_out(element, "it does not resist as a rod does", "rods are not built", "young")
    elif dimensions == _CLOTH:
        way = stated.get("elastic2d", "none")
        thickness = context.number(element, stated, "thickness", -1.0)
        if way in _STRETCHES and young and thickness > 0.0:
            flex.young, flex.damping = young * thickness, damping
            if abs(poisson - _NETWORK_RATIO) > _ROUNDING:
                context.leave_out(
                    element, "Poisson's ratio of the cloth is 1/3", "it is a sheet of springs", "poisson"
                )
        if way in _BENDS and young:
            context.leave_out(
                element, "it does not resist bending", "stiffness of cloth against bending is not built",
                "elastic2d",
            )  # fmt: skip


def touch(scope: Scope, element: Element, flex: FileFlex) -> None:
    """Give a flex what its `<contact>` means."""
    contact = element.first("contact")
    stated = {} if contact is None else contact.attributes
    context, of = scope.context, element if contact is None else contact
    types = [int(context.number(of, stated, name, 1.0)) for name in ("contype", "conaffinity")]
    flex.collides = any(types)
    if flex.collides and types != [1, 1]:
        context.leave_out(
            of, "it collides with all that collides", "flexes have no groups", "contype", "conaffinity"
        )
    if context.flag(of, stated, "internal", False):
        context.leave_out(of, "elements may turn over", "collisions within are not built", "internal")
    yields = [name for name in _YIELDS if stated.get(name) is not None]
    if yields:
        context.leave_out(of, "its contacts do not yield", "contacts of soft bodies are firm", *yields)
    sliding = [*context.singles(of, "friction", stated.get("friction", "")), 1.0][0]
    flex.friction = sliding if context.number(of, stated, "condim", 3.0) > 1.0 else 0.0
    meets_itself = bool(types[0] & types[1]) and stated.get("selfcollide", "auto") != "none"
    flex.self_collision = meets_itself and flex.cells.shape[1] > _CABLE + 1
    if meets_itself and not flex.self_collision:
        context.leave_out(of, "it does not collide with itself", "cables have no faces")
