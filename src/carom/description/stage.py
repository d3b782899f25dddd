"""What a file says about how its scene is seen, besides shapes: lights, sky, and cameras where they stand."""

from __future__ import annotations

from dataclasses import dataclass

from carom.description.place import IN_WORLD, Place
from carom.description.pose import IDENTITY, Pose, Vector3
from carom.description.skin import Skin
from carom.description.texture import Texture


@dataclass(frozen=True, slots=True)
class StageLight:
    """A light.

    Attributes:
        place: The link that it is on.
        position: In the frame of that link [m].
        direction: Where it shines, in that frame, of unit length.
        directional: All its rays have that direction; otherwise they come from its position.
        cutoff: Half of the angle of its cone [degrees]; 180 for a light to all sides.
        exponent: How much darker its cone is towards its edge.
        attenuation: Constant, linear and quadratic term in the distance [m], by which it is divided.
        ambient: Red, green and blue that it adds everywhere.
        diffuse: Its colour.
        specular: Colour of its highlights.
        casts_shadow: Whether shapes cast shadows in it.
        target: The link at which it is aimed; None for its own direction.
    """

    place: Place = IN_WORLD
    position: Vector3 = (0.0, 0.0, 0.0)
    direction: Vector3 = (0.0, 0.0, -1.0)
    directional: bool = False
    cutoff: float = 45.0
    exponent: float = 10.0
    attenuation: Vector3 = (1.0, 0.0, 0.0)
    ambient: Vector3 = (0.0, 0.0, 0.0)
    diffuse: Vector3 = (0.7, 0.7, 0.7)
    specular: Vector3 = (0.3, 0.3, 0.3)
    casts_shadow: bool = True
    target: Place | None = None


@dataclass(frozen=True, slots=True)
class Headlight:
    """The light at the viewer: ambient, diffuse and specular colour."""

    ambient: Vector3 = (0.1, 0.1, 0.1)
    diffuse: Vector3 = (0.4, 0.4, 0.4)
    specular: Vector3 = (0.5, 0.5, 0.5)


@dataclass(frozen=True, slots=True)
class StageCamera:
    """A camera, which looks along -z with y up.

    Attributes:
        name: Its name.
        place: The link that it is on.
        pose: Its pose in the frame of that link.
        field_of_view: Vertical angle [degrees].
        aspect: Width of its image by the height.
        target: The link at which it looks; None for its own direction.
    """

    name: str
    place: Place = IN_WORLD
    pose: Pose = IDENTITY
    field_of_view: float = 45.0
    aspect: float = 4.0 / 3.0
    target: Place | None = None


@dataclass(frozen=True, slots=True)
class Stage:
    """How the scene of a file is seen.

    Attributes:
        lights: Its lights; without any, and without a headlight, windows have their own.
        headlight: The light at the viewer; None for none.
        sky: The cube around it; None for the sky of the window.
        haze: Colour of the horizon, if there is a sky.
        cameras: Its cameras.
        shows_tendons: Whether tendons are seen at first.
        skins: Surfaces that follow links.
    """

    lights: tuple[StageLight, ...] = ()
    headlight: Headlight | None = None
    sky: Texture | None = None
    haze: Vector3 = (1.0, 1.0, 1.0)
    cameras: tuple[StageCamera, ...] = ()
    shows_tendons: bool = False
    skins: tuple[Skin, ...] = ()

    def __add__(self, other: Stage) -> Stage:
        """Both: lights, cameras and skins of both, and the sky and headlight of the first that has them."""
        return Stage(
            (*self.lights, *other.lights),
            self.headlight or other.headlight,
            self.sky or other.sky,
            other.haze if self.sky is None else self.haze,
            (*self.cameras, *other.cameras),
            self.shows_tendons or other.shows_tendons,
            (*self.skins, *other.skins),
        )
