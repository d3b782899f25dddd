"""Arrays on a device, with the parts of NumPy's array interface that `carom.worlds` uses."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import prod
from typing import Any

import numpy as np
import warp as wp

from carom.checks import OnDevice
from carom.gpu.indexing import Part, part_of
from carom.kernels.arrays import arithmetic as kernels

BLOCK_SIZE = 64
"""Threads per block. The solver's kernels use 255 registers per thread, and a multiprocessor has registers
for 256 such threads; small blocks fill it more evenly. Modules are compiled for one block size."""

_WARP_TYPES: dict[str, Any] = {
    "bool": wp.bool,
    "uint8": wp.uint8,
    "int32": wp.int32,
    "int64": wp.int64,
    "float32": wp.float32,
    "float64": wp.float64,
}
_MAX_AXES = 4
# Number of axes of the arrays that `combine_kernel` takes.
_COMBINED_AXES = 3
_REAL = np.dtype(np.float64)

NUMPY_FUNCTIONS: dict[Callable[..., Any], Callable[..., Any]] = {}
"""Implementations of NumPy functions for these arrays; `carom.gpu.arithmetic` fills it."""


class DeviceArray(OnDevice):
    """An array in the memory of a device. As with NumPy, slices give views, and lists of indices give copies.

    Writing to the array changes the memory on the device, without a copy to the host and back. Other
    libraries share this memory: `torch.from_dlpack(array)`, `jax.dlpack.from_dlpack(array)`,
    `__cuda_array_interface__`. NumPy gets a copy on the host: `numpy()` or `np.asarray(array)`.

    Attributes:
        shape: The shape.
        strides: Distance from one entry to the next along each axis [bytes].
        dtype: NumPy's type of the entries.
        pointer: Address of the first entry on the device.
        device: Warp's name of the device.
    """

    def __init__(
        self,
        owner: Any,
        pointer: int,
        shape: Sequence[int],
        strides: Sequence[int],
        dtype: np.dtype[Any],
        device: str,
    ) -> None:
        self._owner = owner
        self.pointer = pointer
        self.shape = tuple(shape)
        self.strides = tuple(strides)
        self.dtype = dtype
        self.device = device

    @classmethod
    def zeros(cls, shape: Sequence[int], dtype: np.dtype[Any], device: str) -> DeviceArray:
        """A contiguous array of zeros."""
        memory: Any = wp.zeros(max(1, prod(shape) * dtype.itemsize), dtype=wp.uint8, device=device)
        return cls(memory, memory.ptr, shape, _compact_strides(shape, dtype.itemsize), dtype, device)

    @classmethod
    def of(cls, array: Any) -> DeviceArray:
        """A view of a Warp array; its entries are numbers, or vectors and matrices of numbers."""
        inner = tuple(getattr(array.dtype, "_shape_", ()))
        dtype = np.dtype(wp.dtype_to_numpy(getattr(array.dtype, "_wp_scalar_type_", array.dtype)))
        strides = (*array.strides, *_compact_strides(inner, dtype.itemsize))
        return cls(array, array.ptr, (*array.shape, *inner), strides, dtype, str(array.device))

    def __repr__(self) -> str:
        return f"DeviceArray({self.numpy()!r}, device={self.device!r})"

    def __len__(self) -> int:
        return self.shape[0]

    @property
    def ndim(self) -> int:
        """Number of axes."""
        return len(self.shape)

    @property
    def size(self) -> int:
        """Number of entries."""
        return prod(self.shape)

    @property
    def nbytes(self) -> int:
        """Bytes of all entries."""
        return self.size * self.dtype.itemsize

    # Conversions

    def warp(self) -> Any:
        """The same memory as a Warp array, whose entries are scalars."""
        return self._as(self.shape or (1,), self.strides or (self.dtype.itemsize,))

    def numpy(self) -> np.ndarray:
        """A copy on the host."""
        if self.size == 0:
            return np.zeros(self.shape, self.dtype)
        return np.array(self.warp().numpy()).reshape(self.shape)

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> np.ndarray:
        values = self.numpy()
        return values if dtype is None else values.astype(dtype)

    def __dlpack__(self, stream: Any = None, **_: Any) -> Any:
        return self.warp().__dlpack__(stream=stream)

    def __dlpack_device__(self) -> tuple[int, int]:
        return self.warp().__dlpack_device__()

    @property
    def __cuda_array_interface__(self) -> dict[str, Any]:
        return self.warp().__cuda_array_interface__

    def copy(self) -> DeviceArray:
        """A contiguous copy on the device."""
        other = DeviceArray.zeros(self.shape, self.dtype, self.device)
        other[...] = self
        return other

    # Indexing and views

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, str):
            return self._field(key)
        part = part_of(self.shape, self.strides, key)
        view = self._view(part)
        if part.axis is None:
            return view
        picked = DeviceArray.zeros(part.picked_shape, self.dtype, self.device)
        if picked.size:
            wp.copy(picked.warp(), view._picking(part))
        return picked

    def __setitem__(self, key: Any, value: Any) -> None:
        part = part_of(self.shape, self.strides, key)
        target = self._view(part)
        shape = part.picked_shape
        if prod(shape) == 0:
            return
        source = self._here(value)
        if source.pointer == target.pointer and source.strides == target.strides:
            # `array[key] += value` ends by assigning the changed view to itself.
            return
        wp.copy(
            target._picking(part) if part.axis is not None else target.warp(), source.spread(shape).warp()
        )

    def _field(self, name: str) -> DeviceArray:
        """A view of one field of an array of structs."""
        dtype, offset = (self.dtype.fields or {})[name][:2]
        inner = dtype.shape
        strides = (*self.strides, *_compact_strides(inner, dtype.base.itemsize))
        return DeviceArray(
            self._owner, self.pointer + offset, (*self.shape, *inner), strides, dtype.base, self.device
        )

    def spread(self, shape: Sequence[int]) -> DeviceArray:
        """A view with a larger shape, as by `numpy.broadcast_to`.

        Raises:
            ValueError: The array does not broadcast to that shape.
        """
        given = (1,) * (len(shape) - self.ndim) + self.shape
        if len(given) != len(shape) or any(a not in (1, b) for a, b in zip(given, shape, strict=True)):
            raise ValueError(f"an array of shape {self.shape} does not broadcast to {tuple(shape)}")
        strides = (0,) * (len(shape) - self.ndim) + self.strides
        strides = tuple(0 if a == 1 else by for a, by in zip(given, strides, strict=True))
        return DeviceArray(self._owner, self.pointer, shape, strides, self.dtype, self.device)

    def reshape(self, *shape: int) -> DeviceArray:
        """The same entries in another shape: a view if the array is contiguous, otherwise a copy."""
        if self.strides != _compact_strides(self.shape, self.dtype.itemsize):
            return self.copy().reshape(*shape)
        known = prod(length for length in shape if length >= 0)
        whole = tuple(self.size // max(1, known) if length < 0 else length for length in shape)
        strides = _compact_strides(whole, self.dtype.itemsize)
        return DeviceArray(self._owner, self.pointer, whole, strides, self.dtype, self.device)

    def view(self, dtype: Any) -> DeviceArray:
        """The same memory with another type of entries, of the same size."""
        return DeviceArray(self._owner, self.pointer, self.shape, self.strides, np.dtype(dtype), self.device)

    def astype(self, dtype: np.dtype[Any]) -> DeviceArray:
        """A copy with entries of another type."""
        other = DeviceArray.zeros(self.shape, dtype, self.device)
        if self.size:
            wp.utils.array_cast(self.copy().warp(), other.warp())
        return other

    # Arithmetic in double precision

    def __add__(self, other: Any) -> DeviceArray:
        return self._combined(kernels.ADD, self, other)

    def __radd__(self, other: Any) -> DeviceArray:
        return self._combined(kernels.ADD, other, self)

    def __sub__(self, other: Any) -> DeviceArray:
        return self._combined(kernels.SUBTRACT, self, other)

    def __rsub__(self, other: Any) -> DeviceArray:
        return self._combined(kernels.SUBTRACT, other, self)

    def __mul__(self, other: Any) -> DeviceArray:
        return self._combined(kernels.MULTIPLY, self, other)

    def __rmul__(self, other: Any) -> DeviceArray:
        return self._combined(kernels.MULTIPLY, other, self)

    def __truediv__(self, other: Any) -> DeviceArray:
        return self._combined(kernels.DIVIDE, self, other)

    def __iadd__(self, other: Any) -> DeviceArray:
        self[...] = self + other
        return self

    # With None, NumPy arrays on the left of an operator leave it to the reflected methods above.
    __array_ufunc__ = None

    def __array_function__(self, function: Callable[..., Any], types: Any, args: Any, kwargs: Any) -> Any:
        ours = NUMPY_FUNCTIONS.get(function)
        return NotImplemented if ours is None else ours(*args, **kwargs)

    def _combined(self, operation: int, first: Any, second: Any) -> DeviceArray:
        return combine(operation, self.real(first), self.real(second))

    def real(self, value: Any) -> DeviceArray:
        """A value as doubles on the same device."""
        if not isinstance(value, DeviceArray):
            return DeviceArray.zeros((), _REAL, self.device)._here(value)
        return value if value.dtype == _REAL else value.astype(_REAL)

    # Comparisons copy the array to the host, and return NumPy arrays.

    def __eq__(self, other: object) -> Any:
        return self.numpy() == np.asarray(other)

    def __ne__(self, other: object) -> Any:
        return self.numpy() != np.asarray(other)

    def __lt__(self, other: Any) -> Any:
        return self.numpy() < np.asarray(other)

    def __le__(self, other: Any) -> Any:
        return self.numpy() <= np.asarray(other)

    def __gt__(self, other: Any) -> Any:
        return self.numpy() > np.asarray(other)

    def __ge__(self, other: Any) -> Any:
        return self.numpy() >= np.asarray(other)

    # Not hashable, because it is mutable.
    __hash__ = None  # type: ignore[assignment]

    def __int__(self) -> int:
        return int(self.numpy())

    def __float__(self) -> float:
        return float(self.numpy())

    # Implementation

    def _here(self, value: Any) -> DeviceArray:
        """A value as an array on this device, with entries of this type."""
        if isinstance(value, DeviceArray):
            return value if value.dtype == self.dtype else value.astype(self.dtype)
        host = np.ascontiguousarray(np.asarray(value), dtype=self.dtype)
        shape = np.shape(value)
        here = DeviceArray.zeros(shape, self.dtype, self.device)
        if here.size:
            # Copied as bytes, because entries may be structs.
            wp.copy(here._owner, wp.array(host.reshape(-1).view(np.uint8), dtype=wp.uint8, device="cpu"))
        return here

    def _view(self, part: Part) -> DeviceArray:
        return DeviceArray(
            self._owner, self.pointer + part.offset, part.shape, part.strides, self.dtype, self.device
        )

    def _picking(self, part: Part) -> Any:
        """The entries that a part selects, as an indexed Warp array."""
        picks: list[Any] = [None] * len(self.shape)
        picks[part.axis or 0] = wp.array(part.picks, dtype=wp.int32, device=self.device)
        return wp.indexedarray(self.warp(), picks)

    def _as(self, shape: Sequence[int], strides: Sequence[int]) -> Any:
        if len(shape) > _MAX_AXES:
            raise ValueError(f"an array of {len(shape)} axes has too many")
        dtype = self.dtype
        if dtype.names is not None:
            # Structs are copied as bytes.
            return wp.array(
                ptr=self.pointer, dtype=wp.uint8, shape=(*shape, dtype.itemsize), strides=(*strides, 1),
                device=self.device,
            )  # fmt: skip
        array: Any = wp.array(
            ptr=self.pointer,
            dtype=_WARP_TYPES[dtype.name],
            shape=tuple(shape),
            strides=tuple(strides),
            device=self.device,
        )
        array.owner = self._owner
        return array


def _compact_strides(shape: Sequence[int], size: int) -> tuple[int, ...]:
    """Strides of a contiguous array [bytes]."""
    return tuple(size * prod(shape[axis + 1 :]) for axis in range(len(shape)))


def combine(operation: int, first: DeviceArray, second: DeviceArray) -> DeviceArray:
    """Combine two arrays of doubles entry by entry, by an operation of `carom.kernels.arrays.arithmetic`.

    Raises:
        ValueError: The shapes do not broadcast to each other, or have more than three axes.
    """
    shape = np.broadcast_shapes(first.shape, second.shape)
    if len(shape) > _COMBINED_AXES:
        raise ValueError(f"arrays of {len(shape)} axes cannot be combined; {_COMBINED_AXES} are the maximum")
    result = DeviceArray.zeros(shape, _REAL, first.device)
    if result.size:
        dim = (1,) * (_COMBINED_AXES - len(shape)) + shape
        arrays = [array.spread(dim).warp() for array in (result.reshape(*dim), first, second)]
        wp.launch(
            kernels.combine_kernel,
            dim=dim,
            inputs=[*arrays, operation],
            device=first.device,
            block_dim=BLOCK_SIZE,
        )
    return result
