"""Saving and loading colours and textures in the file of a world."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from carom.description.link import Rgba
from carom.description.place import WORLD_BODY, Place
from carom.description.pose import Vector3
from carom.description.skin import Skin
from carom.description.stage import Stage, StageCamera, StageLight
from carom.model.body_spec import BASE
from carom.native.change import Change
from carom.render.appearance import appearance_of, copy_appearance, take_over_appearance
from carom.render.textures import NO_TEXTURE
from carom.world_files.records import Reader, Writer

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

T = TypeVar("T", StageLight, StageCamera)


@dataclass(slots=True)
class SavedLook:
    """Colours and texture of one shape; `texture` is an index into the saved textures, -1 for none.

    `coloured` tells whether a file or a script has said the colour; in files of earlier versions it has.
    """

    rgba: Rgba
    specular: Vector3
    texture: int
    two_sided: bool
    coloured: bool = True


@dataclass(slots=True)
class SavedLooks:
    """Colours and textures of a world.

    Attributes:
        textures: Images of the textures (height, width, 3).
        bodies: Shapes by link, the base first, of each body whose appearance was read or changed; None for
            the others, which have the colours and textures of their descriptions.
        stage: Lights, sky and cameras of files; None without any, and in files of earlier versions.
        numbers: Number of each body, by which the stage names it.
    """

    textures: list[NDArray[np.uint8]]
    bodies: list[list[list[SavedLook]] | None]
    stage: Stage | None = None
    numbers: list[int] = field(default_factory=list)


def save(world: WorldCore, writer: Writer) -> Any:
    """The colours and textures of a world as data for its file."""
    appearance = appearance_of(world)
    places: dict[int, int] = {}
    bodies: list[list[list[SavedLook]] | None] = []
    for body in world.bodies.values():
        if not appearance.knows(body):
            bodies.append(None)
            continue
        links = []
        for link in range(BASE, body.joint_count):
            looks = []
            for look in appearance.shapes(body, link):
                place = NO_TEXTURE
                if look.texture != NO_TEXTURE and look.texture in appearance.textures:
                    place = places.setdefault(look.texture, len(places))
                looks.append(SavedLook(look.rgba, look.specular, place, look.two_sided, look.coloured))
            links.append(looks)
        bodies.append(links)
    images = [np.asarray(appearance.textures.image(number)) for number in places]
    return writer.write(SavedLooks(images, bodies, appearance.stage, list(world.bodies.keys())))


def begin(world: WorldCore, draft: WorldCore) -> None:
    """Give the draft of a world its colours and textures."""
    copy_appearance(world, draft)


def load(bodies: Sequence[BodyCore], reader: Reader, data: Any) -> None:
    """Apply the saved colours and textures to these bodies.

    Raises:
        carom.errors.DescriptionError: The data were not written by `save`.
        ValueError: The data belong to other bodies.
    """
    saved = reader.record(SavedLooks, data, "parts.looks")
    if len(saved.bodies) != len(bodies):
        raise ValueError("the colours and textures are those of other bodies")
    if not bodies:
        return
    appearance = appearance_of(bodies[0].world)
    for image in saved.textures:
        if image.ndim != 3 or image.shape[2] != 3 or 0 in image.shape:
            raise ValueError("a texture is no image")
    if saved.stage is not None:
        if len(saved.numbers) != len(bodies):
            raise ValueError("the lights and cameras are those of other bodies")
        places = {number: body.id for number, body in zip(saved.numbers, bodies, strict=True)}
        stage = _moved(saved.stage, {WORLD_BODY: WORLD_BODY, **places})
        appearance.set_stage(stage if appearance.stage is None else appearance.stage + stage)
    numbers = {NO_TEXTURE: NO_TEXTURE}
    for body, links in zip(bodies, saved.bodies, strict=True):
        if links is None:
            continue
        if len(links) != 1 + body.joint_count:
            raise ValueError(f"body {body.id} has {1 + body.joint_count} links")
        for link, looks in enumerate(links, start=BASE):
            if len(looks) != len(appearance.shapes(body, link)):
                raise ValueError(f"link {link} of body {body.id} has another number of shapes")
            for place, look in enumerate(looks):
                if look.texture not in numbers:
                    numbers[look.texture] = appearance.textures.add(saved.textures[look.texture])
                appearance.change(
                    body,
                    link,
                    place,
                    rgba=look.rgba if look.coloured else None,
                    specular=look.specular,
                    texture=numbers[look.texture],
                    two_sided=look.two_sided,
                )


def _moved(stage: Stage, numbers: Mapping[int, int]) -> Stage:
    """A stage on bodies with other numbers; what was on bodies that had gone is left out."""

    def moved(things: tuple[T, ...]) -> tuple[T, ...]:
        return tuple(
            replace(
                it,
                place=Place(numbers[it.place.body], it.place.link),
                target=None
                if it.target is None or it.target.body not in numbers
                else Place(numbers[it.target.body], it.target.link),
            )
            for it in things
            if it.place.body in numbers
        )

    return replace(
        stage, lights=moved(stage.lights), cameras=moved(stage.cameras), skins=_skins_moved(stage, numbers)
    )


def _skins_moved(stage: Stage, numbers: Mapping[int, int]) -> tuple[Skin, ...]:
    """The skins all of whose bones are there."""
    return tuple(
        replace(
            skin,
            bones=tuple(
                replace(bone, place=Place(numbers[bone.place.body], bone.place.link)) for bone in skin.bones
            ),
        )
        for skin in stage.skins
        if all(bone.place.body in numbers for bone in skin.bones)
    )


def publish(change: Change, world: WorldCore, draft: WorldCore) -> None:
    """Give a world the colours and textures of its draft, with a change."""
    take_over_appearance(change, world, draft)
