"""Launches: arguments are packed once, and running is one call of a C function."""

import ctypes
from typing import Any, ClassVar

import numpy as np
import pytest

from carom import World
from carom.layouts.types import ArrayView, Int32, IntRows, real, struct
from carom.native.kernels import Kernel, link_twist_kernel
from carom.native.launch import KernelStructs, Launch, TreeLaunch
from carom.native.tables import ArrayTable, array_view


@struct
class Amounts:
    """Numbers by value."""

    amount: Int32
    factor: real


@struct
class Rows:
    """A table."""

    row_value: IntRows


class Arguments(ctypes.Structure):
    _fields_: ClassVar[Any] = (("values", ArrayView), ("amounts", Amounts), ("column", ctypes.c_int32))


@ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)
def add(counts, arguments):
    """Adds `amount * factor` to one column of as many rows as it runs times."""
    given = Arguments.from_address(arguments)
    for row in range(ctypes.c_uint32.from_address(counts).value):
        place = given.values.data + row * given.values.strides[0] + 8 * given.column
        ctypes.c_double.from_address(place).value += given.amounts.amount * given.amounts.factor


class FakeLibrary:
    def arguments(self, _kernel):
        return (("values", "array(float64,2)"), ("amounts", "Amounts"), ("column", "int32"))

    def function(self, _kernel):
        return add


@pytest.fixture
def kernel() -> Kernel:
    return Kernel("add_kernel", FakeLibrary)  # type: ignore[arg-type]


@pytest.fixture
def values() -> np.ndarray:
    return np.zeros((3, 2))


@pytest.fixture
def launch(kernel, values) -> Launch:
    return Launch(kernel, 3, [array_view(values, 2), Amounts(5, 2.0), 1])


def test_making_a_launch_runs_nothing(launch, values):
    assert launch.function is not None
    assert not values.any()


def test_it_runs_on_the_memory_it_was_given_again_and_again(launch, values):
    launch()
    launch()
    np.testing.assert_array_equal(values, [[0.0, 20.0]] * 3)
    values[1, 1] = 0.5
    launch()
    np.testing.assert_array_equal(values[:, 1], [30.0, 10.5, 30.0])


def test_replaced_arguments_hold_for_all_later_runs(launch, values):
    run = launch.function
    launch.replace(1, Amounts(7, 1.0))
    launch.replace(2, 0)
    launch()
    run()
    np.testing.assert_array_equal(values, [[14.0, 0.0]] * 3)


def test_brief_functions_do_the_same(launch, values):
    launch.brief_function()
    np.testing.assert_array_equal(values[:, 1], 10.0)


def test_it_keeps_its_arrays_alive(kernel):
    launches = [Launch(kernel, 1, [array_view(np.zeros((1, 2)), 2), Amounts(n, 1.0), 0]) for n in range(50)]
    for launch in launches:
        launch()
    ends = [launch._keep_alive[0].memory[0, 0] for launch in launches]
    assert ends == list(range(50))


def test_addresses_let_native_code_run_it_and_change_its_numbers(launch, values):
    function, bounds, packed, column, missing = launch.addresses("column", "none_such")
    assert missing == 0
    ctypes.c_int32.from_address(column).value = 0
    ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_void_p)(function)(bounds, packed)
    np.testing.assert_array_equal(values, [[10.0, 0.0]] * 3)


def test_too_few_arguments_are_refused(kernel):
    with pytest.raises(TypeError, match=r"add_kernel takes values, amounts, column; 1 were given"):
        Launch(kernel, 1, [0])


def test_launches_of_the_same_structs_are_made_once_and_take_over_new_ones(kernel):
    table = ArrayTable(Rows)
    structs = KernelStructs(values=array_view(np.zeros((2, 2)), 2), amounts=Amounts(1, 1.0))
    first = structs.launch(kernel, column=0)
    assert structs.launch(kernel, column=0) is first
    assert structs.launch(kernel, column=1) is not first
    other = np.zeros((2, 2))
    structs["values"] = array_view(other, 2)
    assert structs.launch(kernel, column=0) is first
    first()
    assert other[0, 0] == 1.0
    structs["amounts"].amount = 6
    first()
    assert other[0, 0] == 2.0
    structs.changed("amounts")
    first()
    assert other[0, 0] == 8.0
    assert table.struct() is table.struct()


def test_runs_on_the_first_trees_are_those_on_each_of_them():
    launch = TreeLaunch(link_twist_kernel, World().engine.structs())
    for count in (3, 1, 2, 2):
        assert launch.records(count) == b"".join(launch.record(tree) for tree in range(count))
