"""Functions are inlined, except those that are to be called: these take references to structs."""

from __future__ import annotations

import re

import pytest

from carom.native.building.inlining import inlined

INLINED = """\
static WP_FORCEINLINE wp::float64 doubled_0(
    Model_01234567 var_model,
    wp::float64 var_a)
{
    return var_a;
}
"""
CALLED = """\
static WP_FORCEINLINE void sweep_0(
    Model_01234567 var_model,
    Terms_89abcdef var_terms,
    wp::int32 var_i)
{
    var_terms.count = var_i;
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
    Terms_89abcdef var_terms = _wp_args->terms;
    solve_0(var_model, var_terms);
    var_4 = doubled_0(var_model, var_5);
}
"""
SOURCE = "\n".join((INLINED, CALLED, CALLING, KERNEL))


@pytest.fixture
def changed() -> str:
    """The functions, of which one is called."""
    return inlined(SOURCE, {"sweep_0"})


def test_code_without_functions_that_are_called_stays_as_it_is():
    assert inlined(SOURCE, set()) == SOURCE


def test_only_functions_that_are_to_be_called_are_not_inlined(changed: str):
    assert re.findall(r"^static (\S+) .*?(\w+)\($", changed, re.M) == [
        ("WP_FORCEINLINE", "doubled_0"),
        ("__attribute__((noinline))", "sweep_0"),
        ("WP_FORCEINLINE", "solve_0"),
        ("void", "solve_kernel_cpu_kernel_forward"),
    ]


def test_functions_that_call_none_of_them_take_structs_alone(changed: str):
    assert INLINED in changed


def test_a_called_function_takes_references_to_structs_unless_it_changes_them(changed: str):
    head, body = changed[changed.index(" sweep_0(") : changed.index("WP_FORCEINLINE void solve_0")].split("{")
    assert "    Model_01234567 & __restrict var_model,\n    Terms_89abcdef var_terms,\n" in head
    assert body.startswith("\n    var_terms.count = var_i;\n    var_0 = doubled_0(var_model, var_1);\n")


def test_a_function_that_calls_it_takes_structs_and_references_to_them(changed: str):
    head = changed[changed.index(" solve_0(") :].split("{", maxsplit=1)[0]
    assert "    Model_01234567 var_model,\n    Model_01234567 & whole_model,\n" in head


def test_references_are_passed_on_unless_the_struct_has_been_changed(changed: str):
    assert "    sweep_0(whole_model, var_terms, var_2);\n" in changed


def test_kernels_pass_on_structs_and_references_to_their_arguments(changed: str):
    kernel = changed[changed.index("solve_kernel_cpu") :]
    assert "    Model_01234567 & whole_model = _wp_args->model;\n" in kernel
    assert "    Model_01234567 var_model = whole_model;\n" in kernel
    assert (
        "    solve_0(var_model, whole_model, var_terms, whole_terms);\n"
        "    var_4 = doubled_0(var_model, var_5);\n"
    ) in kernel
