"""`<flex>` in `<deformable>`: vertices on bodies that are listed, and the elements between them.

A body that slides along three axes is a node; any other body holds its vertices. Where one body has all of
them, the flex is part of its shape.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from carom.description.pose import Pose
from carom.description.transform import compose
from carom.files.budget import charge
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.body import BodyReader
from carom.formats.mjcf.compiled.deformables.nodes import NodeBodies
from carom.formats.mjcf.compiled.elements import WORLD, Scope
from carom.formats.mjcf.compiled.flexes.flex import FileFlex
from carom.formats.mjcf.compiled.flexes.reader import tie, touch
from carom.formats.mjcf.compiled.flexes.rigid import add_rigid_flex
from carom.formats.mjcf.compiled.looks.material import read_material
from carom.formats.mjcf.compiled.model import CompiledBody, world_poses
from carom.formats.mjcf.compiled.names import full
from carom.formats.robot.context import shown

Ints = NDArray[np.int32]
_LOST = "it is missing"
_CABLE, _CLOTH, _SOLID = 1, 2, 3
_RADIUS = 0.005


@dataclass(frozen=True, slots=True)
class _Stated:
    """What a `<flex>` lists.

    Attributes:
        bodies: Name of the body of each vertex.
        places: World positions of the vertices where the file has the bodies [m].
        local: Their positions in their bodies [m].
        cells: (m, dim + 1) elements.
    """

    bodies: list[str]
    places: list[Pose]
    local: list[Pose]
    cells: Ints


class FlexSection:
    """Reads the flexes of a file, whose bodies have just been read, and of all that it attaches.

    Args:
        reader: The reading of the bodies; those that are nodes are taken out of it.
        world: The world.
    """

    def __init__(self, reader: BodyReader, world: CompiledBody) -> None:
        self._reader = reader
        self._bodies = {WORLD: world, **{body.name: body for body in reader.bodies}}
        self._poses: Mapping[str, Pose] = world_poses(world)
        self._nodes = NodeBodies(reader, world)

    def read(self, scope: Scope) -> None:
        """Read all flexes; raises `DescriptionError`."""
        for each in (scope, *self._reader.elements.attached):
            for section in each.context.root.all("deformable"):
                for element in section.all("flex"):
                    self._read(each, element, is_main=each is scope)

    @property
    def nodes(self) -> list[CompiledBody]:
        """The bodies that have become nodes."""
        return list(self._nodes.taken.values())

    def weigh(self) -> None:
        """Give nodes the masses of their bodies, which are known; raises `DescriptionError`."""
        for flex in self._reader.model.flexes:
            for node, name in flex.bodies.items():
                body = self._nodes.taken[name]
                if body.inertia.mass <= 0.0:
                    raise self._nodes.scope.context.error(body.element, "a body that moves needs a mass")
                flex.masses[node] = body.inertia.mass
            if flex.bodies and flex.pins:
                # Those that are held weigh nothing; a node needs some mass.
                flex.masses[list(flex.pins)] = flex.masses[list(flex.bodies)].mean()

    def _read(self, scope: Scope, element: Element, *, is_main: bool) -> None:
        context, attributes = scope.context, element.attributes
        element.note()
        freedom = attributes.get("dof", "full")
        if freedom != "full" or attributes.get("node"):
            why = f'only flexes with dof="full" are built, and not "{freedom}"'
            context.leave_out_all(element, _LOST, why)
            return
        dimensions = int(context.number(element, attributes, "dim", float(_CLOTH)))
        if not _CABLE <= dimensions <= _SOLID:
            raise context.error(element, f"dim={dimensions} must be 1, 2 or 3")
        stated = self._stated(scope, element, dimensions, is_main=is_main)
        if stated is None:
            return
        name = scope.name(element) or f"flex{len(self._reader.model.flexes)}_{context.next_number()}"
        self._reader.name_flex(element, scope, name)
        radius = context.number(element, attributes, "radius", _RADIUS)
        if radius < 0.0:
            raise context.error(element, f"radius={radius} must not be negative")
        flex = FileFlex(
            name,
            WORLD,
            np.array([pose.position for pose in stated.places]),
            stated.cells,
            {},
            np.zeros(len(stated.places)),
            radius,
            material=read_material(context, element, attributes),
        )
        owners = set(stated.bodies)
        if len(owners) == 1:
            points = np.array([pose.position for pose in stated.local])
            add_rigid_flex(
                scope, element, flex, points, self._bodies[owners.pop()], self._reader.model.options
            )
            return
        self._nodes.scope = scope
        problem = self._nodes.problem(stated.bodies)
        if problem:
            context.leave_out_all(element, _LOST, problem)
            return
        for node, body in enumerate(stated.bodies):
            if self._nodes.is_node(body):
                flex.bodies[node] = body
                flex.turns[node] = self._poses[body]
            else:
                flex.pins[node] = body
        tie(scope, element, flex)
        touch(scope, element, flex)
        self._nodes.take(flex)
        self._reader.model.flexes.append(flex)

    def _stated(self, scope: Scope, element: Element, dimensions: int, *, is_main: bool) -> _Stated | None:
        """The vertices and elements of a flex; None if its bodies are not attached."""
        context = scope.context
        names = [full(scope, name) for name in context.required(element, "body").split()]
        unknown = next((name for name in names if name not in self._bodies), None)
        if unknown is not None and not is_main:
            return None
        if unknown is not None:
            raise context.error(element, f"there is no body {shown(unknown)}")
        numbers = context.singles(element, "vertex", element.attributes.get("vertex", ""))
        count = len(numbers) // 3 if numbers else len(names)
        if not names or len(numbers) % 3 or len(names) not in (1, count):
            raise context.error(
                element, "vertex needs 3 numbers for each vertex, and body one name, or one for each vertex"
            )
        charge("vertices", count)
        names *= count // len(names)
        rows = np.array(numbers or [0.0] * 3 * count).reshape(-1, 3).tolist()
        local = [Pose((x, y, z)) for x, y, z in rows]
        places = [compose(self._poses[name], pose) for name, pose in zip(names, local, strict=True)]
        cells = [int(it) for it in context.singles(element, "element", context.required(element, "element"))]
        width = dimensions + 1
        if not cells or len(cells) % width:
            raise context.error(
                element, f"element needs {width} numbers for each element of dim={dimensions}"
            )
        if not 0 <= min(cells) <= max(cells) < count:
            raise context.error(element, f"an element names a vertex that is not there; there are {count}")
        found = np.array(cells, np.int32).reshape(-1, width)
        ordered = np.sort(found, axis=1)
        if (ordered[:, 1:] == ordered[:, :-1]).any():
            raise context.error(element, "an element names a vertex twice")
        return _Stated(names, places, local, found)
