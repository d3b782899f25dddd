"""Kernels for several worlds at once: numbers become lanes, and branches on them only choose values."""

from __future__ import annotations

import pytest

from carom.native.building.lanes import BranchOnNumbers, in_lanes

CHOOSING = """\
static WP_FORCEINLINE wp::float64 halved_0(
    wp::float64 var_a)
{
    const wp::float64 var_0 = 0.5;
    wp::float64 var_1;
    var_1 = wp::mul(var_a, var_0);
    return var_1;
}

static WP_FORCEINLINE wp::float64 kept_0(
    wp::array_t<wp::float64> var_a,
    wp::float64 var_b)
{
    wp::array_store(var_a, 0, var_b);
    return var_b;
}

static WP_FORCEINLINE wp::float64 least_0(
    wp::float64 var_a,
    wp::int32 var_i)
{
    bool var_0;
    bool var_1;
    bool var_2;
    const wp::int32 var_3 = 1;
    const wp::float64 var_4 = 0.0;
    wp::float64 var_5;
    wp::float64 var_6;
    wp::float64 var_7;
    var_0 = (var_a < var_4);
    var_1 = wp::unot(var_0);
    var_2 = (var_i == var_3);
    if (var_2) {
        var_5 = wp::where(var_1, var_a, var_4);
    }
    if (!var_0) {
        if (var_2) {
            var_6 = halved_0(var_a);
        }
    }
    var_7 = wp::where(var_0, var_5, var_6);
    return var_7;
}
"""
ADDED = "        var_5 = wp::where(var_1, var_a, var_4);\n"


def test_comparisons_of_numbers_become_masks() -> None:
    code = in_lanes(CHOOSING)
    assert "wp::float64" not in code
    assert "lanes::Mask var_0;" in code
    assert "lanes::Mask var_1;" in code
    # Whole numbers are the same in all worlds.
    assert "bool var_2;" in code


@pytest.mark.parametrize("condition", ["var_0", "var_1", "!var_0"])
def test_a_branch_on_numbers_may_choose_values(condition: str) -> None:
    assert f"if ({condition}) {{" in in_lanes(CHOOSING.replace("if (var_2)", f"if ({condition})", 1))


@pytest.mark.parametrize(
    "change",
    [
        "wp::store(var_9, var_a);",
        "var_5 = wp::atomic_add(var_9, var_i, var_a);",
        "var_5 = kept_0(var_9, var_a);",
        "return var_a;",
        "goto start_for_0;",
        "wp::assign(var_5, var_a);",
    ],
)
def test_a_branch_on_numbers_that_does_more_is_refused(change: str) -> None:
    code = CHOOSING.replace(ADDED, f"{ADDED}        {change}\n")
    assert in_lanes(code)
    with pytest.raises(BranchOnNumbers, match=r"wp\.where"):
        in_lanes(code.replace("if (var_2)", "if (var_0)", 1))


def test_a_loop_on_numbers_is_refused() -> None:
    with pytest.raises(BranchOnNumbers):
        in_lanes(CHOOSING.replace("if (var_2)", "while (var_0)"))


@pytest.mark.parametrize("use", ["var_0 && var_2", "wp::where(var_2, var_0, var_1)", "other_0(var_0)"])
def test_other_uses_of_comparisons_are_refused(use: str) -> None:
    with pytest.raises(BranchOnNumbers):
        in_lanes(CHOOSING.replace("(var_i == var_3)", use))


def test_structs_of_topology_keep_their_layout() -> None:
    code = in_lanes(
        "struct TreeModel_0\n{\n    wp::float64 x;\n};\nstruct LinkModel_0\n{\n    wp::float64 x;\n};\n"
    )
    assert "{\n    wp::float64 x;\n};\nstruct LinkModel_0\n{\n    lanes::Lane x;" in code
