"""Elementwise arithmetic on arrays of numbers of up to three axes, with any strides."""

import warp as wp

from carom.kernels.types import Int32, kernel
from carom.kernels.warp_types import warp_type
from carom.layouts.types import ArrayType, real

Numbers3 = warp_type(ArrayType(real, 3))

# Operations of `combine_kernel`.
ADD, SUBTRACT, MULTIPLY, DIVIDE, LEAST, GREATEST = 0, 1, 2, 3, 4, 5


@kernel
def combine_kernel(result: Numbers3, first: Numbers3, second: Numbers3, operation: Int32):
    """Apply an operation, such as `ADD`, to two arrays elementwise."""
    i, j, k = wp.tid()
    a = first[i, j, k]
    b = second[i, j, k]
    if operation == ADD:
        result[i, j, k] = a + b
    elif operation == SUBTRACT:
        result[i, j, k] = a - b
    elif operation == MULTIPLY:
        result[i, j, k] = a * b
    elif operation == DIVIDE:
        result[i, j, k] = a / b
    elif operation == LEAST:
        result[i, j, k] = wp.min(a, b)
    else:
        result[i, j, k] = wp.max(a, b)
