"""Shapes of robots as geoms and meshes of descriptions."""

from __future__ import annotations

import numpy as np

from carom.description import (
    Collision,
    ContactParameters,
    ConvexHull,
    Geometry,
    Heightfield,
    Link,
    Mesh,
    Pose,
    TriangleMesh,
    Visual,
)
from carom.description.transform import compose
from carom.editing.elements import new, place, section, words
from carom.editing.losses import Losses
from carom.files.xml_element import Element
from carom.meshes.reader import read_mesh

_MESHES_OF_MUJOCO = (".obj", ".stl", ".msh")
_TURNS = (0.005, 0.0001)
"""Torsional and rolling friction of MJCF where nothing is stated [m]."""
_UNIT = (1.0, 1.0, 1.0)
# Sides of circles, where a round shape is written as a mesh.
_SEGMENTS = 24
_COLLIDES = {"group": "3"}
_IS_SEEN = {"contype": "0", "conaffinity": "0", "group": "2"}


class ShapeWriter:
    """Writes geoms without mass, and the meshes that they need, into a description."""

    def __init__(self, root: Element, losses: Losses) -> None:
        self.root = root
        self.losses = losses
        self._meshes: dict[tuple[object, ...], str] = {}
        self._names: set[str] = set()

    def geoms(self, link: Link) -> list[Element]:
        """The geoms of a link: those that collide, then those that are seen."""
        found: list[Element] = []
        for collision in link.collisions:
            if (geom := self._geom(collision)) is not None:
                contact = collision.contact or link.contact
                geom.attributes |= self._friction(contact) | _COLLIDES
                if contact.surface_motion is not None:
                    self._surface_motion(geom, contact.surface_motion)
                self._bits(collision, geom)
                found.append(geom)
        for visual in link.visuals:
            if not visual.stands_in and (geom := self._geom(visual)) is not None:
                geom.attributes |= _IS_SEEN
                self._look(visual, geom)
                found.append(geom)
        return found

    @staticmethod
    def _friction(contact: ContactParameters) -> dict[str, str]:
        stated = (contact.lateral_friction, contact.spinning_friction, contact.rolling_friction)
        if stated == (None, None, None):
            return {}
        sliding, spinning, rolling = stated
        found = {
            "friction": words(
                (
                    1.0 if sliding is None else sliding,
                    spinning or _TURNS[0],
                    rolling or _TURNS[1],
                )
            )
        }
        if contact.friction_dimensions:
            found["condim"] = str(contact.friction_dimensions)
        elif rolling or spinning:
            found["condim"] = "6" if rolling else "4"
        return found

    def _surface_motion(self, geom: Element, motion: tuple[float, ...]) -> None:
        if geom.attributes["type"] == "mesh":
            self.losses.add(
                "collision/contact",
                "the surface does not move",
                "MJCF states that along the principal axes of a mesh",
                "surface_motion",
            )
        else:
            geom.attributes["surfacevel"] = words(motion)

    def _bits(self, collision: Collision, geom: Element) -> None:
        if collision.group is not None or collision.mask is not None:
            group, mask = (
                0x7FFFFFFF if bits is None or bits < 0 else bits for bits in (collision.group, collision.mask)
            )
            geom.attributes |= {"contype": str(group), "conaffinity": str(mask)}
            self.losses.add(
                "collision",
                "it also collides with what either of both lets it",
                "MuJoCo needs one of both masks, Bullet both",
                "group",
                "mask",
            )

    def _look(self, visual: Visual, geom: Element) -> None:
        material = visual.material
        if visual.user_data:
            self.losses.add("visual", "none: a note", "it is for scripts", "user_data")
        if material is None:
            return
        if material.rgba is not None:
            geom.attributes["rgba"] = words(material.rgba)
        if material.texture is not None:
            self.losses.add(
                "visual/material", "none for the dynamics: no texture", "colours are kept", "texture"
            )
        if material.specular is not None:
            self.losses.add("visual/material", "none for the dynamics", "colours are kept", "specular")

    def _geom(self, shape: Collision | Visual) -> Element | None:
        """A geom without mass; None for a shape that MJCF has not, which is reported."""
        geom = new("geom")
        if shape.name and shape.name not in self._names:
            self._names.add(shape.name)
            geom.attributes["name"] = shape.name
        pose = shape.frame
        match shape.geometry:
            case Mesh() | TriangleMesh() | ConvexHull():
                stated = {"type": "mesh", "mesh": self._mesh(shape.geometry, shape)}
            case _ if shape.geometry.mjcf:
                stated = {"type": shape.geometry.mjcf, "size": words(shape.geometry.sizes())}
                if shape.geometry.is_unbounded:
                    pose = compose(pose, Pose(orientation=shape.geometry.own_turn()))
            case _ if shape.geometry.facets() is not None:
                self.losses.add(
                    "shape", "its facets collide, by their hull", "MJCF has no such shape", "geometry"
                )
                surface = shape.geometry.surface(_SEGMENTS)
                mesh = TriangleMesh(surface.positions.astype(np.float64), surface.triangles.astype(np.int32))
                stated = {"type": mesh.mjcf, "mesh": self._mesh(mesh, shape)}
            case _:
                kind = type(shape.geometry).__name__
                has = (
                    "they are relative to a file"
                    if isinstance(shape.geometry, Heightfield)
                    else "no such shape"
                )
                self.losses.add("shape", f"there is no {kind}", f"MJCF: {has}", "geometry")
                return None
        sizes = [float(size) for size in stated.get("size", "1").split()]
        if not shape.geometry.is_unbounded and not all(size > 0.0 for size in sizes):
            self.losses.add("shape", "it is missing", "MJCF has no shapes of size 0", "size")
            return None
        geom.attributes |= stated
        geom.attributes["mass"] = "0"
        place(geom, pose)
        return geom

    def _mesh(self, geometry: Geometry, shape: Collision | Visual) -> str:
        """The name of the asset of a mesh."""
        if isinstance(geometry, Mesh):
            key: tuple[object, ...] = (geometry.path, geometry.scale)
            stem = geometry.path.stem
        else:
            key, stem = (id(geometry),), "mesh"
        if isinstance(shape, Collision):
            self._hull_note(geometry)
        if key in self._meshes:
            return self._meshes[key]
        number, name = 1, stem
        while name in self._meshes.values():
            number += 1
            name = f"{stem}_{number}"
        self._meshes[key] = name
        # Their bodies state masses, so it need not be a closed surface.
        asset = new("mesh", None, {"name": name, "inertia": "shell"})
        match geometry:
            case Mesh(path, scale):
                if path.suffix.lower() in _MESHES_OF_MUJOCO:
                    asset.attributes["file"] = str(path.absolute())
                else:
                    parts = read_mesh(path)
                    starts = np.cumsum([0, *(len(part.vertices) for part in parts)])
                    _state(
                        asset,
                        np.concatenate([part.vertices for part in parts]),
                        np.concatenate([p.triangles + s for p, s in zip(parts, starts, strict=False)]),
                    )
                if scale != _UNIT:
                    asset.attributes["scale"] = words(scale)
            case TriangleMesh(vertices, triangles):
                _state(asset, vertices, triangles)
            case ConvexHull(points):
                asset.attributes["vertex"] = words(np.asarray(points).reshape(-1))
            case _:
                raise AssertionError(geometry)
        section(self.root, "asset").children.append(asset)
        return name

    def _hull_note(self, geometry: Geometry) -> None:
        if isinstance(geometry, TriangleMesh) or (isinstance(geometry, Mesh) and geometry.concave):
            self.losses.add(
                "collision", "its convex hull collides, not its triangles", "so are meshes of MJCF", "concave"
            )
        elif isinstance(geometry, Mesh) and len(read_mesh(geometry.path)) > 1:
            self.losses.add(
                "collision", "the hull of all its parts collides, not that of each", "so are meshes of MJCF"
            )


def _state(asset: Element, vertices: np.ndarray, triangles: np.ndarray) -> None:
    asset.attributes["vertex"] = words(np.asarray(vertices).reshape(-1).tolist())
    asset.attributes["face"] = " ".join(map(str, np.asarray(triangles).reshape(-1).tolist()))
