"""Numbers of the layouts that mean something beside others, or are in files."""

from __future__ import annotations

from carom.layouts.codes import DOF_COUNT, ConstraintKind, JointCode, PathKind, UserConstraintKind
from carom.layouts.contacts import AS_LINKS, AS_SHAPES, NO_MANIFOLD, NONE_KEPT
from carom.layouts.status import LEFT_OUT, OVERFLOW, WELL


def test_what_stands_for_nothing_is_no_count_place_or_distance() -> None:
    assert max(NONE_KEPT, NO_MANIFOLD, AS_SHAPES, AS_LINKS) < 0


def test_statuses_are_no_numbers_of_trees() -> None:
    # Those from 1 on name a tree that went wrong.
    assert len({WELL, OVERFLOW, LEFT_OUT}) == 3
    assert max(WELL, OVERFLOW, LEFT_OUT) == WELL == 0


def test_kinds_in_saved_worlds_stay_what_they_are() -> None:
    assert [*map(int, ConstraintKind)] == [*range(7)]
    assert [*map(int, PathKind)] == [*range(7)]
    assert [*map(int, UserConstraintKind)] == [1, *range(4, 12)]


def test_joints_have_as_many_velocities_as_they_can_move_in_ways() -> None:
    assert DOF_COUNT == {
        JointCode.REVOLUTE: 1,
        JointCode.PRISMATIC: 1,
        JointCode.SPHERICAL: 3,
        JointCode.PLANAR: 3,
        JointCode.FIXED: 0,
        JointCode.SCREW: 1,
    }
