"""The colour of a pixel: texture, Phong's light and shadows."""

import warp as wp

from carom.model.real import Int32, Vector3, Vector4, func, real
from carom.render.kernels.structs import Lighting, Picture, Scene, Vector2, View

_WHITE = wp.constant(wp.uint32(0xFFFFFFFF))
_OPAQUE = wp.constant(wp.uint32(0xFF000000))


@func
def wrapped(coordinate: real, size: Int32) -> Int32:
    """Column or row of the texel at a texture coordinate; textures repeat."""
    fraction = coordinate - wp.floor(coordinate)
    # Written so that NaN fails as well: it would be no index.
    if not (fraction >= 0.0):
        return 0
    return wp.min(Int32(fraction * real(size)), size - 1)


@func
def surface_colour(scene: Scene, part: Int32, uv: Vector2) -> Vector3:
    """Red, green and blue, whole numbers of 0..255, before any light."""
    colour = Vector3(255.0, 255.0, 255.0)
    texture = scene.part_texture[part]
    if texture >= 0:
        size = scene.texture_size[texture]
        place = scene.texture_first[texture] + wrapped(uv[1], size[1]) * size[0] + wrapped(uv[0], size[0])
        texel = scene.texel[place]
        colour = Vector3(real(texel[0]), real(texel[1]), real(texel[2]))
    rgba = scene.part_rgba[part]
    return Vector3(
        wp.floor(wp.clamp(colour[0] * rgba[0], 0.0, 255.0)),
        wp.floor(wp.clamp(colour[1] * rgba[1], 0.0, 255.0)),
        wp.floor(wp.clamp(colour[2] * rgba[2], 0.0, 255.0)),
    )


@func
def is_lit(light: View, lighting: Lighting, point: Vector4) -> bool:
    """Nothing lies between the light and a point, given in homogeneous pixels of the light's view."""
    if point[3] <= 0.0:
        return True
    x = wp.round(point[0] / point[3])
    y = wp.round(point[1] / point[3])
    # Written so that NaN fails as well.
    if not (x >= 0.0 and y >= 0.0):
        return True
    if not (x < real(light.width) and y < real(light.height)):
        return True
    pixel = Int32(y) * light.width + Int32(x)
    nearer = (point[2] - lighting.bias_depth) / (point[3] - lighting.bias_w)
    return light.pixel_facet[pixel] < 0 or light.pixel_depth[pixel] >= nearer


@func
def lit(lighting: Lighting, colour: Vector3, normal: Vector3, shadow: real) -> wp.uint32:
    """A surface's colour under the light, packed."""
    towards = lighting.direction
    facing = wp.dot(normal, towards)
    # The highlight is where the light would be mirrored straight up, wherever the eye is: as in PyBullet.
    shine = wp.max(2.0 * facing * normal[2] - towards[2], 0.0)
    directed = shadow * (lighting.diffuse * wp.max(facing, 0.0) + lighting.specular * shine * shine)
    result = _OPAQUE
    for channel in range(3):
        strength = lighting.ambient + directed * lighting.colour[channel]
        value = wp.uint32(wp.clamp(colour[channel] * strength, 0.0, 255.0))
        result = result | (value << wp.uint32(8 * channel))
    return result


@func
def shade_pixel(
    scene: Scene, view: View, light: View, picture: Picture, lighting: Lighting, row: Int32, column: Int32
):
    """Writes colour, depth and label of a pixel whose facet is known."""
    pixel = row * view.width + column
    facet = view.pixel_facet[pixel]
    if facet < 0:
        picture.rgba[pixel] = _WHITE
        picture.depth[pixel] = wp.float32(1.0)
        picture.distance[pixel] = wp.float32(wp.inf)
        picture.label[pixel] = -1
        return
    place = Vector3(real(column), real(row), 1.0)
    # Perspective-correct: the weights of the corners in space, not on the screen.
    weights = Vector3(
        wp.dot(view.facet_first[facet], place),
        wp.dot(view.facet_second[facet], place),
        wp.dot(view.facet_third[facet], place),
    )
    inverse_w = weights[0] + weights[1] + weights[2]
    weights = weights / inverse_w
    u = weights[0]
    v = weights[1]
    w = weights[2]
    triangle = view.facet_triangle[facet]
    corners = scene.triangle_corners[triangle]
    part = scene.triangle_part[triangle]
    link = scene.part_link[part]
    normal = (
        scene.vertex_normal[corners[0]] * u
        + scene.vertex_normal[corners[1]] * v
        + scene.vertex_normal[corners[2]] * w
    )
    uv = scene.vertex_uv[corners[0]] * u + scene.vertex_uv[corners[1]] * v + scene.vertex_uv[corners[2]] * w
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
    normal = wp.normalize(picture.link_rotation[link] * normal)
    picture.rgba[pixel] = lit(lighting, surface_colour(scene, part, uv), normal, shadow)
    picture.depth[pixel] = wp.float32(0.5 + 0.5 * view.pixel_depth[pixel])
    picture.distance[pixel] = wp.float32(1.0 / inverse_w)
    picture.label[pixel] = scene.part_label[part]
