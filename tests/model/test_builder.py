"""Bodies in and out of the flat arrays."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.changes import at_once
from tests.physics.robots import free_body, random_tree

from carom.description import JointType, Pose
from carom.description.pose import IDENTITY
from carom.layouts.codes import JointCode
from carom.model.body_rows import TreeRows
from carom.model.body_spec import BodySpec, LinkSpec
from carom.model.builder import WorldArrays

SPECS = [
    random_tree(0, 5, fixed_base=True),
    random_tree(1, 9, fixed_base=False),
    free_body(),
    random_tree(2, 7, fixed_base=True),
]


def filled(specs: list[BodySpec]) -> tuple[WorldArrays, list[TreeRows]]:
    arrays = WorldArrays()
    return arrays, [at_once(arrays.append, spec, Pose((float(n), 0.0, 0.0))) for n, spec in enumerate(specs)]


def used_rows(arrays: WorldArrays) -> dict[str, np.ndarray]:
    """What is in the rows in use of the model and the state."""
    used = {str(axis): count for axis, count in arrays.used.items()}
    content = {}
    for table in (arrays.model, arrays.state):
        for name, array in table.numpy.items():
            axis = name.partition("_")[0]
            if axis in used:
                rows = np.s_[:, : used[axis]] if table.is_per_world(name) else np.s_[: used[axis]]
                content[name] = array[rows]
    return content


def assert_same_content(arrays: WorldArrays, expected: WorldArrays) -> None:
    assert arrays.used == expected.used
    for name, values in used_rows(expected).items():
        np.testing.assert_array_equal(used_rows(arrays)[name], values, err_msg=name)


@pytest.mark.parametrize("removed", range(len(SPECS)))
def test_a_removed_body_leaves_no_trace(removed):
    arrays, rows = filled(SPECS)
    gone = rows.pop(removed)
    at_once(arrays.remove, gone, rows)
    expected = WorldArrays()
    for n, spec in enumerate(SPECS):
        if n != removed:
            kept = at_once(expected.append, spec, Pose((float(n), 0.0, 0.0)))
            assert rows[n - (n > removed)] == kept
    assert_same_content(arrays, expected)


def test_bodies_added_after_removals_are_as_in_a_fresh_world():
    arrays, rows = filled(SPECS)
    at_once(arrays.remove, rows.pop(1), rows)
    at_once(arrays.remove, rows.pop(0), rows)
    late = at_once(arrays.append, SPECS[0], IDENTITY)
    expected = WorldArrays()
    for n in (2, 3):
        at_once(expected.append, SPECS[n], Pose((float(n), 0.0, 0.0)))
    assert late == at_once(expected.append, SPECS[0], IDENTITY)
    assert_same_content(arrays, expected)


def test_everything_can_be_removed():
    arrays, rows = filled(SPECS)
    while rows:
        at_once(arrays.remove, rows.pop(), rows)
    assert not any(arrays.used.values())
    for table in arrays.tables:
        assert not any(array.any() for array in table.numpy.values())


def test_arrays_grow_with_their_contents():
    arrays, rows = WorldArrays(), []
    grew = []
    for _ in range(20):
        before = arrays.state.replacements
        rows.append(at_once(arrays.append, SPECS[1], IDENTITY))
        grew.append(arrays.state.replacements > before)
    assert any(grew)
    assert not all(grew)
    assert [row.tree for row in rows] == list(range(20))
    assert arrays.used["link"] == 20 * 10
    expected = WorldArrays()
    expected.reserve(**dict.fromkeys(expected.used, 10_000))
    for _ in range(20):
        before = expected.state.replacements
        at_once(expected.append, SPECS[1], IDENTITY)
        assert expected.state.replacements == before
    assert_same_content(arrays, expected)


def test_coordinates_are_counted_by_joint_type():
    types = [JointType.REVOLUTE, JointType.SPHERICAL, JointType.FIXED, JointType.PLANAR, JointType.PRISMATIC]
    links = [LinkSpec(f"l{j}", parent=j - 1, mass=1.0, joint_type=kind) for j, kind in enumerate(types)]
    arrays, (rows,) = filled([BodySpec("all", LinkSpec("base"), links, fixed_base=True)])
    assert rows.count == {
        **{"tree": 1, "link": 6, "position": 7 + 9, "dof": 6 + 8, "block": 14 * 4, "delta": 4},
        "node": 0,
        "actuator": 0,
        "sensor": 0,
        "late": 0,
    }
    model = arrays.model.numpy
    assert model["link_joint_type"][1:6].tolist() == [
        JointCode.REVOLUTE,
        JointCode.SPHERICAL,
        JointCode.FIXED,
        JointCode.PLANAR,
        JointCode.PRISMATIC,
    ]
    assert model["link_first_position"][1:6].tolist() == [7, 8, 12, 12, 15]
    assert model["link_first_dof"][1:6].tolist() == [6, 7, 10, 10, 13]
    assert model["link_dof_count"][:6].tolist() == [0, 1, 3, 0, 3, 1]
    # Each dof hangs on the one before it in this chain, the first on nothing.
    assert model["dof_parent"][6:14].tolist() == [-1, 6, 7, 8, 9, 10, 11, 12]
    assert arrays.state.numpy["position"][0, 8:12].tolist() == [0.0, 0.0, 0.0, 1.0]


@pytest.mark.parametrize("spec", SPECS, ids=lambda spec: spec.name)
def test_dof_parents_follow_the_tree_of_links(spec):
    arrays, (_, rows) = filled([free_body(), spec])
    model = arrays.model.numpy
    for dof in range(model["tree_first_dof"][rows.tree], rows.first["dof"] + rows.count["dof"]):
        path = []
        up = dof
        while up >= 0:
            path.append(up)
            up = int(model["dof_parent"][up])
        assert path == sorted(path, reverse=True)
        root = path[-1]
        assert root == rows.first["dof"] if not spec.fixed_base else root >= rows.first["dof"] + 6


def test_a_base_freed_and_held_again_is_as_before():
    arrays, rows = filled(SPECS)
    for n, spec in enumerate(SPECS):
        arrays.set_base_freedom(rows[n], free=spec.fixed_base)
        arrays.set_base_freedom(rows[n], free=not spec.fixed_base)
    assert_same_content(arrays, filled(SPECS)[0])


@pytest.mark.parametrize("n", [0, 3])
def test_a_freed_base_is_as_if_never_fixed(n):
    arrays, rows = filled(SPECS)
    arrays.set_base_freedom(rows[n], free=True)
    spec = SPECS[n]
    free = BodySpec(spec.name, spec.base, spec.links, fixed_base=False)
    assert_same_content(arrays, filled([*SPECS[:n], free, *SPECS[n + 1 :]])[0])


def test_joints_are_told_in_inertial_frames():
    half = math.sqrt(0.5)
    quarter = (0.0, 0.0, half, half)  # about z: takes x to y
    base = LinkSpec("base", mass=1.0, inertial_frame=Pose((1.0, 0.0, 0.0), quarter))
    link = LinkSpec(
        "link",
        mass=1.0,
        inertial_frame=Pose((0.0, 0.0, 0.5), quarter),
        joint_type=JointType.REVOLUTE,
        joint_frame=Pose((1.0, 2.0, 3.0)),
        joint_axis=(1.0, 0.0, 0.0),
        joint_axis_length=3.0,
    )
    arrays, _ = filled([BodySpec("frames", base, [link], fixed_base=True)])
    model = arrays.model.numpy
    assert_allclose(model["link_pivot_in_parent"][1], [2.0, 0.0, 3.0], atol=1e-15)
    assert_allclose(model["link_com_from_pivot"][1], [0.0, 0.0, 0.5], atol=1e-15)
    assert_allclose(model["link_joint_rotation"][1], [0.0, 0.0, 0.0, 1.0], atol=1e-15)
    assert_allclose(model["link_unit_axis"][1], [0.0, -1.0, 0.0], atol=1e-15)
    assert_allclose(model["link_axis"][1], [0.0, -3.0, 0.0], atol=1e-15)


def test_worlds_of_a_batch_start_alike():
    arrays = WorldArrays(world_count=3)
    for spec in SPECS:
        at_once(arrays.append, spec, Pose((1.0, 2.0, 3.0)))
    state = arrays.state.numpy
    for name, array in state.items():
        np.testing.assert_array_equal(array[1], array[0], err_msg=name)
        np.testing.assert_array_equal(array[2], array[0], err_msg=name)
    assert state["position"][0, :3].tolist() == [1.0, 2.0, 3.0]


def test_each_link_knows_the_last_of_the_dofs_that_move_it() -> None:
    arrays, bodies = filled(SPECS)
    model = arrays.model.numpy
    for spec, rows in zip(SPECS, bodies, strict=True):
        first = rows.first["link"]
        base = [] if spec.fixed_base else range(rows.first["dof"], rows.first["dof"] + 6)
        movers: dict[int, list[int]] = {first: [*base]}
        for row in range(first + 1, first + rows.count["link"]):
            own = int(model["link_first_dof"][row])
            own_dofs = range(own, own + int(model["link_dof_count"][row]))
            movers[row] = movers[int(model["link_parent"][row])] + [*own_dofs]
        for row, dofs in movers.items():
            assert model["link_nearest_dof"][row] == max(dofs, default=-1)
