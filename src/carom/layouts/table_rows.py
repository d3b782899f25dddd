"""Rows of tables that native code puts in and takes out, and memory that it copies."""

from carom.layouts.programs import TreeCall
from carom.layouts.records import Bytes, Int64, Read, c_record


@c_record()
class RowField:
    """An array: for each of `worlds`, the rows of one axis."""

    memory: Bytes
    worlds: Int64
    world_bytes: Int64
    row_bytes: Int64
    axis: Int64


@c_record()
class RowReference:
    """Row numbers of the axis `target`, so many in each row of `axis`; negative ones stand for no row."""

    memory: Bytes
    row_bytes: Int64
    numbers: Int64
    axis: Int64
    target: Int64


@c_record()
class RowTable:
    """The arrays of one table or several, and those of them that contain row numbers."""

    columns: Read[RowField]
    references: Read[RowReference]
    column_count: Int64
    reference_count: Int64


@c_record()
class Block:
    """Memory to be copied."""

    source: Bytes
    target: Bytes
    size: Int64


@c_record()
class WorldBlock:
    """Memory of each of many worlds to be copied: so many bytes from and to where worlds are so far apart."""

    source: Bytes
    target: Bytes
    source_bytes: Int64
    target_bytes: Int64
    size: Int64


@c_record()
class RowCut:
    """Consecutive rows to be taken out of each axis of a table; there are `used` rows."""

    table: Read[RowTable]
    first: Read[Int64]
    count: Read[Int64]
    used: Read[Int64]


@c_record()
class KernelRun:
    """A launch of a kernel, on a tree where it has one."""

    call: TreeCall
    tree: Int64
