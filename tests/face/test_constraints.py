"""Constraints of scripts: made from handles, named, listed, moved, removed; in one world and in many."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from tests.face.scene import made

from carom import Body, Pose, World, Worlds

LAWS = ("bullet", "rigid", "compliant")


def hanging(law: str = "bullet") -> tuple[World, Body, Body]:
    """A free box of 1 kg below a fixed one."""
    world = World(gravity=(0.0, 0.0, -9.81), contact=law)
    low = world.add_box((0.1, 0.1, 0.2), (0.0, 0.0, 2.0), mass=1.0, name="low")
    high = world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 2.5), mass=0.0, name="high")
    return world, low, high


@pytest.mark.parametrize("law", LAWS)
def test_what_is_fixed_stays_where_it_is(law: str) -> None:
    world, low, high = hanging(law)
    turn = np.array((0.1, 0.2, 0.3, 0.9)) / math.sqrt(0.95)
    low.pose = before = Pose((0.3, 0.1, 2.0), turn)
    tie = world.constrain(low, high)
    world.step(120)
    np.testing.assert_allclose(low.pose.array, before.array, atol=2e-4)
    assert tie.force == pytest.approx([0.0, 0.0, 9.81], abs=1e-2)  # type: ignore[attr-defined]
    assert (tie.name, tie.kind, world.constraints.names) == ("fixed", "fixed", ["fixed"])


@pytest.mark.parametrize("law", LAWS)
def test_a_point_turns_freely(law: str) -> None:
    world, low, _ = hanging(law)
    tie = world.constrain("low", None, "point", at=(0.0, 0.0, 2.2), name="ball")
    low.velocity = (0.5, 0.2, 0.0), (0.0, 0.0, 3.0)
    world.step(100)
    assert np.linalg.norm(tie.error) < 1e-3  # type: ignore[attr-defined]
    assert abs(low.pose.position[0]) > 1e-3
    assert world.constraints["ball"] == tie


@pytest.mark.parametrize("law", LAWS)
def test_a_hinge_turns_about_its_axis_only(law: str) -> None:
    world, low, high = hanging(law)
    tie = world.constrain(low.base, high.base, "hinge", at=(0.0, 0.0, 2.2), axis=(0.0, 2.0, 0.0))
    low.velocity = (0.3, 0.0, 0.0), (0.0, 1.5, 3.0)
    world.step(100)
    x, y, z, _ = low.pose.quaternion
    assert abs(y) > 0.01
    assert max(abs(x), abs(z)) < 2e-3
    assert tie.axis == pytest.approx([0.0, 1.0, 0.0], abs=4e-3)  # type: ignore[attr-defined]
    assert np.linalg.norm(tie.error) < 1e-3  # type: ignore[attr-defined]
    assert len(world.constraints) == 1


@pytest.mark.parametrize("law", LAWS)
def test_a_slide_moves_along_its_axis_only(law: str) -> None:
    world, low, _ = hanging(law)
    low.pose = Pose((0.0, 0.0, 2.0), (0.0, 0.0, math.sqrt(0.5), math.sqrt(0.5)))
    tie = world.constrain(low, None, "slide", axis=(1.0, 0.0, 1.0))
    world.step(120)
    time = world.time
    fallen = 0.25 * 9.81 * time**2
    assert low.pose.position == pytest.approx([-fallen, 0.0, 2.0 - fallen], rel=0.02)
    assert tie.position == pytest.approx(-math.sqrt(2.0) * fallen, rel=0.02)  # type: ignore[attr-defined]
    assert tie.force == pytest.approx([-9.81 / 2, 0.0, 9.81 / 2], abs=0.05)  # type: ignore[attr-defined]


def test_a_gear_couples_two_joints() -> None:
    world, arm, _ = made()
    shoulder, elbow = arm.joints["shoulder"], arm.joints["elbow"]
    shoulder.position, elbow.position = 0.2, 0.1
    tie = world.constrain(elbow, shoulder, "gear", ratio=-2.0)
    arm.actuators["bend"].control = 0.9
    world.step(200)
    assert abs(elbow.position - 0.1) > 0.05
    assert elbow.position - 0.1 == pytest.approx(-2.0 * (shoulder.position - 0.2), abs=2e-3)
    assert tie.kind == "gear"
    with pytest.raises(TypeError, match="between two joints"):
        world.constrain(arm, "box", "gear")
    with pytest.raises(TypeError, match="kind='gear'"):
        world.constrain(elbow, None, "point")


def test_what_is_held_follows_the_frame_that_is_moved_and_is_pulled_where_it_is_told() -> None:
    world, low, _ = hanging()
    tie: Any = world.constrain(low, None, "fixed", to=(0.0, 0.1, 2.0))
    world.step(240)
    assert low.pose.position == pytest.approx([0.0, 0.1, 2.0], abs=1e-3)
    tie.second_frame = Pose((0.2, 0.0, 2.1), (0.0, 0.0, 0.0, 1.0))
    world.step(240)
    assert low.pose.position == pytest.approx([0.2, 0.0, 2.1], abs=1e-3)
    np.testing.assert_allclose(tie.second_frame.position, (0.2, 0.0, 2.1))
    world.remove(tie)
    half = math.sqrt(0.5)
    door: Any = world.constrain(low, None, "hinge", axis=(0.0, 0.0, 1.0))
    door.second_frame = Pose(door.second_frame.position, (half, 0.0, 0.0, half))
    world.step(360)
    assert abs(door.axis[1]) == pytest.approx(1.0, abs=1e-3)
    assert np.linalg.norm(door.error) < 1e-3
    with pytest.raises(ValueError, match="quaternion other than 0"):
        tie.second_frame = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 0.0)


def test_the_greatest_force_bounds_it() -> None:
    world, low, _ = hanging()
    tie = world.constrain(low, None, "fixed", max_force=5.0)
    assert tie.max_force == 5.0
    world.step(60)
    assert low.velocity.linear[2] == pytest.approx(-(9.81 - 5.0) * world.time, rel=0.02)
    tie.max_force = math.inf
    assert tie.max_force == math.inf
    with pytest.raises(ValueError, match="max_force must be at least 0"):
        tie.max_force = -1.0


@pytest.mark.parametrize("kind", ["fixed", "point", "hinge", "slide"])
def test_it_is_switched_off_and_on_and_removed(kind: Any) -> None:
    world, low, high = hanging()
    axis = (0.0, 1.0, 0.0) if kind in ("hinge", "slide") else None
    tie = world.constrain(low, high, kind, axis=axis)
    assert [each.kind for each in world.constraints] == [kind]
    tie.enabled = False
    world.step(10)
    assert low.velocity.linear[2] == pytest.approx(-9.81 * world.time, rel=1e-3)
    tie.enabled = True
    world.remove(tie)
    assert not len(world.constraints)
    assert not len(world.user_constraints)
    with pytest.raises(ValueError, match="is no longer in its world"):
        tie.remove()
    world.step()
    # It goes with its body.
    world.constrain(low, high, kind, axis=axis)
    world.remove(low)
    assert not len(world.constraints)


def test_names_are_given_taken_and_kept_in_copies_and_files(tmp_path: Any) -> None:
    world, low, high = hanging()
    world.constrain(low, high, "hinge", axis=(1.0, 0.0, 0.0), name="door")
    world.constrain(low, None, "point")
    world.constrain(low, None, "point")
    world.save(tmp_path / "saved")
    other = World()
    other.load(tmp_path / "saved")
    for each in (world, world.copy(), other):
        assert each.constraints.names == ["door", "point", "point2"]
        assert [it.kind for it in each.constraints] == ["hinge", "point", "point"]
    with pytest.raises(ValueError, match="no constraint has yet, not 'door'"):
        world.constrain(low, None, name="door")


def test_constraints_of_files_are_listed_too() -> None:
    world = World()
    world.load(
        '<mujoco><worldbody><body name="a"><freejoint/><geom size=".1"/></body></worldbody>'
        '<equality><weld name="grip" body1="a"/></equality></mujoco>'
    )
    assert world.constraints["grip"].kind == "fixed"
    world.remove(world.constraints["grip"])
    assert not len(world.constraints)


def test_wrong_uses_are_answered_and_change_nothing() -> None:
    world, low, high = hanging()
    weld: Any = "weld"
    number: Any = 99
    for error, words, call in (
        (
            ValueError,
            "kind must be one of 'fixed', 'point', 'hinge'",
            lambda: world.constrain(low, high, weld),
        ),
        (ValueError, "kind must be one of", lambda: world.constrain(low, high, number)),
        (TypeError, r"constrain\(low, None, 'point'\)", lambda: world.constrain(low, "point")),
        (ValueError, "'hinge' needs an axis", lambda: world.constrain(low, high, "hinge")),
        (ValueError, "'point' has no axis", lambda: world.constrain(low, high, "point", axis=(1, 0, 0))),
        (ValueError, "axis must not be 0", lambda: world.constrain(low, high, "slide", axis=(0, 0, 0))),
        (ValueError, "finite", lambda: world.constrain(low, high, at=(0, 0, math.nan))),
        (ValueError, "max_force", lambda: world.constrain(low, high, max_force=-1.0)),
        (KeyError, "there is no body 'box'", lambda: world.constrain("box", low)),
        (KeyError, "no constraint is called 'x'", lambda: world.constraints["x"]),
    ):
        with pytest.raises(error, match=words):
            call()  # type: ignore[no-untyped-call]
    assert not len(world.constraints)
    world.step()


@pytest.mark.parametrize("law", ["bullet", "rigid"])
def test_many_worlds_have_them_by_name_on_in_some_and_measured(law: str) -> None:
    world, low, high = hanging(law)
    tie = world.constrain(low, high, "fixed", name="tie")
    world.constrain(low, high, "hinge", axis=(0.0, 1.0, 0.0), at=(0.0, 0.0, 2.2), name="door")
    world.constrain(low, None, "slide", axis=(0.0, 0.0, 1.0), name="rail")
    worlds = Worlds(world, 3)
    assert worlds.constraints.names == ["tie", "door", "rail"]
    worlds.constraints["tie"].enable(False, where=[1, 2])
    worlds.constraints["door"].enabled = False
    worlds.constraints["rail"].enabled = [False, True, False]
    assert worlds.constraints[tie].enabled.tolist() == [True, False, False]
    assert worlds.constraints["door"].first.name == low.base.name  # type: ignore[union-attr]
    assert worlds.constraints["rail"].second is None
    lone = [worlds.extract(number) for number in range(3)]
    worlds.step(30)
    for number, one in enumerate(lone):
        one.step(30)
        np.testing.assert_array_equal(worlds[low].pose.array[number], one["low"].pose.array)
        for name in ("tie", "door", "rail"):
            many, single = worlds.constraints[name], one.constraints[name]
            np.testing.assert_allclose(many.error[number], single.error, atol=1e-9)  # type: ignore[attr-defined]
            np.testing.assert_allclose(many.force[number], single.force, atol=1e-6)  # type: ignore[attr-defined]
    assert worlds.constraints["tie"].force[0] == pytest.approx([0.0, 0.0, 9.81], abs=1e-2)


@pytest.mark.parametrize(
    ("given", "problem", "words"),
    [
        (("fixed", "a"), TypeError, r"constrain\('a', None, 'fixed'\); None stands for the world"),
        (("fixed", "a", "b"), TypeError, r"constrain\('a', 'b', 'fixed'\)"),
        (("a", "fixed"), TypeError, r"constrain\('a', None, 'fixed'\)"),
        (("a", "point", "b"), TypeError, r"constrain\('a', 'b', 'point'\)"),
        (("a", "b", "weld"), ValueError, "not 'weld'; here it is 'fixed'"),
        (("a", "b", 4), ValueError, "not 4; here it is 'fixed'"),
        (("a", "b", "FIXED"), ValueError, "here it is 'fixed'"),
        (("a", "b", "glue"), ValueError, "'gear', not 'glue'$"),
        ((None, "a"), TypeError, "None, the world, second"),
        (("a", (0, 0, 1), "point"), TypeError, r"a point is at=\(x, y, z\)"),
    ],
)
def test_wrong_orders_are_answered_with_the_right_one(given: Any, problem: Any, words: str) -> None:
    world = World()
    world.add_box(name="a")
    world.add_box(name="b", position=(3.0, 0.0, 0.0))
    with pytest.raises(problem, match=words):
        world.constrain(*given)
    assert not world.constraints


def test_wrong_orders_with_handles_name_them() -> None:
    world: Any = World()
    a, b = world.add_box(name="a"), world.add_box(name="b", position=(3.0, 0.0, 0.0))
    with pytest.raises(TypeError, match=r"constrain\(a, None, 'fixed'\)"):
        world.constrain("fixed", a)
    with pytest.raises(TypeError, match=r"constrain\(a, b, 'point'\)"):
        world.constrain(a, "point", b)
    with pytest.raises(TypeError, match=r"constrain\(a, b, 'fixed'\)"):
        world.constrain("fixed", a, b)
    with pytest.raises(TypeError, match=r"arm\.links\['hand'\]"):
        world.constrain(a.base, -1, b)
    with pytest.raises(ValueError, match="a cannot be held to itself"):
        world.constrain(a, a)
    # A body may be called like a kind.
    world.add_box(name="fixed", position=(6.0, 0.0, 0.0))
    assert world.constrain("fixed", a).name == "fixed"
