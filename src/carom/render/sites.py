"""Sites that are drawn: those with a colour, as shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.description.geometry import BY_MJCF
from carom.render.appearance import LAST_SHOWN_GROUP, ShapeLook
from carom.render.primitives import primitive_mesh

if TYPE_CHECKING:
    from carom.description.site import SiteSpec
    from carom.scene.core.body_core import BodyCore

_SPECULAR = (0.5, 0.5, 0.5)


def sites_by_link(body: BodyCore) -> dict[int, list[ShapeLook]]:
    """The looks of all sites of a body that have a colour, by the index of their link, -1 for the base."""
    found: dict[int, list[ShapeLook]] = {}
    for site in body.spec.sites:
        if site.rgba is not None:
            found.setdefault(site.link, []).append(_look(site))
    return found


def shown_sites(body: BodyCore) -> dict[int, list[ShapeLook]]:
    """Those of them that images show."""
    return {
        link: [it for it in looks if it.group <= LAST_SHOWN_GROUP]
        for link, looks in sites_by_link(body).items()
    }


def _look(site: SiteSpec) -> ShapeLook:
    shape = BY_MJCF[site.shape.value].of_sizes(*site.size)
    assert site.rgba is not None
    return ShapeLook(shape, site.pose, primitive_mesh(shape), site.rgba, _SPECULAR, group=site.group)
