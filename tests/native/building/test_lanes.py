"""Kernels for several worlds at once: numbers become lanes, and no branch depends on one."""

from __future__ import annotations

import pytest

from carom.native.building.lanes import BranchOnNumbers, in_lanes

CHOOSING = """\
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
    var_0 = (var_a < var_4);
    var_1 = wp::unot(var_0);
    var_2 = (var_i == var_3);
    if (var_2) {
        var_5 = wp::where(var_1, var_a, var_4);
    }
    return var_5;
}
"""


def test_comparisons_of_numbers_become_masks() -> None:
    code = in_lanes(CHOOSING)
    assert "wp::float64" not in code
    assert "lanes::Mask var_0;" in code
    assert "lanes::Mask var_1;" in code
    # Whole numbers are the same in all worlds.
    assert "bool var_2;" in code


@pytest.mark.parametrize("condition", ["var_0", "var_1", "!var_0"])
def test_a_branch_on_numbers_is_refused(condition: str) -> None:
    with pytest.raises(BranchOnNumbers, match=r"wp\.where"):
        in_lanes(CHOOSING.replace("if (var_2)", f"if ({condition})"))


def test_a_loop_on_numbers_is_refused() -> None:
    with pytest.raises(BranchOnNumbers):
        in_lanes(CHOOSING.replace("if (var_2)", "while (var_0)"))


def test_structs_of_topology_keep_their_layout() -> None:
    code = in_lanes(
        "struct TreeModel_0\n{\n    wp::float64 x;\n};\nstruct LinkModel_0\n{\n    wp::float64 x;\n};\n"
    )
    assert "{\n    wp::float64 x;\n};\nstruct LinkModel_0\n{\n    lanes::Lane x;" in code
