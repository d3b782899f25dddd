"""The arrays the kernels of the renderer share.

Names begin with what an entry belongs to: a `part` is a piece of one shape of a link, with one colour and
one texture; a `chunk` is a run of parts handled by one launch; a `facet` is a triangle that may be seen,
ready to be filled. Pixel coordinates have their origin at the centre of the top left pixel, y downwards.
"""

import warp as wp

from carom.model.real import Index4, Int32, Matrix3, Vector3, Vector4, real

Vector2 = wp.types.vector(2, real)
Matrix4 = wp.types.matrix((4, 4), real)


@wp.struct
class Scene:
    """Everything there is to be drawn, at rest: changes only when bodies or their looks change."""

    vertex_position: wp.array(dtype=Vector3)  # in the inertial frame of the link
    vertex_normal: wp.array(dtype=Vector3)
    vertex_uv: wp.array(dtype=Vector2)
    triangle_corners: wp.array(dtype=wp.vec3i)
    triangle_part: wp.array(dtype=Int32)
    part_first_vertex: wp.array(dtype=Int32)  # one entry more than there are parts, as below
    part_first_triangle: wp.array(dtype=Int32)
    part_centre: wp.array(dtype=Vector3)  # of a ball around it
    part_radius: wp.array(dtype=real)
    part_link: wp.array(dtype=Int32)
    part_label: wp.array(dtype=Int32)  # body id + (link + 1) << 24
    part_rgba: wp.array(dtype=Vector4)
    part_two_sided: wp.array(dtype=Int32)
    part_texture: wp.array(dtype=Int32)  # -1: none
    texture_first: wp.array(dtype=Int32)  # texel of its lower left corner
    texture_size: wp.array(dtype=wp.vec2i)
    texel: wp.array(dtype=wp.vec3ub)
    chunk_first_part: wp.array(dtype=Int32)


@wp.struct
class View:
    """The scene as one eye sees it, be it the camera or, for its shadows, the light."""

    width: Int32
    height: Int32
    facing: wp.array(dtype=real)  # sign of the volume spanned by front faces; 0: draw both sides
    link_to_pixel: wp.array(dtype=Matrix4)  # (x, y, z, 1) to (column w, row w, depth w, w), depth -1..1
    vertex_pixel: wp.array(dtype=Vector4)
    facet_first: wp.array(dtype=Vector3)  # weight of each corner, affine in (column, row)
    facet_second: wp.array(dtype=Vector3)
    facet_third: wp.array(dtype=Vector3)
    facet_depth: wp.array(dtype=Vector3)
    facet_box: wp.array(dtype=Index4)  # least column and row, greatest column and row
    facet_triangle: wp.array(dtype=Int32)
    chunk_facet_count: wp.array(dtype=Int32)
    pixel_depth: wp.array(dtype=real)
    pixel_facet: wp.array(dtype=Int32)  # -1: background


@wp.struct
class Lighting:
    """How surfaces are lit in one image."""

    direction: Vector3  # towards the light, unit length
    colour: Vector3
    ambient: real
    diffuse: real
    specular: real
    shadow: Int32  # 1: shadows are cast
    shade: real  # what remains of the directed light in the shadow
    bias_depth: real  # change of (depth w, w) of the light's view towards the light that ends
    bias_w: real  # a surface's shadow on itself
    projected: Int32  # 1: textures are cast by a projector


@wp.struct
class Picture:
    """What one image needs besides the view, and its pixels."""

    lighting: wp.array(dtype=Lighting)
    link_rotation: wp.array(dtype=Matrix3)
    link_to_projector: wp.array(dtype=Matrix4)  # (x, y, z, 1) to (u w, v w, ., w)
    rgba: wp.array(dtype=wp.uint32)  # red in the lowest byte
    depth: wp.array(dtype=wp.float32)  # 0..1
    distance: wp.array(dtype=wp.float32)  # along the view; infinite: background
    label: wp.array(dtype=Int32)  # -1: background
