"""The present colours and textures of the shapes of a world.

All code that draws, reports or changes colours and textures uses this module.
"""

from __future__ import annotations

from collections.abc import Sequence
from copy import deepcopy
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary, ref

from carom.description import Geometry, Material, Mesh, Pose, TriangleMesh, Visual
from carom.description.link import Rgba
from carom.errors import DescriptionError
from carom.formats.visuals.mtl import BLACK
from carom.formats.visuals.render_mesh import RenderMesh
from carom.layouts.flags import LoadFlags
from carom.logger import Logger
from carom.model.body_spec import BASE, LinkSpec
from carom.native.change import Change
from carom.render.images import Texels, read_image
from carom.render.lights import Light
from carom.render.meshes import shape_mesh, stretched
from carom.render.textures import CHECKER, NO_TEXTURE, Textures

if TYPE_CHECKING:
    from carom.description.skin import Skin
    from carom.description.stage import Stage
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

_log = Logger("carom")

WHITE: Rgba = (1.0, 1.0, 1.0, 1.0)
GREY: Rgba = (0.8, 0.8, 0.8, 1.0)
"""Colour of a material without a colour."""

WINDOW_COLOURS: tuple[Rgba, ...] = (
    (60 / 256, 186 / 256, 84 / 256, 1.0),
    (244 / 256, 194 / 256, 13 / 256, 1.0),
    (219 / 256, 50 / 256, 54 / 256, 1.0),
    (72 / 256, 133 / 256, 237 / 256, 1.0),
)
"""Green, yellow, red and blue, for shapes without a colour."""

LAST_SHOWN_GROUP = 2
"""Shapes and sites of groups up to this one are seen at first, as in MuJoCo."""


@dataclass(slots=True)
class ShapeLook:
    """One visible shape of a link, with its present colours and texture.

    Attributes:
        geometry: The shape.
        frame: Its pose in the link frame.
        mesh: Its triangles, in its own frame.
        rgba: Present colour, which multiplies that of the texture. A shape of alpha 0 is not drawn; other
            values of alpha have no effect.
        specular: Present colour of its highlights.
        texture: Number of its present texture, -1 if it has none.
        two_sided: Whether its back faces are drawn, too.
        coloured: Whether a file or a script has said its colour. PyBullet's window draws other shapes in four
            colours in turn; its images, and `rgba`, show them white.
        group: Number of its group: images show those up to `LAST_SHOWN_GROUP`, windows any.
        reflectance: Share of light that it mirrors, if it is a plane, in windows.
        is_mapped: Whether its mesh is its own; otherwise it is as of all shapes of its kind and size.
    """

    geometry: Geometry
    frame: Pose
    mesh: RenderMesh
    rgba: Rgba
    specular: tuple[float, float, float] = (1.0, 1.0, 1.0)
    texture: int = NO_TEXTURE
    two_sided: bool = False
    coloured: bool = True
    group: int = 0
    reflectance: float = 0.0
    is_mapped: bool = False


@dataclass(frozen=True, eq=False, slots=True)
class SkinLook:
    """A skin, and how it looks.

    Attributes:
        skin: The skin.
        look: Its look, as that of a shape of the link that carries it.
    """

    skin: Skin
    look: ShapeLook


@dataclass(slots=True)
class Appearance:
    """The colours, textures and light of one world; get it from `appearance_of`.

    Attributes:
        textures: Its textures by number.
        light: The light as last set. The drop-in keeps the light of one image for the next ones.
        changes: Number of changes of shapes so far.
        stage: Lights, sky, cameras and skins of files; None if no file has said anything.
        skins: The skins of the stage, and how they look.
    """

    textures: Textures = field(default_factory=Textures)
    light: Light = field(default_factory=Light)
    changes: int = 0
    stage: Stage | None = None
    skins: list[SkinLook] = field(default_factory=list)
    _looks: WeakKeyDictionary[BodyCore, list[list[ShapeLook]]] = field(default_factory=WeakKeyDictionary)

    def shapes(self, body: BodyCore, link: int) -> Sequence[ShapeLook]:
        """The visible shapes of a link; -1 is the base."""
        return self._of(body)[link - BASE]

    def shown_by(self, body: BodyCore, link: int, shape: int | None, *, alike: bool = False) -> list[int]:
        """Numbers of the visible shapes that show a collision shape of a link.

        They are those of its geometry and place; or all of the link where none is, as of robots whose files
        have finer shapes to be seen; or all of the link if no collision shape is stated. `alike`: only those
        of its geometry and place.
        """
        there = self.shapes(body, link)
        spec = body.link_spec(link)
        if shape is None:
            return [*range(len(there))]
        if not spec.visuals:
            return [shape]
        own = spec.collisions[shape]
        same = [
            number
            for number, look in enumerate(there)
            if look.geometry == own.geometry and look.frame == own.frame
        ]
        return same if same or alike else [*range(len(there))]

    def change(
        self,
        body: BodyCore,
        link: int,
        shape: int | None = None,
        *,
        rgba: Rgba | None = None,
        specular: tuple[float, float, float] | None = None,
        texture: int | None = None,
        two_sided: bool | None = None,
    ) -> None:
        """Change the appearance of a link, -1 for the base; without `shape` of all shapes. None: as it is.

        Raises:
            IndexError: There is no such link or shape.
            KeyError: There is no such texture.
        """
        looks = self._of(body)[link - BASE]
        if texture is not None and texture != NO_TEXTURE:
            self.textures.image(texture)
        values = {"rgba": rgba, "specular": specular, "texture": texture, "two_sided": two_sided}
        given = {name: value for name, value in values.items() if value is not None}
        if rgba is not None:
            given["coloured"] = True
        change = Change()
        for look in looks if shape is None else [looks[shape]]:
            change.set_all(look, **given)
        change.set(self, "changes", self.changes + 1)
        change.commit()

    def note_geometry(self, change: Change, look: ShapeLook, geometry: Geometry) -> None:
        """Let a visible shape be another of its kind, with a change; its texture is mapped as it was."""
        mesh = stretched(look.mesh, look.geometry, geometry) if look.is_mapped else shape_mesh(geometry)
        change.set_all(look, geometry=geometry, mesh=mesh)
        change.set(self, "changes", change.get(self, "changes") + 1)

    def set_stage(self, stage: Stage | None) -> None:
        """Set the lights, sky, cameras and skins of the world."""
        change = Change()
        known = {id(it.skin): it for it in self.skins}
        skins = () if stage is None else stage.skins
        known |= {id(skin): self._skin_look(change, skin) for skin in skins if id(skin) not in known}
        change.set(self, "skins", [known[id(skin)] for skin in skins])
        change.set(self, "stage", stage)
        change.set(self, "changes", self.changes + 1)
        change.commit()

    def knows(self, body: BodyCore) -> bool:
        """Whether the appearance of a body has been read or changed already."""
        return body in self._looks

    def add_texture(self, image: Texels, bodies: Sequence[BodyCore]) -> int:
        """Add a texture, after those of bodies, in the order these were loaded, and return its number."""
        change = Change()
        self._note_first(change, bodies)
        number = self.textures.note(change, image)
        change.commit()
        return number

    def number_textures(self, bodies: Sequence[BodyCore]) -> None:
        """Number the textures of bodies, in the order the bodies were loaded."""
        change = Change()
        self._note_first(change, bodies)
        change.commit()

    def _of(self, body: BodyCore) -> list[list[ShapeLook]]:
        if body not in self._looks:
            # The textures of bodies that were loaded before come first.
            self.number_textures(list(body.world.bodies.values()))
        if body not in self._looks:
            self.number_textures([body])
        return self._looks[body]

    def _note_first(self, change: Change, bodies: Sequence[BodyCore]) -> None:
        """Give bodies that have no looks yet their first ones with a change."""
        first = {body: self._first_of(change, body) for body in bodies if body not in self._looks}
        if first:
            looks = WeakKeyDictionary(self._looks)
            looks.update(first)
            change.set(self, "_looks", looks)

    def _first_of(self, change: Change, body: BodyCore) -> list[list[ShapeLook]]:
        """The looks of a body as it was loaded; a change numbers its textures."""
        flags = LoadFlags(body.spec.flags)
        looks = [
            self._first_looks(change, body.link_spec(link), link, flags)
            for link in range(BASE, body.joint_count)
        ]
        if body.spec.soft is not None:
            looks[0] = self._soft_looks(change, body.spec.base, looks[0], body.spec.soft.checkered)
        return looks

    def _soft_looks(
        self, change: Change, base: LinkSpec, looks: list[ShapeLook], checkered: bool
    ) -> list[ShapeLook]:
        """Looks of a soft body: two-sided, because it may be cloth, and with its texture if it has one."""
        files = [None if visual.material is None else visual.material.texture for visual in base.visuals]
        images = [CHECKER if checkered else _image_of(file) for file in files]
        # In PyBullet the textures of soft bodies have no number.
        textures = [
            NO_TEXTURE if image is None else self.textures.note(change, image, hidden=True)
            for image in images
        ]
        return [
            replace(look, two_sided=True, texture=texture)
            for look, texture in zip(looks, textures, strict=True)
        ]

    def _first_looks(self, change: Change, spec: LinkSpec, link: int, flags: LoadFlags) -> list[ShapeLook]:
        # A link without visual shapes is drawn with its collision shapes.
        if not spec.visuals:
            undefined = _undefined_colour(link, flags)
            looks = [
                self._look(change, shape.geometry, shape.frame, undefined, flags) for shape in spec.collisions
            ]
            for look in looks:
                look.coloured = undefined is not WHITE
            return looks
        looks = []
        for visual in spec.visuals:
            look = self._look(
                change, visual.geometry, visual.frame, _colour(visual.material, link, flags), flags
            )
            if visual.material is not None and visual.material.specular is not None:
                look.specular = visual.material.specular
            look.coloured = not visual.stands_in or look.rgba is not WHITE
            if visual.group is not None:
                self._as_stated(change, look, visual)
            looks.append(look)
        return looks

    def _as_stated(self, change: Change, look: ShapeLook, visual: Visual) -> None:
        """Give a shape of a file with groups the texture that the file states, or none."""
        material = visual.material
        look.group = visual.group or 0
        look.reflectance = 0.0 if material is None else material.reflectance
        if look.geometry.is_ground:
            look.texture = NO_TEXTURE
        if material is None or material.image is None:
            return
        from carom.render.textured import texture_image, with_texture

        image = texture_image(material.image)
        if image is not None:
            look.texture = self.textures.note(change, image)
            look.mesh = with_texture(look.mesh, look.geometry, material.image)
            look.is_mapped = True

    def _skin_look(self, change: Change, skin: Skin) -> SkinLook:
        """The look of a skin; a change numbers its texture."""
        from carom.render.skins import skin_at_rest
        from carom.render.textured import texture_image

        geometry = TriangleMesh(skin.vertices, skin.triangles, uvs=skin.uvs)
        look = ShapeLook(
            geometry, Pose(), skin_at_rest(skin), GREY, two_sided=True, group=skin.group, is_mapped=True
        )
        material = skin.material
        if material is not None:
            look.rgba = material.rgba or GREY
            look.specular = material.specular or look.specular
            image = None if material.image is None else texture_image(material.image)
            if image is not None:
                look.texture = self.textures.note(change, image)
        return SkinLook(skin, look)

    def _look(
        self, change: Change, geometry: Geometry, frame: Pose, rgba: Rgba, flags: LoadFlags
    ) -> ShapeLook:
        # The mesh is kept in memory because, as in PyBullet, its file may be deleted after loading.
        mesh = shape_mesh(geometry)
        look = ShapeLook(geometry, frame, mesh, rgba)
        if geometry.is_ground:
            look.texture = self.textures.note(change, CHECKER)
        elif isinstance(geometry, Mesh):
            look.rgba = _colour_of_mesh(geometry.path, mesh, flags) or rgba
            image = _image_of(mesh.texture_file)
            look.texture = NO_TEXTURE if image is None else self.textures.note(change, image)
        return look


def _colour_of_mesh(file: Path, mesh: RenderMesh, flags: LoadFlags) -> Rgba | None:
    """The colour that a mesh file gives; None if it gives none, or is not asked for one."""
    if LoadFlags.USE_MATERIAL_COLORS_FROM_MTL not in flags:
        return None
    material = mesh.material_rgba
    if material is None:
        # To PyBullet an OBJ file without material is black; files of other kinds have no materials.
        is_black = file.suffix.lower() == ".obj" and len(mesh.triangles)
        return BLACK if is_black and LoadFlags.ONLY_MATERIALS_THERE_ARE not in flags else None
    opaque = LoadFlags.USE_MATERIAL_TRANSPARENCY_FROM_MTL not in flags
    return (*material[:3], 1.0) if opaque else material


def _image_of(file: Path | None) -> Texels | None:
    """The texture image of a material; if it cannot be read, a warning is logged and the result is None."""
    if file is None:
        return None
    try:
        return read_image(file)
    except DescriptionError as error:
        _log.warning("%s; the mesh goes without texture", error)
        return None


def _colour(material: Material | None, link: int, flags: LoadFlags) -> Rgba:
    if material is None or (material.rgba is None and material.texture is None and material.specular is None):
        return _undefined_colour(link, flags)
    return GREY if material.rgba is None else material.rgba


def _undefined_colour(link: int, flags: LoadFlags) -> Rgba:
    if LoadFlags.GOOGLY_UNDEFINED_COLORS in flags:
        return WINDOW_COLOURS[max(link, 0) % len(WINDOW_COLOURS)]
    return WHITE


def appearance_of(world: WorldCore) -> Appearance:
    """Colours and textures of a world. A reset of the world removes all textures."""
    entry = _appearances.get(world)
    if entry is None:
        appearance = Appearance()
    else:
        arrays, appearance = entry
        if arrays() is world.arrays:
            return appearance
        # The world was reset: a reset replaces its arrays.
        appearance.textures.clear()
        appearance.stage = None
        appearance.skins = []
    _appearances[world] = (ref(world.arrays), appearance)
    return appearance


def copy_appearance(world: WorldCore, other: WorldCore) -> None:
    """Copy the appearance of a world to a copy of the world, whose bodies have the same numbers."""
    if world not in _appearances:
        return
    appearance = appearance_of(world)
    copied = appearance_of(other)
    copied.textures = deepcopy(appearance.textures)
    copied.light = appearance.light
    copied.stage = appearance.stage
    copied.skins = list(appearance.skins)
    for number, body in world.bodies.items():
        if appearance.knows(body):
            copied._looks[other.bodies[number]] = [
                [replace(look) for look in looks] for looks in appearance._of(body)
            ]


def take_over_appearance(change: Change, world: WorldCore, draft: WorldCore) -> None:
    """Give a world the appearance of its draft, which has the same bodies and new ones, with a change."""
    if draft not in _appearances:
        return
    ours, theirs = appearance_of(world), appearance_of(draft)
    for name in ("textures", "light", "stage", "skins", "_looks"):
        change.set(ours, name, getattr(theirs, name))
    change.set(ours, "changes", ours.changes + 1)


_appearances: WeakKeyDictionary[WorldCore, tuple[ref, Appearance]] = WeakKeyDictionary()
