"""Short functions are inlined; long ones are called, and take structs by reference."""

from __future__ import annotations

import re

import pytest

from carom.native.building import inlining
from carom.native.building.inlining import inlined

SHORT = """\
static WP_FORCEINLINE wp::float64 doubled_0(
    Model_01234567 var_model,
    wp::float64 var_a)
{
    return var_a;
}
"""
LONG = """\
static WP_FORCEINLINE void sweep_0(
    Model_01234567 var_model,
    Terms_89abcdef var_terms,
    wp::int32 var_i)
{
    var_terms.count = var_i;
    var_0 = doubled_0(var_model, var_1);
    var_0 = doubled_0(var_model, var_1);
}
"""
CALLING = """\
static WP_FORCEINLINE void solve_0(
    Model_01234567 var_model,
    Terms_89abcdef var_terms)
{
    var_0 = doubled_0(var_model, var_1);
    var_terms.count = var_0;
    sweep_0(var_model, var_terms, var_2);
}
"""
KERNEL = """\
template <bool wp_linear_contiguous>
static void solve_kernel_cpu_kernel_forward(
    wp::launch_bounds_t<1> dim,
    size_t task_index,
    wp_args_solve_kernel *_wp_args)
{
    Model_01234567 var_model = _wp_args->model;
    wp::int32 var_i = _wp_args->i;
    solve_0(var_model, var_3);
    var_4 = doubled_0(var_model, var_5);
}
"""
SOURCE = "\n".join((SHORT, LONG, CALLING, KERNEL))


@pytest.fixture
def changed(monkeypatch: pytest.MonkeyPatch) -> str:
    """The functions, of which one alone is too long: as it calls another twice."""
    monkeypatch.setattr(inlining, "_LONG", 150)
    return inlined(SOURCE)


def test_code_without_long_functions_stays_as_it_is():
    assert inlined(SOURCE) == SOURCE


def test_a_function_is_called_if_it_is_long_with_all_that_it_inlines(changed: str):
    assert re.findall(r"^static (\S+) .*?(\w+)\($", changed, re.M) == [
        ("WP_FORCEINLINE", "doubled_0"),
        ("__attribute__((noinline))", "sweep_0"),
        ("WP_FORCEINLINE", "solve_0"),
        ("void", "solve_kernel_cpu_kernel_forward"),
    ]


def test_functions_that_call_no_long_one_take_copies(changed: str):
    assert SHORT in changed


def test_a_long_function_copies_the_structs_that_it_refers_to(changed: str):
    head, body = changed[changed.index(" sweep_0(") : changed.index("WP_FORCEINLINE void solve_0")].split("{")
    assert (
        "    Model_01234567 & whole_model,\n    Terms_89abcdef & whole_terms,\n    wp::int32 var_i)" in head
    )
    assert "    Model_01234567 var_model = whole_model;\n" in body
    assert "    Terms_89abcdef var_terms = whole_terms;\n" in body
    assert "var_0 = doubled_0(var_model, var_1);" in body


def test_structs_are_passed_on_whole_to_long_functions_unless_they_have_been_changed(changed: str):
    assert "    sweep_0(whole_model, var_terms, var_2);\n" in changed


def test_kernels_pass_on_their_arguments_whole(changed: str):
    kernel = changed[changed.index("solve_kernel_cpu") :]
    assert "    Model_01234567 & whole_model = _wp_args->model;\n" in kernel
    assert "    Model_01234567 var_model = whole_model;\n" in kernel
    assert "    solve_0(whole_model, var_3);\n    var_4 = doubled_0(var_model, var_5);\n" in kernel
