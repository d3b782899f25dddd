"""Addresses for quick calls: the kernels that place shapes and find nearest points."""

from __future__ import annotations

from collections.abc import Sequence
from ctypes import addressof, c_char
from sys import intern
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from carom.engine.queries.question import Question
    from carom.engine.quick_scene import QuickScene
    from carom.layouts.programs import KernelCall
    from carom.model.shape_arrays import ShapeArrays
    from carom.native.launch import Launch
    from carom.native.tables import ArrayTable

# Attribute names are interned strings.
_CHANGES = intern("changes")


def tell_placement(
    quick: QuickScene,
    kernels: Sequence[Launch],
    shapes: ShapeArrays,
    pairs: ArrayTable,
    state: Sequence[Any],
    placed_at: bytearray,
    places: Any,
    *,
    readiness: int,
    has_bare_links: bool,
) -> None:
    """Set the addresses of the kernels that place the shapes of all links.

    Args:
        quick: The record of addresses.
        kernels: The kernel that places shapes, and the one that computes the link poses before.
        shapes: The shapes.
        pairs: The workspace of collision detection, with the poses and bounds of the shapes.
        state: The memory of the coordinates of all bodies, and that of the poses of all links.
        placed_at: The coordinates for which the shapes were last placed.
        places: Struct with the body and link of each link row.
        readiness: Column of `count_pairs` that says which data of the shapes are up to date.
        has_bare_links: Whether there are links without shapes.
    """
    record = quick.record.placement
    positions, poses = state
    arrays, found = shapes.table.struct(), pairs.struct()
    poses_before = np.empty(poses.nbytes // 8)
    quick.keep(kernels, shapes, arrays, found, positions, poses, poses_before, placed_at, places)
    record.positions, record.position_count = _address(positions), positions.nbytes // 8
    record.placed_at = _address(placed_at)
    record.poses, record.pose_count = _address(poses), len(poses_before)
    record.poses_before = poses_before.ctypes.data
    record.readiness = found.count_pairs.data + 4 * readiness
    record.shapes, record.changes_name = id(shapes), id(_CHANGES)
    record.lower, record.upper = found.shape_lower.data, found.shape_upper.data
    record.kind, record.link = arrays.shape_kind.data, arrays.shape_link.data
    record.path = arrays.shape_path.data
    record.shape_count = shapes.shape_count
    record.first_shape, record.link_shapes = arrays.link_first_shape.data, arrays.link_shape_count.data
    record.place_body, record.place_link = places.place_body.data, places.place_link.data
    record.has_bare_links = has_bare_links
    place, find_poses = kernels
    _tell_kernel(record.find_poses, find_poses)
    # This one is set last: without it the other addresses are not used.
    _tell_kernel(record.place, place)


def tell_search(quick: QuickScene, question: Question) -> None:
    """Set the addresses of the kernel that finds nearest points; the query's arrays are `Searches`."""
    record = quick.record.nearest
    searches = question.arrays.struct()
    quick.keep(question.launch, searches)
    *_, record.count, record.max_distance = question.launch.addresses("count", "max_distance")
    record.first, record.second = searches.search_first.data, searches.search_second.data
    record.room = question.room
    record.found, record.pairs = searches.search_count.data, searches.search_pair.data
    record.points = searches.search_found.data
    _tell_kernel(record.search, question.launch)


def _tell_kernel(record: KernelCall, launch: Launch) -> None:
    function, record.bounds, record.arguments = launch.addresses()
    record.function = function


def _address(memory: Any) -> int:
    return addressof(c_char.from_buffer(memory))
