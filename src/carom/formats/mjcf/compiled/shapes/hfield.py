"""`<hfield>` assets: terrain from numbers in the document, images or binary files."""

from __future__ import annotations

from io import BytesIO
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from carom.description import Heightfield, Pose
from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.files.budget import charge
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.defaults import Attributes
from carom.formats.robot.context import shown

_HEADER = 8


def read_hfield(
    context: CompiledContext, element: Element, attributes: Attributes
) -> tuple[Heightfield, Pose]:
    """The terrain of a geom, and its pose in the frame of the geom.

    Raises:
        DescriptionError: There is no such asset, or its heights cannot be had.
    """
    name = attributes.get("hfield", "")
    asset = context.named.hfield.get(name)
    if asset is None:
        raise context.error(element, f"there is no hfield {shown(name)}")
    asset.note()
    half_x, half_y, top, _ = context.numbers(asset, "size", context.required(asset, "size"), 4, 4)
    # Assets of one file are one shape: its triangles are made once.
    what = (half_x, half_y, top, asset.attributes.get("file") or id(asset))
    if (known := context.terrains.get(what)) is not None:
        return known, Pose()
    heights = _heights(context, asset)
    rows, columns = heights.shape
    if min(rows, columns) < 2:
        raise context.error(asset, f"a height field needs 2 x 2 heights or more, not {rows} x {columns}")
    low, high = heights.min(), heights.max()
    scaled = (heights - low) / (high - low) if high > low else np.zeros_like(heights)
    scale = (2.0 * half_x / (columns - 1), 2.0 * half_y / (rows - 1), top)
    made = context.terrains[what] = Heightfield(scaled, scale, 0.0)
    return made, Pose()


def _heights(context: CompiledContext, asset: Element) -> NDArray[np.float64]:
    """Heights (rows along y, columns along x), of any scale."""
    attributes = asset.attributes
    if "file" in attributes:
        return _from_file(context, asset, attributes["file"])
    rows = int(context.number(asset, attributes, "nrow", 0.0))
    columns = int(context.number(asset, attributes, "ncol", 0.0))
    if rows < 2 or columns < 2:
        raise context.error(asset, "a height field needs a file, or nrow and ncol of 2 or more")
    if "elevation" not in attributes:
        context.leave_out(asset, "it is flat", "programs set its heights in MuJoCo")
        _charge(context, asset, rows, columns)
        return np.zeros((rows, columns))
    numbers = context.singles(asset, "elevation", attributes["elevation"])
    if len(numbers) != rows * columns:
        raise context.error(asset, f"elevation has {len(numbers)} numbers; nrow times ncol are needed")
    _charge(context, asset, rows, columns)
    # The first row of the text is the one with the greatest y.
    return np.array(numbers).reshape(rows, columns)[::-1]


def _charge(context: CompiledContext, asset: Element, rows: int, columns: int) -> None:
    """Take a height field from the budget: each height is a vertex of two triangles."""
    charge(
        "vertices", 3 * rows * columns, file=context.file_of(asset), line=asset.line, element=f"<{asset.tag}>"
    )


def _from_image(context: CompiledContext, asset: Element, path: Path) -> NDArray[np.float64]:
    """The grey values of a PNG file, the greatest y first in the file."""
    from PIL import Image

    with reading(path):
        data, _ = read_bounded(path)
        with Image.open(BytesIO(data)) as image:
            charge("pixels", image.width * image.height)
            _charge(context, asset, image.height, image.width)
            return np.asarray(image.convert("L"), dtype=np.float64)[::-1]


def _from_file(context: CompiledContext, asset: Element, name: str) -> NDArray[np.float64]:
    path = context.asset_file(asset, name, context.compiler.mesh_directory)
    if path is None:
        raise context.not_found(asset, name)
    if path.suffix.lower() == ".png":
        return _from_image(context, asset, path)
    data, _ = read_bounded(path)
    if len(data) < _HEADER:
        raise context.error(asset, f"{shown(name)} is too short for a height field")
    rows, columns = (int(n) for n in np.frombuffer(data, "<i4", 2))
    if rows < 2 or columns < 2 or len(data) != _HEADER + 4 * rows * columns:
        raise context.error(asset, f"{shown(name)} does not hold the {rows} x {columns} heights it states")
    _charge(context, asset, rows, columns)
    return np.frombuffer(data, "<f4", rows * columns, _HEADER).reshape(rows, columns).astype(np.float64)
