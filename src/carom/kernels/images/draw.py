"""Kernels of the rasteriser. A launch is one thread: a chunk of triangles, a range of rows, or an image."""

from carom.kernels.images.shading import shade_row
from carom.kernels.images.visibility import fill_rows, fill_view, first_facet_of, project_chunk
from carom.kernels.structs import Picture, Scene, View
from carom.kernels.types import Int32, kernel


@kernel
def project_kernel(scene: Scene, view: View, chunk: Int32):
    """Find the triangles of a chunk that may be visible."""
    project_chunk(scene, view, chunk, 0, first_facet_of(scene, chunk))


@kernel
def depth_kernel(scene: Scene, view: View, first_row: Int32, end_row: Int32):
    """Find the smallest depth in each pixel of a range of rows."""
    fill_rows(scene, view, first_row, end_row)


@kernel
def image_kernel(scene: Scene, view: View, light: View, picture: Picture, first_row: Int32, end_row: Int32):
    """Draw a range of rows of an image."""
    fill_rows(scene, view, first_row, end_row)
    lighting = picture.lighting[0]
    for row in range(first_row, end_row):
        shade_row(scene, view, light, picture, lighting, 0, 0, row)


@kernel
def shadow_map_kernel(scene: Scene, light: View, links: Int32, first_world: Int32):
    """Find the smallest depth in each pixel of the view from the light, in one world with so many links."""
    fill_view(scene, light, first_world * links, 0)


@kernel
def whole_image_kernel(
    scene: Scene, view: View, light: View, picture: Picture, links: Int32, first_world: Int32
):
    """Draw the image of one world with so many links, after `shadow_map_kernel` if there are shadows."""
    lighting = picture.lighting[first_world]
    first_link = first_world * links
    fill_view(scene, view, first_link, 1)
    first_pixel = first_world * view.width * view.height
    for row in range(view.height):
        shade_row(scene, view, light, picture, lighting, first_link, first_pixel, row)
