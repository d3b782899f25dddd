"""Data of the kernels of the renderer.

A field's axis is the first word of its name: a `part` is a piece of one shape of a link, with one colour and
one texture; a `chunk` is a run of parts processed by one launch; a `facet` is a projected triangle that may
be visible. Pixel coordinates have their origin at the centre of the top left pixel, y downwards.
"""

from typing import TYPE_CHECKING, Any

from carom.layouts.types import (
    ArrayType,
    Colour,
    Float32,
    Index2,
    Index3,
    Index4,
    Int32,
    Ints,
    Matrix3,
    Matrix4,
    Reals,
    UInt32,
    Vector2,
    Vector3,
    Vectors3,
    Vectors4,
    real,
    struct,
)

if TYPE_CHECKING:
    Vectors2 = Any
    Indices2 = Any
    Indices3 = Any
    Indices4 = Any
    Colours = Any
    Matrices3 = Any
    Matrices4 = Any
    UnsignedInts = Any
    Floats = Any
else:
    Vectors2 = ArrayType(Vector2)
    Indices2 = ArrayType(Index2)
    Indices3 = ArrayType(Index3)
    Indices4 = ArrayType(Index4)
    Colours = ArrayType(Colour)
    Matrices3 = ArrayType(Matrix3)
    Matrices4 = ArrayType(Matrix4)
    UnsignedInts = ArrayType(UInt32)
    Floats = ArrayType(Float32)


@struct
class Scene:
    """Everything visible, in link frames; changes only when bodies or their appearance change."""

    vertex_position: Vectors3  # in the inertial frame of the link
    vertex_normal: Vectors3
    vertex_uv: Vectors2
    triangle_corners: Indices3
    triangle_part: Ints
    part_first_vertex: Ints  # number of parts + 1 entries, like the next
    part_first_triangle: Ints
    part_centre: Vectors3  # of a bounding sphere
    part_radius: Reals
    part_link: Ints
    part_label: Ints  # body id + (link + 1) << 24
    part_rgba: Vectors4
    part_two_sided: Ints
    part_texture: Ints  # -1: none
    texture_first: Ints  # row of the texel at its lower left corner
    texture_size: Indices2
    texel: Colours
    chunk_first_part: Ints


@struct
class View:
    """A view of the scene, from the camera or, for shadows, from the light."""

    width: Int32
    height: Int32
    facing: Reals  # sign of the volume spanned by front faces; 0: draw both sides
    link_to_pixel: Matrices4  # (x, y, z, 1) to (column w, row w, depth w, w), depth -1..1
    vertex_pixel: Vectors4
    facet_first: Vectors3  # weight of each corner, affine in (column, row)
    facet_second: Vectors3
    facet_third: Vectors3
    facet_depth: Vectors3
    facet_box: Indices4  # lowest column and row, highest column and row
    facet_triangle: Ints
    chunk_facet_count: Ints
    pixel_depth: Reals
    pixel_facet: Ints  # -1: background


@struct
class Lighting:
    """Light and shading of one image."""

    direction: Vector3  # towards the light, unit length
    colour: Vector3
    ambient: real
    diffuse: real
    specular: real
    shadow: Int32  # 1: shadows are cast
    shade: real  # factor on the directional light in the shadow
    bias_depth: real  # shadow bias against self-shadowing: offsets of depth w and of w
    bias_w: real  # in the light's view, towards the light
    projected: Int32  # 1: textures are projected by a projector


if TYPE_CHECKING:
    Lightings = Any
else:
    Lightings = ArrayType(Lighting)


@struct
class Picture:
    """Other inputs of one image, and its pixels."""

    lighting: Lightings
    link_rotation: Matrices3
    link_to_projector: Matrices4  # (x, y, z, 1) to (u w, v w, ., w)
    rgba: UnsignedInts  # red in the lowest byte
    depth: Floats  # 0..1
    distance: Floats  # along the viewing direction; infinite: background
    label: Ints  # -1: background
