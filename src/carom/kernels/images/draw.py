"""The kernels of the renderer. Each launch is one thread that handles a chunk of triangles or some rows."""

from carom.kernels.images.shading import shade_row
from carom.kernels.images.visibility import fill_rows, project_chunk
from carom.kernels.structs import Picture, Scene, View
from carom.kernels.types import Int32, kernel


@kernel
def project_kernel(scene: Scene, view: View, chunk: Int32):
    """Finds the triangles of a chunk that may be seen."""
    project_chunk(scene, view, chunk)


@kernel
def depth_kernel(scene: Scene, view: View, first_row: Int32, end_row: Int32):
    """Finds the nearest depth in each pixel of some rows."""
    fill_rows(scene, view, first_row, end_row)


@kernel
def image_kernel(scene: Scene, view: View, light: View, picture: Picture, first_row: Int32, end_row: Int32):
    """Draws some rows of an image."""
    fill_rows(scene, view, first_row, end_row)
    lighting = picture.lighting[0]
    for row in range(first_row, end_row):
        shade_row(scene, view, light, picture, lighting, row)
