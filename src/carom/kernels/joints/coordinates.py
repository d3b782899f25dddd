"""Numbers of arrays as vectors and quaternions: of worlds (rows), and of one mechanism or chain."""

import warp as wp

from carom.kernels.structs import State
from carom.kernels.types import Int32, Quaternion, RealRows, Reals, Vector3, func


@func
def three_numbers(rows: RealRows, world: Int32, first: Int32) -> Vector3:
    """The numbers of a world from `first` on, as a vector."""
    return Vector3(rows[world, first], rows[world, first + 1], rows[world, first + 2])


@func
def load_quaternion(state: State, world: Int32, q: Int32) -> Quaternion:
    """The quaternion in coordinates `q` to `q + 3`."""
    xyz = three_numbers(state.position, world, q)
    return Quaternion(xyz[0], xyz[1], xyz[2], state.position[world, q + 3])


@func
def store_quaternion(state: State, world: Int32, q: Int32, value: Quaternion):
    """Store `value`, normalised, from coordinate `q` on."""
    unit = wp.normalize(value)
    for i in range(4):
        state.position[world, q + i] = unit[i]


@func
def vector_at(numbers: Reals, first: Int32) -> Vector3:
    """The vector in entries `first` to `first + 2` of an array."""
    return Vector3(numbers[first], numbers[first + 1], numbers[first + 2])


@func
def quaternion_at(numbers: Reals, first: Int32) -> Quaternion:
    """The quaternion in entries `first` to `first + 3` of an array."""
    return Quaternion(numbers[first], numbers[first + 1], numbers[first + 2], numbers[first + 3])
