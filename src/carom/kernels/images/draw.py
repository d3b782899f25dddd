"""Kernels of the rasteriser. Each launch is one thread, for a chunk of triangles or a range of rows."""

from carom.kernels.images.shading import shade_row
from carom.kernels.images.visibility import fill_rows, project_chunk
from carom.kernels.structs import Picture, Scene, View
from carom.kernels.types import Int32, kernel


@kernel
def project_kernel(scene: Scene, view: View, chunk: Int32):
    """Find the triangles of a chunk that may be visible."""
    project_chunk(scene, view, chunk)


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
        shade_row(scene, view, light, picture, lighting, row)
