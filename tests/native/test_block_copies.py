"""Copies of blocks of memory, and which fields of tables have an axis of worlds."""

import numpy as np
import pytest

from carom.layouts.contacts import Contacts
from carom.layouts.model import Model, Scratch
from carom.native.block_copies import BlockCopies, copy_worlds
from carom.native.tables import ArrayTable


def test_as_much_is_copied_as_there_is_room_for():
    rng = np.random.default_rng(0)
    shapes = [
        ((2, 5, 3), (2, 4, 3)),
        ((7,), (7,)),
        ((1, 3), (1, 6)),
        ((0, 3), (4, 3)),
        ((2, 2, 4), (2, 2, 4)),
    ]
    pairs = [(rng.normal(size=a), rng.normal(size=b)) for a, b in shapes]
    wanted = [target.copy() for _, target in pairs]
    for (source, _), target in zip(pairs, wanted, strict=True):
        own = tuple(slice(min(both)) for both in zip(source.shape, target.shape, strict=True))
        target[own] = source[own]
    copy = BlockCopies(pairs)
    copy()
    for (_, target), expected in zip(pairs, wanted, strict=True):
        np.testing.assert_array_equal(target, expected)
    # The same copies again, of other numbers.
    pairs[1][0][:] = 5.0
    copy()
    assert (pairs[1][1] == 5.0).all()


def test_arrays_of_other_types_are_refused():
    with pytest.raises(ValueError, match="different types"):
        BlockCopies([(np.zeros(3), np.zeros(3, dtype=np.int32))])


def test_fields_of_structs_have_the_worlds_of_their_array():
    for struct in (Model, Scratch, Contacts):
        table = ArrayTable(struct, 3)
        for name, array in table.numpy.items():
            assert table.is_per_world(name) == (array.shape[0] == 3), name
    with pytest.raises(KeyError):
        ArrayTable(Model).is_per_world("nothing_there")


@pytest.mark.parametrize("rows", [0, 2])
def test_worlds_are_copied_to_others(rows: int):
    rng = np.random.default_rng(1)
    kind = np.dtype([("a", np.int32), ("b", np.float64)], align=True)
    structs = np.zeros((6, 4), kind)
    structs["b"] = rng.normal(size=(6, 4))
    # A saved state may have fewer rows of an axis than the present one.
    pairs: list[tuple[np.ndarray, np.ndarray]] = []
    pairs.append((rng.normal(size=(6, 3, 2)), rng.normal(size=(9, 5, 2) if rows else (9, 3, 2))))
    pairs.append((structs, np.zeros((9, 4), kind)))
    sources, targets = np.array([5, 0, 0, 2]), np.array([8, 1, 3, 0], dtype=np.int32)
    wanted = [target.copy() for _, target in pairs]
    for (source, _), target in zip(pairs, wanted, strict=True):
        if rows:
            target[targets, :rows] = source[sources, :rows]
        else:
            target[targets] = source[sources]
    copy_worlds([(source, target, rows) for source, target in pairs], sources, targets)
    for (_, target), expected in zip(pairs, wanted, strict=True):
        assert (target == expected).all()


def test_worlds_of_other_types_or_in_pieces_are_refused():
    numbers = np.array([0])
    with pytest.raises(ValueError, match="different types"):
        copy_worlds([(np.zeros((1, 3)), np.zeros((1, 3), np.float32), 0)], numbers, numbers)
    with pytest.raises(ValueError, match="not next to each other"):
        copy_worlds([(np.zeros((1, 3, 4))[:, :, :2], np.zeros((1, 3, 2)), 0)], numbers, numbers)
