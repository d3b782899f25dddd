"""Shading: the colour of a pixel from texture, Phong lighting and shadows."""

import warp as wp

from carom.kernels.structs import Lighting, Picture, Scene, View
from carom.kernels.types import Int32, Vector2, Vector3, Vector4, func, real

_WHITE = wp.constant(wp.uint32(0xFFFFFFFF))
_OPAQUE = wp.constant(wp.uint32(0xFF000000))
# Texture coordinates of at least this magnitude count as whole numbers.
_WHOLE_NUMBERS = real(1.0e9)


@func
def wrapped(coordinate: real, size: Int32) -> Int32:
    """Column or row of the texel at a texture coordinate; textures repeat."""
    # Written so that NaN fails the test as well: NaN cannot become an index.
    if not (wp.abs(coordinate) < _WHOLE_NUMBERS):
        return 0
    # Truncation takes one instruction; rounding down takes a function call.
    fraction = coordinate - real(Int32(coordinate))
    if fraction < 0.0:
        fraction += 1.0
    return wp.min(Int32(fraction * real(size)), size - 1)


@func
def surface_colour(scene: Scene, look: Int32, uv: Vector2) -> Vector3:
    """Colour of a surface before lighting: red, green and blue, whole numbers of 0..255.

    `look` is the row of its colour and texture.
    """
    colour = Vector3(255.0, 255.0, 255.0)
    texture = scene.part_texture[look]
    if texture >= 0:
        size = scene.texture_size[texture]
        place = scene.texture_first[texture] + wrapped(uv[1], size[1]) * size[0] + wrapped(uv[0], size[0])
        texel = scene.texel[place]
        colour = Vector3(real(texel[0]), real(texel[1]), real(texel[2]))
    rgba = scene.part_rgba[look]
    return Vector3(
        real(Int32(wp.clamp(colour[0] * rgba[0], 0.0, 255.0))),
        real(Int32(wp.clamp(colour[1] * rgba[1], 0.0, 255.0))),
        real(Int32(wp.clamp(colour[2] * rgba[2], 0.0, 255.0))),
    )


@func
def is_lit(light: View, lighting: Lighting, point: Vector4) -> bool:
    """Whether the light reaches a point, given in homogeneous pixels of the light's view."""
    if point[3] <= 0.0:
        return True
    x, y = wp.round(point[0] / point[3]), wp.round(point[1] / point[3])
    # Written so that NaN fails the test as well.
    if not (x >= 0.0 and y >= 0.0):
        return True
    if not (x < real(light.width) and y < real(light.height)):
        return True
    pixel = Int32(y) * light.width + Int32(x)
    nearer = (point[2] - lighting.bias_depth) / (point[3] - lighting.bias_w)
    return light.pixel_facet[pixel] < 0 or light.pixel_depth[pixel] >= nearer


@func
def lit(
    lighting: Lighting, towards: Vector3, up: Vector3, colour: Vector3, normal: Vector3, shadow: real
) -> wp.uint32:
    """Packed RGBA colour of a surface under the light.

    `towards` is the direction to the light and `up` the vertical, both in the frame of the normal.
    """
    facing = wp.dot(normal, towards)
    # As in PyBullet, the highlight is where the light is reflected straight up, regardless of the camera.
    shine = wp.max(2.0 * facing * wp.dot(normal, up) - wp.dot(towards, up), 0.0)
    directed = shadow * (lighting.diffuse * wp.max(facing, 0.0) + lighting.specular * shine * shine)
    result = _OPAQUE
    for channel in range(3):
        strength = lighting.ambient + directed * lighting.colour[channel]
        value = wp.uint32(wp.clamp(colour[channel] * strength, 0.0, 255.0))
        result = result | (value << wp.uint32(8 * channel))
    return result


@func
def shade_background(picture: Picture, first: Int32, end: Int32):
    """Fill pixels that show no triangle."""
    for pixel in range(first, end):
        picture.rgba[pixel] = _WHITE
        picture.depth[pixel] = wp.float32(1.0)
        picture.distance[pixel] = wp.float32(wp.inf)
        picture.label[pixel] = -1


@func
def shade_span(
    scene: Scene,
    view: View,
    light: View,
    picture: Picture,
    lighting: Lighting,
    first_link: Int32,
    first_pixel: Int32,
    row: Int32,
    first_column: Int32,
    end_column: Int32,
):
    """Write colour, depth, distance and label of neighbouring pixels that show the same facet.

    The matrices of the links begin at `first_link`, and the pixels of the picture at `first_pixel`.
    """
    line = row * view.width
    facet = view.pixel_facet[line + first_column]
    if facet < 0:
        shade_background(picture, first_pixel + line + first_column, first_pixel + line + end_column)
        return
    triangle = view.facet_triangle[facet]
    corners = scene.triangle_corners[triangle]
    part = scene.triangle_part[triangle]
    link = first_link + scene.part_link[part]
    label = scene.part_label[part]
    # Rotating the light's direction into the link frame saves rotating every normal into world axes.
    to_link = wp.transpose(picture.link_rotation[link])
    towards = to_link * lighting.direction
    up = to_link * Vector3(0.0, 0.0, 1.0)
    y = real(row)
    first = view.facet_first[facet]
    second = view.facet_second[facet]
    third = view.facet_third[facet]
    first_start = first[1] * y + first[2]
    second_start = second[1] * y + second[2]
    third_start = third[1] * y + third[2]
    first_normal = scene.vertex_normal[corners[0]]
    second_normal = scene.vertex_normal[corners[1]]
    third_normal = scene.vertex_normal[corners[2]]
    first_uv = scene.vertex_uv[corners[0]]
    second_uv = scene.vertex_uv[corners[1]]
    third_uv = scene.vertex_uv[corners[2]]
    for column in range(first_column, end_column):
        pixel = line + column
        x = real(column)
        u = first[0] * x + first_start
        v = second[0] * x + second_start
        w = third[0] * x + third_start
        # Perspective-correct interpolation: the corners' weights in space, not on the screen.
        distance = 1.0 / (u + v + w)
        u, v, w = u * distance, v * distance, w * distance
        uv = first_uv * u + second_uv * v + third_uv * w
        shadow = real(1.0)
        if lighting.shadow + lighting.projected > 0:
            p = (
                scene.vertex_position[corners[0]] * u
                + scene.vertex_position[corners[1]] * v
                + scene.vertex_position[corners[2]] * w
            )
            point = Vector4(p[0], p[1], p[2], 1.0)
            if lighting.shadow == 1 and not is_lit(light, lighting, light.link_to_pixel[link] * point):
                shadow = lighting.shade
            if lighting.projected == 1:
                cast = picture.link_to_projector[link] * point
                uv = Vector2(cast[0] / cast[3], cast[1] / cast[3])
        normal = wp.normalize(first_normal * u + second_normal * v + third_normal * w)
        colour = surface_colour(scene, lighting.first_look + part, uv)
        drawn = first_pixel + pixel
        picture.rgba[drawn] = lit(lighting, towards, up, colour, normal, shadow)
        picture.depth[drawn] = wp.float32(0.5 + 0.5 * view.pixel_depth[pixel])
        picture.distance[drawn] = wp.float32(distance)
        picture.label[drawn] = label


@func
def shade_row(
    scene: Scene,
    view: View,
    light: View,
    picture: Picture,
    lighting: Lighting,
    first_link: Int32,
    first_pixel: Int32,
    row: Int32,
):
    """Write the pixels of a row whose facets are known, one span of equal facets after the other."""
    line = row * view.width
    first = Int32(0)
    for column in range(1, view.width + 1):
        if column == view.width or view.pixel_facet[line + column] != view.pixel_facet[line + first]:
            shade_span(scene, view, light, picture, lighting, first_link, first_pixel, row, first, column)
            first = column
