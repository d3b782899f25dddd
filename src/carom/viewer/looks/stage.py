"""The message about lights, sky and cameras of files."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from carom.description.place import Place
from carom.description.stage import Stage
from carom.model.body_spec import BASE
from carom.render.textures import NO_TEXTURE
from carom.viewer.protocol import to_page

if TYPE_CHECKING:
    from carom.render.appearance import Appearance
    from carom.viewer.looks.shapes import Assets


def staged(appearance: Appearance, assets: Assets) -> dict[str, Any] | None:
    """Message about the stage of a world; None if it has none. Its sky becomes a texture on the pages."""
    stage = appearance.stage
    if stage is None:
        return None
    headlight = stage.headlight
    return to_page.STAGE(
        sky=_sky(stage, assets),
        haze=stage.haze,
        headlight=None
        if headlight is None
        else {
            "ambient": headlight.ambient,
            "diffuse": headlight.diffuse,
            "specular": headlight.specular,
        },
        lights=[
            {
                **_place(it.place),
                "position": it.position,
                "direction": it.direction,
                "directional": it.directional,
                "cutoff": it.cutoff,
                "exponent": it.exponent,
                "attenuation": it.attenuation,
                "ambient": it.ambient,
                "diffuse": it.diffuse,
                "specular": it.specular,
                "shadow": it.casts_shadow,
                **_target(it.target),
            }
            for it in stage.lights
        ],
        cameras=[
            {
                "name": it.name,
                **_place(it.place),
                "position": it.pose.position,
                "orientation": it.pose.orientation,
                "angle": it.field_of_view,
                "aspect": it.aspect,
                **_target(it.target),
            }
            for it in stage.cameras
        ],
        tendons=stage.shows_tendons,
    )


def _sky(stage: Stage, assets: Assets) -> int:
    if stage.sky is None:
        return NO_TEXTURE
    from carom.render.textured import texture_image

    image = texture_image(stage.sky)
    return NO_TEXTURE if image is None else assets.texture(image)


def _place(place: Place) -> dict[str, int]:
    return {"body": place.body, "link": place.link - BASE if place.body >= 0 else 0}


def _target(target: Place | None) -> dict[str, Any]:
    return {} if target is None else {"target": [target.body, target.link - BASE]}
