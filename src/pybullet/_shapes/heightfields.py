"""Heightfields: heights from arrays and files."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from carom import description
from carom.description.pose import Vector3
from carom.errors import DescriptionError
from carom.files.boundary import reading
from carom.files.bounded import read_bounded
from carom.files.budget import charge
from carom.native.change import Change
from carom.native.uninterrupted import uninterrupted
from pybullet._calls.arguments import MAX_ITEMS
from pybullet._calls.errors import fail
from pybullet._calls.nested import nested

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from pybullet._clients.clients import Client


_WRONG_SIZE = "Size of heightfieldData doesn't match numHeightfieldColumns*numHeightfieldRows"


def heights_from_data(values: Any, rows: int, columns: int, problem: str) -> NDArray[np.float64]:
    """Heights (columns along y, rows along x) from rows * columns numbers, with x varying fastest.

    They are rounded to single precision, as in PyBullet.
    """
    import numpy as np

    try:
        given = nested(values, problem, "heightfieldData", max(rows * columns, MAX_ITEMS))
        flat = np.array(given, dtype=np.float64).reshape(-1)
    except (TypeError, ValueError):
        fail(problem, "heightfieldData has to be a sequence of numbers.")
    if len(flat) != rows * columns:
        fail(_WRONG_SIZE, f"It has {len(flat)} numbers instead of {columns} * {rows}.")
    return _checked(flat.reshape(columns, rows), problem)


def heights_from_file(path: Path, problem: str) -> NDArray[np.float64]:
    """Heights (points along y, along x) from the numbers of a text or the red channel (0 to 1) of an image.

    As in PyBullet, the numbers of a text are taken column by column and fill rows along x: if there are as
    many lines as columns, each line is a row along y. An image is a view from above, mirrored along x.
    """
    import numpy as np

    if path.suffix.lower() != ".txt":
        from carom.render.images import read_image

        try:
            with reading(path):
                red = read_image(path)[:, ::-1, 0]
                charge("vertices", 3 * red.size)
        except DescriptionError as reason:
            fail(problem, str(reason))
        return _checked((red * (1.0 / 255.0)).astype(np.float64), problem)
    try:
        with reading(path):
            lines = read_bounded(path)[0].decode("utf-8").splitlines()
            charge("vertices", sum(3 + 3 * line.count(",") for line in lines))
    except DescriptionError as reason:
        fail(problem, str(reason))
    try:
        rows = [[float(word) for word in line.split(",") if word.strip()] for line in lines if line.strip()]
    except ValueError as reason:
        fail(problem, f"{path}: {reason}.")
    if len({len(row) for row in rows}) != 1:
        fail(problem, f"{path}: the lines do not all have the same number of values.")
    values = np.array(rows)
    height, width = values.shape
    # As in PyBullet: column by column, but in an array of the shape of the text.
    return _checked(values.T.reshape(height, width), problem, rounded=False)


def _checked(heights: NDArray[np.float64], problem: str, *, rounded: bool = True) -> NDArray[np.float64]:
    import numpy as np

    if min(heights.shape) < 2:
        columns, rows = heights.shape
        fail(problem, f"A heightfield needs at least 2 x 2 points, not {rows} x {columns}.")
    if rounded:
        with np.errstate(over="ignore"):
            heights = heights.astype(np.float32).astype(np.float64)
    if not np.isfinite(heights).all():
        fail(problem, "A height is not finite.")
    return heights


def heightfield(heights: NDArray[np.float64], scale: Vector3, problem: str) -> description.Heightfield:
    """A heightfield with the mean of its minimum and maximum height at the origin."""
    from carom.geometry.hull import SMALLEST

    if min(map(abs, scale[:2])) < SMALLEST:
        fail(problem, f"meshScale is {list(scale)}; its x and y must not be 0, nor less than {SMALLEST:g}.")
    return description.Heightfield(heights, scale, 0.5 * float(heights.min() + heights.max()))


def replace_heights(client: Client, number: int, heights: NDArray[np.float64], problem: str) -> None:
    """Replace the heights (points along y, points along x) of a shape, and of all bodies made of it.

    Their number and the position of the heightfield do not change.
    """
    shape = client.shapes.collisions.get(number)
    if shape is None:
        fail(problem, f"replaceHeightfieldIndex: there is no shape {number}.")
    old = shape.collisions[0].geometry
    if not isinstance(old, description.Heightfield):
        fail(problem, f"replaceHeightfieldIndex: shape {number} is not a heightfield.")
    if heights.shape != old.heights.shape:
        (columns, rows), (new_columns, new_rows) = old.heights.shape, heights.shape
        fail(problem, f"The heightfield has {rows} x {columns} points, not {new_rows} x {new_columns}.")
    new = description.Heightfield(heights, old.scale, old.middle)
    with client.call_lock, uninterrupted:
        change = Change()
        change.set(shape, "collisions", (description.Collision(new, shape.collisions[0].frame),))
        _renew_bodies(change, client, old, new)
        change.commit()


def _renew_bodies(
    change: Change, client: Client, old: description.Heightfield, new: description.Heightfield
) -> None:
    from carom.layouts.flags import LoadFlags
    from carom.render.appearance import appearance_of

    appearance = appearance_of(client.world)
    for body in client.world.bodies.values():
        implicit = bool(body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
        for link in range(-1, body.joint_count):
            spec = body.link_spec(link)
            if not any(it.geometry is old for it in spec.collisions):
                continue
            collisions = tuple(
                replace(it, geometry=new) if it.geometry is old else it for it in spec.collisions
            )
            visuals = tuple(replace(it, geometry=new) if it.geometry is old else it for it in spec.visuals)
            change.set(spec, "collisions", collisions)
            change.set(spec, "visuals", visuals)
            client.world.contact_arrays.shapes.replace_pieces(
                change,
                body.first_link + 1 + link,
                replace(spec, collisions=collisions, visuals=visuals),
                implicit_cylinder=implicit,
            )
            client.bodies.forget(body.id)
            for look in appearance.shapes(body, link):
                if look.geometry is old:
                    change.set(look, "geometry", new)
                    change.set(appearance, "changes", change.get(appearance, "changes") + 1)
