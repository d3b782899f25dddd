"""Data of the kernels of the renderer.

A field's axis is the first word of its name: a `part` is a piece of one shape of a link, with one colour and
one texture; a `chunk` is a run of parts processed by one launch; a `facet` is a projected triangle that may
be visible. Pixel coordinates have their origin at the centre of the top left pixel, y downwards.
"""

from carom.layouts.types import (
    Array,
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


@struct
class Scene:
    """Everything visible, in link frames; changes only when bodies or their appearance change."""

    vertex_position: Vectors3  # in the inertial frame of the link
    vertex_normal: Vectors3
    vertex_uv: Array[Vector2]
    triangle_corners: Array[Index3]
    triangle_part: Ints
    part_first_vertex: Ints  # number of parts + 1 entries, like the next
    part_first_triangle: Ints
    part_centre: Vectors3  # of a bounding sphere
    part_radius: Reals
    part_link: Ints
    part_label: Ints  # body id + (link + 1) << 24
    part_rgba: Vectors4  # and behind them those of each of many worlds, if they differ; see `first_look`
    part_two_sided: Ints
    part_texture: Ints  # -1: none
    texture_first: Ints  # row of the texel at its lower left corner
    texture_size: Array[Index2]
    texel: Array[Colour]
    chunk_first_part: Ints


@struct
class View:
    """A view of the scene, from the camera or, for shadows, from the light."""

    width: Int32
    height: Int32
    facing: Reals  # sign of the volume spanned by front faces; 0: draw both sides
    link_to_pixel: Array[Matrix4]  # (x, y, z, 1) to (column w, row w, depth w, w), depth -1..1
    vertex_pixel: Vectors4
    facet_first: Vectors3  # weight of each corner, affine in (column, row)
    facet_second: Vectors3
    facet_third: Vectors3
    facet_depth: Vectors3
    facet_box: Array[Index4]  # lowest column and row, highest column and row
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
    first_look: Int32  # row of `part_rgba` and `part_texture` of the first part


@struct
class Picture:
    """Other inputs of one image, and its pixels."""

    lighting: Array[Lighting]
    link_rotation: Array[Matrix3]
    link_to_projector: Array[Matrix4]  # (x, y, z, 1) to (u w, v w, ., w)
    rgba: Array[UInt32]  # red in the lowest byte
    depth: Array[Float32]  # 0..1
    distance: Array[Float32]  # along the viewing direction; infinite: background
    label: Ints  # -1: background
