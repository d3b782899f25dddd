"""From a robot to a body: link order, flags, limits, merging."""

from __future__ import annotations

import logging
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.description import (
    Box,
    Collision,
    ContactParameters,
    Inertial,
    Joint,
    JointLimit,
    JointType,
    Link,
    Mesh,
    Pose,
    Robot,
    Sphere,
    Visual,
)
from carom.description.transform import compose, quaternion_from_rpy
from carom.errors import DescriptionError
from carom.layouts.flags import LoadFlags
from carom.model.assemble import assemble, outline
from carom.model.body_spec import BASE, BodySpec

NO_LIMIT = JointLimit()


def chain(*kinds: JointType, limit: JointLimit = NO_LIMIT) -> Robot:
    """Links l0, l1, ... in a row, joined by j1, j2, ... of the given kinds."""
    links = tuple(Link(f"l{i}", Inertial(float(i + 1))) for i in range(len(kinds) + 1))
    joints = tuple(
        Joint(f"j{i}", kind, i - 1, i, Pose((0.0, 0.0, float(i))), limit=limit)
        for i, kind in enumerate(kinds, start=1)
    )
    return Robot("chain", links, joints)


@st.composite
def random_trees(draw: st.DrawFn) -> Robot:
    """Trees with links and joints in any order."""
    count = draw(st.integers(1, 12))
    places = draw(st.permutations(range(count)))
    parents = [draw(st.integers(0, index - 1)) for index in range(1, count)]
    kinds = st.sampled_from([JointType.FIXED, JointType.CONTINUOUS])
    joints = [
        Joint(f"to {places[child]}", draw(kinds), places[parent], places[child])
        for child, parent in enumerate(parents, start=1)
    ]
    links = tuple(Link(str(index), Inertial(1.0)) for index in range(count))
    return Robot("tree", links, tuple(draw(st.permutations(joints))), root=places[0])


def names(body: BodySpec) -> list[str]:
    return [link.name for link in body.links]


@given(random_trees(), st.booleans(), st.booleans())
def test_parents_come_before_their_children(robot: Robot, in_file_order: bool, merged: bool) -> None:
    flags = LoadFlags.NONE
    if in_file_order:
        flags |= LoadFlags.MAINTAIN_LINK_ORDER
    if merged:
        flags |= LoadFlags.MERGE_FIXED_LINKS
    body = assemble(robot, flags=flags)
    parent_of = {robot.links[joint.child].name: robot.links[joint.parent].name for joint in robot.joints}
    assert body.base.name == robot.links[robot.root].name
    for index, link in enumerate(body.links):
        assert BASE <= link.parent < index
        if not merged:
            parent = body.base if link.parent == BASE else body.links[link.parent]
            assert parent.name == parent_of[link.name]
    if merged:
        assert all(link.joint_type is not JointType.FIXED for link in body.links)
    else:
        assert sorted([body.base.name, *names(body)]) == sorted(link.name for link in robot.links)


@given(random_trees())
def test_depth_first_order_keeps_branches_together(robot: Robot) -> None:
    body = assemble(robot)
    for index, link in enumerate(body.links[1:], start=1):
        # A link follows its parent, or the last link of an earlier branch of its parent.
        ancestor = index - 1
        while ancestor not in (link.parent, BASE):
            ancestor = body.links[ancestor].parent
        assert ancestor == link.parent


@given(random_trees())
def test_file_order_differs_from_the_file_only_where_it_must(robot: Robot) -> None:
    body = assemble(robot, flags=LoadFlags.MAINTAIN_LINK_ORDER)
    for index, (first, second) in enumerate(zip(body.links, body.links[1:], strict=False)):
        assert int(first.name) < int(second.name) or body.links[index + 1].parent == index


def test_long_chains_do_not_exhaust_the_stack() -> None:
    count = 3000
    assert len(assemble(chain(*[JointType.CONTINUOUS] * count)).links) == count
    merged = assemble(chain(*[JointType.FIXED] * count), flags=LoadFlags.MERGE_FIXED_LINKS)
    assert (merged.links, merged.base.mass) == ([], sum(range(1, count + 2)))


@pytest.mark.parametrize(
    ("kind", "limit", "limited"),
    [
        (JointType.REVOLUTE, JointLimit(-1, 1), True),
        (JointType.REVOLUTE, JointLimit(0, 0), True),
        (JointType.REVOLUTE, JointLimit(1, -1), False),
        (JointType.PRISMATIC, JointLimit(-1, 1), True),
        (JointType.PRISMATIC, JointLimit(), False),
        (JointType.CONTINUOUS, JointLimit(-1, 1), False),
        (JointType.FIXED, JointLimit(-1, 1), False),
        (JointType.PLANAR, JointLimit(-1, 1), False),
        (JointType.SPHERICAL, JointLimit(-1, 1, effort=1, twist=1), False),
        (JointType.SPHERICAL, JointLimit(1, 1, effort=1, twist=1), True),
        (JointType.SPHERICAL, JointLimit(1, 1, effort=1), False),
        (JointType.SPHERICAL, JointLimit(1, 1, twist=1), False),
    ],
)
def test_which_joints_are_limited(kind: JointType, limit: JointLimit, limited: bool) -> None:
    (link,) = assemble(chain(kind, limit=limit)).links
    assert (link.joint_type, link.limited) == (kind, limited)
    assert (link.lower, link.upper, link.twist) == (limit.lower, limit.upper, limit.twist)


def test_floating_joints_inside_a_tree_are_fixed_with_a_warning(caplog: pytest.LogCaptureFixture) -> None:
    (link,) = assemble(chain(JointType.FLOATING)).links
    assert link.joint_type is JointType.FIXED
    assert "'j1'" in caplog.text


def test_the_base_is_fixed_when_it_is_nailed_or_massless() -> None:
    robot = chain(JointType.CONTINUOUS)
    assert not assemble(robot).fixed_base
    nailed = assemble(robot, fixed_base=True)
    assert (nailed.fixed_base, nailed.base.mass, nailed.base.inertia) == (True, 0.0, (0.0, 0.0, 0.0))
    assert nailed.links[0].mass == 2.0
    massless = Robot("r", (Link("a", Inertial(0.0)),), ())
    assert assemble(massless).fixed_base


def test_shapes_can_be_ignored() -> None:
    link = Link("a", Inertial(1.0), (Collision(Sphere(1.0)),), (Visual(Sphere(1.0)),))
    robot = Robot("r", (link,), ())
    everything = assemble(robot).base
    assert (len(everything.collisions), len(everything.visuals)) == (1, 1)
    assert everything.inertia == (0.4, 0.4, 0.4)
    nothing = assemble(robot, flags=LoadFlags.IGNORE_COLLISION_SHAPES | LoadFlags.IGNORE_VISUAL_SHAPES).base
    assert (nothing.collisions, nothing.visuals) == ((), ())
    assert nothing.inertia[0] < 1e-6


@pytest.mark.parametrize("flags", [LoadFlags.NONE, LoadFlags.USE_INERTIA_FROM_FILE])
def test_inertia_is_scaled_where_the_file_says_so(flags: LoadFlags) -> None:
    def inertia(contact: ContactParameters) -> float:
        inertial = Inertial(1.0, tensor=(0.4, 0.0, 0.0, 0.4, 0.0, 0.4))
        link = Link("a", inertial, (Collision(Sphere(1.0)),), contact=contact)
        return assemble(Robot("r", (link,), ()), flags=flags).base.inertia[1]

    assert inertia(ContactParameters()) == pytest.approx(0.4)
    assert inertia(ContactParameters(inertia_scaling=3.0)) == pytest.approx(1.2)


def test_merged_shapes_stay_where_they_are() -> None:
    turn = Pose((0.1, 0.2, 0.3), quaternion_from_rpy(0.4, 0.5, 0.6))
    shape = Collision(Box((1.0, 2.0, 3.0)), Pose((1.0, 0.0, 0.0)))
    robot = Robot(
        "r",
        (Link("a"), Link("b", collisions=(shape,)), Link("c", collisions=(shape,)), Link("d")),
        (
            Joint("ab", JointType.FIXED, 0, 1, turn),
            Joint("bc", JointType.FIXED, 1, 2, turn),
            Joint("cd", JointType.CONTINUOUS, 2, 3, turn),
        ),
    )
    body = assemble(robot, flags=LoadFlags.MERGE_FIXED_LINKS)
    twice = compose(turn, turn)
    assert names(body) == ["d"]
    assert body.links[0].joint_frame.position == pytest.approx(compose(twice, turn).position)
    for collision, frame in zip(body.base.collisions, (turn, twice), strict=True):
        expected = compose(frame, shape.frame)
        assert collision.frame.position == pytest.approx(expected.position)
        assert collision.frame.orientation == pytest.approx(expected.orientation)


def test_merging_massless_links_keeps_numbers_finite() -> None:
    robot = Robot(
        "r",
        (Link("a"), Link("b", Inertial(0.0)), Link("c", Inertial(0.0))),
        (Joint("ab", JointType.CONTINUOUS, 0, 1), Joint("bc", JointType.FIXED, 1, 2)),
    )
    (link,) = assemble(robot, flags=LoadFlags.MERGE_FIXED_LINKS).links
    assert (link.mass, link.inertial_frame.position) == (0.0, (0.0, 0.0, 0.0))


def test_a_robot_is_not_changed_by_assembling_it() -> None:
    robot = chain(JointType.FIXED, JointType.CONTINUOUS)
    before = repr(robot)
    body = assemble(robot, flags=LoadFlags.MERGE_FIXED_LINKS)
    body.user_data["key"] = "value"
    assert repr(robot) == before


def test_unusable_collision_meshes_are_refused(tmp_path: Path) -> None:
    (tmp_path / "m.obj").write_text("v 0 0")
    link = Link("a", collisions=(Collision(Mesh(tmp_path / "m.obj")),))
    with pytest.raises(DescriptionError, match=r"m\.obj"):
        assemble(Robot("r", (link,), ()))


def test_the_outline_shows_the_tree(caplog: pytest.LogCaptureFixture) -> None:
    robot = Robot(
        "r",
        tuple(Link(name, Inertial(0.5)) for name in "abcd"),
        (
            Joint("ab", JointType.REVOLUTE, 0, 1),
            Joint("bc", JointType.FIXED, 1, 2),
            Joint("ad", JointType.PRISMATIC, 0, 3),
        ),
    )
    with caplog.at_level(logging.INFO):
        body = assemble(robot, flags=LoadFlags.PRINT_URDF_INFO)
    assert outline(body).splitlines() == [
        "a (mass 0.5)",
        "  b (mass 0.5, revolute joint ab)",
        "    c (mass 0.5, fixed joint bc)",
        "  d (mass 0.5, prismatic joint ad)",
    ]
    assert outline(body) in caplog.text


def test_unknown_flags_are_kept() -> None:
    assert assemble(chain(), flags=LoadFlags(1 << 30)).flags == 1 << 30


def test_merged_links_have_the_moments_of_both() -> None:
    tensors = ((0.4, 0.05, -0.02, 0.5, 0.03, 0.6), (0.2, -0.04, 0.01, 0.3, 0.02, 0.25))
    places = np.array([(0.0, 0.0, 0.0), (0.3, -0.5, 0.7)])
    links = tuple(Link(f"l{i}", Inertial(i + 1.0, tensor=tensor)) for i, tensor in enumerate(tensors))
    joints = (Joint("j", JointType.FIXED, 0, 1, Pose((0.3, -0.5, 0.7))),)
    flags = LoadFlags.MERGE_FIXED_LINKS | LoadFlags.USE_INERTIA_FROM_FILE
    base = assemble(Robot("r", links, joints), flags=flags).base
    masses = np.array([1.0, 2.0])
    middle = masses @ places / 3.0
    total = np.zeros((3, 3))
    for mass, place, (xx, xy, xz, yy, yz, zz) in zip(masses, places - middle, tensors, strict=True):
        total += np.array([(xx, xy, xz), (xy, yy, yz), (xz, yz, zz)])
        total += mass * (place @ place * np.eye(3) - np.outer(place, place))
    assert base.mass == 3.0
    assert base.inertial_frame.position == pytest.approx(middle)
    assert sorted(base.inertia) == pytest.approx(np.linalg.eigvalsh(total), rel=1e-4)
