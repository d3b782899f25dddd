"""The types of the layouts as the kernels' compiler has them, and float literals in kernels."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false, reportArgumentType=false

import ctypes
import importlib
import pkgutil

import numpy as np
import pytest
from tests.each import each

pytest.importorskip("warp", reason="its types are compared with those of the layouts")

import warp as wp

import carom.layouts
from carom.kernels.types import RealRows, Vector3, func, kernel, real
from carom.kernels.warp_types import warp_type
from carom.layouts.types import Struct
from carom.native.tables import NUMPY_REAL


@func
def tenth_of(value: real) -> real:
    """A tenth, as a literal in a function."""
    return value * 0.1


@kernel
def literals_kernel(answers: RealRows):
    """Literals in all kinds of places."""
    row = wp.tid()
    third = 1.0 / 3.0
    answers[row, 0] = third
    answers[row, 1] = tenth_of(1.0)
    answers[row, 2] = -0.7
    answers[row, 3] = wp.dot(Vector3(0.1, 0.2, 0.3), Vector3(1.0, 10.0, 100.0))
    total = real(0.0)
    for i in range(3):
        total += 0.1 * real(i)
    answers[row, 4] = total
    if third > 0.3333333333:
        answers[row, 5] = 1e-300


LIMIT = real(2.5)
FARTHEST = 4.0


@kernel
def constants_kernel(answers: RealRows):
    """Named constants beside variables that start with their values."""
    row = wp.tid()
    if row == 0:
        farthest = real(FARTHEST)
        farthest += LIMIT
        answers[row, 0] = farthest
        return
    answers[row, 0] = LIMIT
    least = real(LIMIT)
    for i in range(row):
        least -= real(i)
    answers[row, 1] = least
    answers[row, 2] = LIMIT
    answers[row, 3] = real(LIMIT)
    answers[row, 4] = real(FARTHEST)


def test_numbers_are_double_precision():
    assert real is wp.float64
    assert NUMPY_REAL is np.float64


def test_a_variable_that_starts_with_a_constant_does_not_change_the_constant():
    answers = np.zeros((4, 5))
    rows = wp.array2d(answers, dtype=real, device="cpu", copy=False)
    wp.launch(constants_kernel, dim=4, inputs=[rows], device="cpu")
    expected = [[6.5, 0, 0, 0, 0], *([2.5, least, 2.5, 2.5, 4.0] for least in (2.5, 1.5, -0.5))]
    np.testing.assert_array_equal(answers, expected)


def test_literals_in_kernels_are_double_precision():
    answers = np.zeros((1, 6))
    rows = wp.array2d(answers, dtype=real, device="cpu", copy=False)
    wp.launch(literals_kernel, dim=1, inputs=[rows], device="cpu")
    total = 0.0 + 0.1 * 0 + 0.1 * 1 + 0.1 * 2
    expected = [1.0 / 3.0, 0.1, -0.7, 0.1 + 0.2 * 10.0 + 0.3 * 100.0, total, 1e-300]
    np.testing.assert_allclose(answers[0], expected, rtol=1e-15)


def test_functions_keep_their_names_and_descriptions():
    assert tenth_of.__name__ == "tenth_of"
    assert tenth_of.__doc__ == "A tenth, as a literal in a function."


def all_structs() -> list[type[Struct]]:
    modules = [
        importlib.import_module(f"carom.layouts.{found.name}")
        for found in pkgutil.iter_modules(carom.layouts.__path__)
    ]
    return [
        value
        for module in modules
        for value in vars(module).values()
        if isinstance(value, type) and issubclass(value, Struct) and value is not Struct
        if value.__module__ == module.__name__
    ]


@each("declared", all_structs(), ids=lambda struct: struct.__name__)
def test_structs_lie_in_memory_as_the_compiler_has_them(declared):
    compiled = warp_type(declared).ctype
    assert ctypes.sizeof(declared) == ctypes.sizeof(compiled)
    assert {name: getattr(declared, name).offset for name in declared.fields} == {
        name: getattr(compiled, name).offset for name in declared.fields
    }
