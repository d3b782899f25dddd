"""Arrays of zeros are mapped from the system, and memory that cannot be had is a `MemoryError`."""

import errno
import mmap
import os

import numpy as np
import pytest

from carom.native.arrays import zeros


def test_arrays_of_any_size_are_zero_and_can_be_written():
    for count in (0, 10, 10**6):
        array = zeros((count, 2), np.dtype(np.float64))
        assert array.shape == (count, 2) and not array.any()
        array[:] = 1.0


def test_arrays_are_of_no_file():
    """As Python's `mmap` takes the number of an open file, of which there may be none."""
    output = os.dup(1)
    os.close(1)
    try:
        array = zeros((10**6,), np.dtype(np.float64))
    finally:
        os.dup2(output, 1)
        os.close(output)
    array[:] = 1.0
    assert array.sum() == 10**6


def test_memory_that_cannot_be_had_is_a_memory_error(monkeypatch: pytest.MonkeyPatch):
    def refused(*_: object, **__: object) -> None:
        raise OSError(errno.ENOMEM, "Cannot allocate memory")

    monkeypatch.setattr(mmap, "mmap", refused)
    with pytest.raises(MemoryError, match=r"16000000 bytes .* \(1000000, 2\)"):
        zeros((10**6, 2), np.dtype(np.float64))
