"""Messages about the appearance of a body: meshes and textures, each sent once, and their instances."""

from __future__ import annotations

from collections.abc import Iterator
from colorsys import hsv_to_rgb
from dataclasses import dataclass, replace
from functools import cache
from math import cos, isfinite, pi
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.description import Geometry, Pose
from carom.description.link import Rgba
from carom.description.pose import Vector3
from carom.description.shapes.shape import Shape
from carom.description.transform import compose, inverse
from carom.formats.visuals.render_mesh import RenderMesh
from carom.model.body_spec import BASE
from carom.model.link_dynamics import enforced_limits
from carom.render.appearance import WINDOW_COLOURS, Appearance, ShapeLook
from carom.render.images import Texels
from carom.render.meshes import shape_mesh
from carom.render.primitives import primitive_mesh
from carom.render.sites import sites_by_link
from carom.render.skins import carrier_of, skin_mesh
from carom.render.soft_surfaces import surface_mesh
from carom.render.texture_files import texture_file
from carom.render.textures import NO_TEXTURE
from carom.scene.actuators.actuated_joint import control_range
from carom.scene.core.soft_core import SoftCore
from carom.scene.joint_constraints import moving_links
from carom.viewer.input.picking import follows_hand
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.protocol import to_page

if TYPE_CHECKING:
    from carom.description.site import SiteSpec
    from carom.scene.core.body_core import BodyCore

_MAX_TEXTURE_SIDE = 4096
# Patterns of so few bytes are sent as they are, and shown at once; others as files, which browsers decode.
_SMALL_TEXTURE = 3072
# Each body id rotates the hue by the golden ratio [turns], so that neighbouring ids get different colours.
_HUE_STEP = 0.61803398875
_FIRST_HUE = 0.57
# Links of a body differ in brightness.
_SHADES = (0.80, 0.66, 0.90, 0.73)
_SATURATION = 0.5
_FLOOR = (0.82, 0.84, 0.86, 1.0)
# Shapes larger than this count as floors [m].
_FLOOR_SIZE = 9.0
_NO_SCALE: Vector3 = (1.0, 1.0, 1.0)
# Sides of the polygons for circles, by level of detail.
_SEGMENTS = (48, 24, 12)
# Maximum error of a round shape's outline, too small to be visible [pixels].
_OUTLINE_ERROR = 0.35


@dataclass(frozen=True, slots=True)
class Level:
    """A level of detail: a mesh, and the maximum size on the screen at which it is used.

    Attributes:
        mesh: The mesh.
        reach: Maximum radius on the screen at which the mesh looks round [pixels]; None for any radius.
    """

    mesh: RenderMesh
    reach: float | None = None


# Levels of detail, the finest first.
Levels = tuple[Level, ...]


@cache
def _levels(shape: Shape) -> Levels:
    """Those of a shape that is drawn in many sizes; one without circles has one level."""
    finest, *coarser = (primitive_mesh(shape, segments) for segments in _SEGMENTS)
    if all(len(mesh.positions) == len(finest.positions) for mesh in coarser):
        return (Level(finest),)
    reaches = (_OUTLINE_ERROR / (1.0 - cos(pi / segments)) for segments in _SEGMENTS[1:])
    return (Level(finest), *map(Level, coarser, reaches))


class Assets:
    """Meshes and textures on the pages, each sent once for any number of shapes."""

    def __init__(self, latest: LatestMessages) -> None:
        self._latest = latest
        self._meshes: dict[int, tuple[RenderMesh, int]] = {}
        self._textures: dict[int, tuple[Texels, int]] = {}
        self._next = 0

    def meshes(self, levels: Levels) -> list[tuple[int, float | None]]:
        """Numbers of the levels' meshes on the pages, and their maximum radii [pixels]."""
        return [(self._mesh(level.mesh), level.reach) for level in levels]

    def _mesh(self, mesh: RenderMesh) -> int:
        known = self._meshes.get(id(mesh))
        if known is not None:
            return known[1]
        number = self._number()
        self._meshes[id(mesh)] = (mesh, number)
        header = to_page.MESH(mesh=number, vertices=len(mesh.positions), triangles=len(mesh.triangles))
        payload = b"".join(
            np.ascontiguousarray(array, dtype=kind).tobytes()
            for array, kind in (
                (mesh.positions, "<f4"),
                (mesh.normals, "<f4"),
                (mesh.uvs, "<f4"),
                (mesh.triangles, "<u4"),
            )
        )
        self._latest.put(("mesh", number), header, payload)
        return number

    def texture(self, image: Texels) -> int:
        """Number of an image on the pages."""
        known = self._textures.get(id(image))
        if known is not None:
            return known[1]
        number = self._number()
        self._textures[id(image)] = (image, number)
        every = -(-max(image.shape[:2]) // _MAX_TEXTURE_SIDE)
        texels = image if every == 1 else image[::every, ::every]
        header = to_page.TEXTURE(texture=number, width=texels.shape[1], height=texels.shape[0])
        if texels.nbytes <= _SMALL_TEXTURE:
            # The bottom row comes first, as in texture coordinates.
            payload = np.ascontiguousarray(texels[::-1]).tobytes()
        else:
            header["file"], payload = texture_file(texels)
        self._latest.put(("texture", number), header, payload)
        return number

    def keep_only(self, meshes: set[int], textures: set[int]) -> None:
        """Removes meshes and textures that no shape uses; both sets hold numbers."""
        for gone, known, used in (
            (to_page.NO_MESH, self._meshes, meshes),
            (to_page.NO_TEXTURE, self._textures, textures),
        ):
            for identity, (_, number) in list(known.items()):
                if number not in used:
                    del known[identity]
                    self._latest.remove((gone.kept, number), gone(**{str(gone.kept): number}))

    def _number(self) -> int:
        self._next += 1
        return self._next


def described(
    body: BodyCore, appearance: Appearance, assets: Assets, *, collisions: bool, with_skins: bool = False
) -> dict[str, Any]:
    """Message that describes a body, without the poses of its links.

    A soft body has its present shape, and so have skins that its links carry, if it is with skins.
    """
    shapes = []
    if with_skins:
        for link, look in skins_on(body, appearance):
            shapes.append(_shape(look, link, inverse(body.link_inertial_frame(link)), appearance, assets))
    sites = sites_by_link(body) if body.spec.sites else {}
    for link in range(BASE, body.joint_count):
        to_inertial = inverse(body.link_inertial_frame(link))
        for look in appearance.shapes(body, link):
            seen = replace(look, mesh=surface_mesh(body)) if isinstance(body, SoftCore) else look
            if not look.coloured and look.texture == NO_TEXTURE:
                seen = replace(seen, rgba=_colour_in_turn(body, link))
            shapes.append(_shape(seen, link, to_inertial, appearance, assets))
        shapes.extend(
            {**_shape(look, link, to_inertial, appearance, assets), "site": True}
            for look in sites.get(link, ())
        )
        if collisions:
            shapes.extend(_collisions(body, link, to_inertial, assets))
    source = body.spec.source
    return to_page.BODY(
        body=body.id,
        name=body.name,
        file=None if source is None else source.name,
        path=None if source is None else "/".join(source.parts[-2:]),
        links=[
            {**_link(body, link), "moves": moves or follows_hand(body, link)}
            for link, moves in enumerate(moving_links(body), start=BASE)
        ],
        shapes=shapes,
        **_driven(body),
    )


def skins_on(body: BodyCore, appearance: Appearance) -> Iterator[tuple[int, ShapeLook]]:
    """The links of a body that carry skins, and the looks of these, with their present shapes."""
    for it in appearance.skins:
        carrier = carrier_of(body.world, it.skin)
        if carrier is not None and carrier[0] is body:
            yield carrier[1], replace(it.look, mesh=skin_mesh(body.world, it.skin, *carrier))


def _driven(body: BodyCore) -> dict[str, Any]:
    """Actuators, sensors and sites of a body, if it has any."""
    facts: dict[str, Any] = {}
    if body.spec.actuators:
        facts["actuators"] = [
            {"name": it.name, "range": control_range(body, it)} for it in body.spec.actuators
        ]
    if body.spec.sensors:
        facts["sensors"] = [
            {"name": it.name, "kind": it.kind.value, "size": it.dim} for it in body.spec.sensors
        ]
    if body.spec.sites:
        facts["sites"] = [_site(body, it) for it in body.spec.sites]
    return facts


def _site(body: BodyCore, site: SiteSpec) -> dict[str, Any]:
    frame = compose(inverse(body.link_inertial_frame(site.link)), site.pose)
    return {
        "name": site.name,
        "link": site.link - BASE,
        "position": frame.position,
        "orientation": frame.orientation,
    }


def _colour_in_turn(body: BodyCore, link: int) -> Rgba:
    """The colour that PyBullet's window gives to a link without visual shapes.

    Every link that is loaded takes the next of four colours, whether it needs one or not.
    The first is yellow.
    """
    return WINDOW_COLOURS[(body.links_before + link - BASE + 1) % len(WINDOW_COLOURS)]


def _link(body: BodyCore, link: int) -> dict[str, Any]:
    spec = body.link_spec(link)
    frame = inverse(body.link_inertial_frame(link))
    facts: dict[str, Any] = {"name": spec.name, "position": frame.position, "orientation": frame.orientation}
    if link != BASE:
        facts |= {"joint": spec.joint_name, "kind": spec.joint_type.value, "axis": spec.joint_axis}
        facts["parent"] = spec.parent - BASE
        lower, upper = enforced_limits(spec, body.dynamics(link))
        if isfinite(lower) and isfinite(upper) and lower < upper:
            facts["limits"] = (lower, upper)
        facts |= {
            "effort": spec.effort if isfinite(spec.effort) else 0.0,
            "speed": spec.velocity if isfinite(spec.velocity) else 0.0,
        }
    return facts


def _shape(
    look: ShapeLook, link: int, to_inertial: Pose, appearance: Appearance, assets: Assets
) -> dict[str, Any]:
    levels, scale = _shared(look.geometry, look.mesh, is_mapped=look.is_mapped)
    texture = NO_TEXTURE
    if look.texture != NO_TEXTURE:
        texture = assets.texture(appearance.textures.image(look.texture))
    frame = compose(to_inertial, look.frame)
    shape = {
        "link": link - BASE,
        "meshes": assets.meshes(levels),
        "texture": texture,
        "rgba": look.rgba,
        "specular": look.specular,
        "twoSided": look.two_sided,
        "position": frame.position,
        "orientation": frame.orientation,
        "scale": scale,
    }
    if look.group:
        shape["group"] = look.group
    if look.reflectance:
        shape["reflectance"] = look.reflectance
    return shape


def _collisions(body: BodyCore, link: int, to_inertial: Pose, assets: Assets) -> Iterator[dict[str, Any]]:
    for shape in body.link_spec(link).collisions:
        levels, scale = _shared(shape.geometry, None)
        frame = compose(to_inertial, shape.frame)
        yield {
            "link": link - BASE,
            "meshes": assets.meshes(levels),
            "texture": NO_TEXTURE,
            "rgba": _FLOOR if is_floor(shape.geometry) else _collision_colour(body.id, link),
            "specular": (0.2, 0.2, 0.2),
            "twoSided": True,
            "position": frame.position,
            "orientation": frame.orientation,
            "scale": scale,
            "collision": True,
        }


def _collision_colour(body: int, link: int) -> tuple[float, float, float, float]:
    """A colour for each body, and a shade of it for each link."""
    shade = _SHADES[(link - BASE) % len(_SHADES)]
    red, green, blue = hsv_to_rgb((_FIRST_HUE + body * _HUE_STEP) % 1.0, _SATURATION, shade)
    return (red, green, blue, 1.0)


def is_floor(geometry: Geometry) -> bool:
    """Whether a collision shape is as large as a floor."""
    return geometry.is_floor(_FLOOR_SIZE)


def _shared(
    geometry: Geometry, mesh: RenderMesh | None, *, is_mapped: bool = False
) -> tuple[Levels, Vector3]:
    """Shared meshes of a shape, and its scale; of one that is mapped, its own mesh."""
    if mesh is not None and is_mapped:
        return (Level(mesh),), _NO_SCALE
    # Boxes, spheres and cylinders of all sizes share unit meshes, so that a page draws many in one call.
    unit = geometry.scaled_unit()
    if unit is not None:
        shape, scale = unit
        return _levels(shape), scale
    return (Level(shape_mesh(geometry) if mesh is None else mesh),), _NO_SCALE
