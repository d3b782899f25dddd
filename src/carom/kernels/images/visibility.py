"""Visibility: which triangle is seen in which pixel.

Triangles are rasterised without clipping, in homogeneous pixel coordinates (x w, y w, w) of their corners.
The weights with which the three corners sum to (column, row, 1) are affine functions of column and row, and
so is the depth. All three weights are positive inside the triangle and only there. A point behind the camera
has a negative weight.
"""

import warp as wp

from carom.kernels.structs import Scene, View
from carom.kernels.types import Index4, Int32, Matrix4, Vector2, Vector3, Vector4, func, real

# A pixel that is this far outside an edge still counts as on the edge [pixels].
_ON_EDGE = real(1.0e-7)
_HUGE = real(1.0e9)
_FEW_COLUMNS = wp.constant(4)


@func
def is_beyond(matrix: Matrix4, plane: Vector4, centre: Vector3, radius: real) -> bool:
    """Whether a linear function of the homogeneous pixel coordinates is negative in a whole sphere."""
    f = plane * matrix
    across = wp.length(Vector3(f[0], f[1], f[2]))
    return f[0] * centre[0] + f[1] * centre[1] + f[2] * centre[2] + f[3] + radius * across < 0.0


@func
def is_absent_matrix(matrix: Matrix4) -> bool:
    """Whether a matrix is that of a link of an absent body, all zeros."""
    return matrix[3, 0] == 0.0 and matrix[3, 1] == 0.0 and matrix[3, 2] == 0.0 and matrix[3, 3] == 0.0


@func
def is_out_of_sight(scene: Scene, view: View, part: Int32, matrix: Matrix4) -> bool:
    """Whether the bounding sphere of a part is outside the view, so that no pixel can show the part."""
    centre = scene.part_centre[part]
    radius = scene.part_radius[part]
    right = real(view.width - 1)
    bottom = real(view.height - 1)
    return (
        is_beyond(matrix, Vector4(1.0, 0.0, 0.0, 0.0), centre, radius)
        or is_beyond(matrix, Vector4(-1.0, 0.0, 0.0, right), centre, radius)
        or is_beyond(matrix, Vector4(0.0, 1.0, 0.0, 0.0), centre, radius)
        or is_beyond(matrix, Vector4(0.0, -1.0, 0.0, bottom), centre, radius)
        or is_beyond(matrix, Vector4(0.0, 0.0, 1.0, 1.0), centre, radius)
        or is_beyond(matrix, Vector4(0.0, 0.0, -1.0, 1.0), centre, radius)
    )


@func
def widened(bounds: Vector4, p: Vector4) -> Vector4:
    """Bounds extended to include a point; unlimited if the point is not in front of the camera."""
    if p[3] <= 0.0:
        return Vector4(-_HUGE, -_HUGE, _HUGE, _HUGE)
    x, y = p[0] / p[3], p[1] / p[3]
    return Vector4(wp.min(bounds[0], x), wp.min(bounds[1], y), wp.max(bounds[2], x), wp.max(bounds[3], y))


@func
def widened_by_edge(bounds: Vector4, a: Vector4, b: Vector4) -> Vector4:
    """Bounds extended to include an edge's first corner and the edge's intersection with the near plane.

    The corner is left out if it is before the near plane.
    """
    above_a, above_b = a[2] + a[3], b[2] + b[3]
    result = bounds
    if above_a >= 0.0:
        result = widened(result, a)
    if (above_a >= 0.0) != (above_b >= 0.0):
        result = widened(result, a + (b - a) * (above_a / (above_a - above_b)))
    return result


@func
def add_facet(view: View, facet: Int32, triangle: Int32, corners: wp.vec3i, two_sided: Int32) -> bool:
    """Prepare a triangle to be filled; returns false if it cannot be visible."""
    a = view.vertex_pixel[corners[0]]
    b = view.vertex_pixel[corners[1]]
    c = view.vertex_pixel[corners[2]]
    first = wp.cross(Vector3(b[0], b[1], b[3]), Vector3(c[0], c[1], c[3]))
    volume = first[0] * a[0] + first[1] * a[1] + first[2] * a[3]
    if volume == 0.0 or (two_sided == 0 and volume * view.facing[0] < 0.0):
        return False
    if a[2] > a[3] and b[2] > b[3] and c[2] > c[3]:
        return False
    bounds = Vector4(_HUGE, _HUGE, -_HUGE, -_HUGE)
    bounds = widened_by_edge(bounds, a, b)
    bounds = widened_by_edge(bounds, b, c)
    bounds = widened_by_edge(bounds, c, a)
    left = wp.max(wp.ceil(bounds[0] - _ON_EDGE), 0.0)
    top = wp.max(wp.ceil(bounds[1] - _ON_EDGE), 0.0)
    right = wp.min(wp.floor(bounds[2] + _ON_EDGE), real(view.width - 1))
    bottom = wp.min(wp.floor(bounds[3] + _ON_EDGE), real(view.height - 1))
    # Written so that NaN fails the test as well.
    if not (left <= right and top <= bottom):
        return False
    scale = 1.0 / volume
    first = first * scale
    second = wp.cross(Vector3(c[0], c[1], c[3]), Vector3(a[0], a[1], a[3])) * scale
    third = wp.cross(Vector3(a[0], a[1], a[3]), Vector3(b[0], b[1], b[3])) * scale
    view.facet_first[facet] = first
    view.facet_second[facet] = second
    view.facet_third[facet] = third
    view.facet_depth[facet] = first * a[2] + second * b[2] + third * c[2]
    view.facet_box[facet] = Index4(Int32(left), Int32(top), Int32(right), Int32(bottom))
    view.facet_triangle[facet] = triangle
    return True


@func
def first_facet_of(scene: Scene, chunk: Int32) -> Int32:
    """Where the facets of a chunk begin, if those of all are kept: at the index of its first triangle."""
    return scene.part_first_triangle[scene.chunk_first_part[chunk]]


@func
def project_chunk(scene: Scene, view: View, chunk: Int32, first_link: Int32, first_facet: Int32):
    """Write the facets of a chunk, from `first_facet` on; the matrices of the links begin at `first_link`."""
    facet = Int32(first_facet)
    for part in range(scene.chunk_first_part[chunk], scene.chunk_first_part[chunk + 1]):
        matrix = view.link_to_pixel[first_link + scene.part_link[part]]
        if (
            scene.part_rgba[part][3] == 0.0
            or is_absent_matrix(matrix)
            or is_out_of_sight(scene, view, part, matrix)
        ):
            continue
        for vertex in range(scene.part_first_vertex[part], scene.part_first_vertex[part + 1]):
            p = scene.vertex_position[vertex]
            view.vertex_pixel[vertex] = matrix * Vector4(p[0], p[1], p[2], 1.0)
        two_sided = scene.part_two_sided[part]
        for triangle in range(scene.part_first_triangle[part], scene.part_first_triangle[part + 1]):
            if add_facet(view, facet, triangle, scene.triangle_corners[triangle], two_sided):
                facet += 1
    view.chunk_facet_count[chunk] = facet - first_facet


@func
def where_positive(span: Vector2, slope: real, start: real) -> Vector2:
    """The part of a span of columns in which slope * column + start >= 0."""
    if slope > 0.0:
        return Vector2(wp.max(span[0], -start / slope), span[1])
    if slope < 0.0:
        return Vector2(span[0], wp.min(span[1], -start / slope))
    return Vector2(_HUGE, -_HUGE) if start < 0.0 else span


@func
def is_inside(slope: real, column: real, start: real) -> bool:
    """Whether slope * column + start >= 0, or the column is just beside those where it is."""
    value = slope * column + start
    # Where the slope is 0, no other column is better.
    return value >= -_ON_EDGE * wp.abs(slope)


@func
def fill_small_facet(view: View, facet: Int32, left: Int32, right: Int32, top: Int32, bottom: Int32):
    """As `fill_facet`, pixel by pixel: for few columns that is quicker than to find out which are inside."""
    first = view.facet_first[facet]
    second = view.facet_second[facet]
    third = view.facet_third[facet]
    depth = view.facet_depth[facet]
    for row in range(top, bottom + 1):
        y = real(row)
        first_start = first[1] * y + first[2]
        second_start = second[1] * y + second[2]
        third_start = third[1] * y + third[2]
        start = depth[1] * y + depth[2]
        line = row * view.width
        for column in range(left, right + 1):
            x = real(column)
            if (
                is_inside(first[0], x, first_start)
                and is_inside(second[0], x, second_start)
                and is_inside(third[0], x, third_start)
                and is_inside(depth[0], x, start + 1.0)
                and is_inside(-depth[0], x, 1.0 - start)
            ):
                z = depth[0] * x + start
                if z <= view.pixel_depth[line + column]:
                    view.pixel_depth[line + column] = z
                    view.pixel_facet[line + column] = facet


@func
def fill_facet(view: View, facet: Int32, first_row: Int32, end_row: Int32):
    """Write a facet to the pixels of rows first_row <= row < end_row that show no nearer facet so far."""
    box = view.facet_box[facet]
    top = wp.max(box[1], first_row)
    bottom = wp.min(box[3], end_row - 1)
    if top > bottom:
        return
    if box[2] - box[0] < _FEW_COLUMNS:
        fill_small_facet(view, facet, box[0], box[2], top, bottom)
        return
    first = view.facet_first[facet]
    second = view.facet_second[facet]
    third = view.facet_third[facet]
    depth = view.facet_depth[facet]
    for row in range(top, bottom + 1):
        y = real(row)
        span = Vector2(real(box[0]), real(box[2]))
        span = where_positive(span, first[0], first[1] * y + first[2])
        span = where_positive(span, second[0], second[1] * y + second[2])
        span = where_positive(span, third[0], third[1] * y + third[2])
        start = depth[1] * y + depth[2]
        span = where_positive(span, depth[0], start + 1.0)
        span = where_positive(span, -depth[0], 1.0 - start)
        if span[0] - _ON_EDGE <= span[1] + _ON_EDGE:
            line = row * view.width
            for column in range(Int32(wp.ceil(span[0] - _ON_EDGE)), Int32(wp.floor(span[1] + _ON_EDGE)) + 1):
                z = depth[0] * real(column) + start
                if z <= view.pixel_depth[line + column]:
                    view.pixel_depth[line + column] = z
                    view.pixel_facet[line + column] = facet


@func
def clear_rows(view: View, first_row: Int32, end_row: Int32):
    """Set the pixels in a range of rows to the background."""
    for pixel in range(first_row * view.width, end_row * view.width):
        view.pixel_depth[pixel] = 1.0
        view.pixel_facet[pixel] = -1


@func
def fill_facets(view: View, chunk: Int32, first_facet: Int32, first_row: Int32, end_row: Int32):
    """Write the facets of a chunk, which begin at `first_facet`, to the pixels in a range of rows."""
    for facet in range(first_facet, first_facet + view.chunk_facet_count[chunk]):
        fill_facet(view, facet, first_row, end_row)


@func
def fill_rows(scene: Scene, view: View, first_row: Int32, end_row: Int32):
    """Find the nearest facet of every pixel in a range of rows; the last one of equally near facets."""
    clear_rows(view, first_row, end_row)
    for chunk in range(view.chunk_facet_count.shape[0]):
        fill_facets(view, chunk, first_facet_of(scene, chunk), first_row, end_row)


@func
def fill_view(scene: Scene, view: View, first_link: Int32, kept: Int32):
    """Find the nearest facet of every pixel; the facets are kept for shading if `kept` is 1.

    A chunk is filled while its facets are in the processor's caches. Without shading all chunks have the same
    place for them.
    """
    clear_rows(view, 0, view.height)
    for chunk in range(view.chunk_facet_count.shape[0]):
        first_facet = kept * first_facet_of(scene, chunk)
        project_chunk(scene, view, chunk, first_link, first_facet)
        fill_facets(view, chunk, first_facet, 0, view.height)
