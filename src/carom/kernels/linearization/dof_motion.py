"""How dofs move links: motion subspaces, points of links, and which dofs turn with which."""

import warp as wp

from carom.kernels.structs import Model, Scratch, State, StepBatch, StepSpace
from carom.kernels.types import Int32, Vector3, func
from carom.layouts.linearization import BASE_DOF, MOVES_A, MOVES_B

_TURNS = wp.constant(3)  # dofs of a base before those that shift it


@func
def find_axes(
    model: Model,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
):
    """Write the motions of all dofs."""
    for dof in range(space.dofs):
        row = space.dof_row[dof]
        group = space.dof_group[dof]
        angular = scratch.dof[world, row].angular
        linear = scratch.dof[world, row].linear
        if space.dof_first[group] == BASE_DOF:
            # Along the axes of the world, about the centre of mass.
            angular = Vector3(0.0, 0.0, 0.0)
            linear = Vector3(0.0, 0.0, 0.0)
            if dof - group < _TURNS:
                angular[dof - group] = 1.0
            else:
                linear[dof - group - _TURNS] = 1.0
        base = model.tree[space.dof_tree[dof]].first_link
        centre = wp.transform_get_translation(state.link_pose[world, base])
        steps.axis_angular[place * space.dofs + dof] = angular
        steps.axis_linear[place * space.dofs + dof] = linear - wp.cross(angular, centre)


@func
def point_motion(steps: StepBatch, entry: Int32, point: Vector3) -> Vector3:
    """Velocity of a point that a dof moves, per unit of its rate; `entry` is that of the dof in its place."""
    return steps.axis_linear[entry] + wp.cross(steps.axis_angular[entry], point)


@func
def is_base(space: StepSpace, dof: Int32) -> bool:
    """Whether it is a dof of a free base."""
    return space.dof_first[space.dof_group[dof]] == BASE_DOF


@func
def follows(space: StepSpace, dof: Int32, other: Int32) -> bool:
    """Whether a dof's motion is moved by a change of another, if both move the same link."""
    group, group_of_other = space.dof_group[dof], space.dof_group[other]
    if is_base(space, dof):
        # A base turns about its centre, whatever it has turned.
        return group == group_of_other and dof - group < _TURNS and other - group >= _TURNS
    return group_of_other <= group


@func
def find_reach(
    model: Model, space: StepSpace, steps: StepBatch, place: Int32, link_a: Int32, link_b: Int32
) -> Int32:
    """List the dofs that move two links, -1 for the world; returns their number."""
    n = space.dofs
    count = Int32(0)
    for dof in range(n):
        steps.reach_side[place * n + dof] = 0
    for end in range(2):
        link = wp.where(end == 0, link_a, link_b)
        side = wp.where(end == 0, Int32(MOVES_A), Int32(MOVES_B))
        row = Int32(-1)
        if link >= 0:
            row = model.link[link].nearest_dof + 0
        while row >= 0:
            dof = space.row_dof[row]
            if steps.reach_side[place * n + dof] == 0:
                steps.reach[place * n + count] = dof
                count += 1
            steps.reach_side[place * n + dof] = steps.reach_side[place * n + dof] | side
            row = model.dof[row].parent
    return count


@func
def add_inertia_changes(
    model: Model,
    state: State,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    tree: Int32,
    rates: Int32,
    target: Int32,
):
    """Subtract the derivatives of rᵀ M r by the positions of a tree, for constant rates r.

    r is n numbers of `steps.response` from `rates` on, the result is added to those from `target` on. It is
    2 h · (s x v) with the momentum h of what a dof moves, its motion s, and the velocity v of what it is
    joined to: only the motion of what comes after it turns with it.
    """
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        angular = Vector3(0.0, 0.0, 0.0)
        linear = Vector3(0.0, 0.0, 0.0)
        row = model.link[link].nearest_dof + 0
        while row >= 0:
            dof = space.row_dof[row]
            rate = steps.response[rates + dof]
            angular += rate * steps.axis_angular[place * space.dofs + dof]
            linear += rate * steps.axis_linear[place * space.dofs + dof]
            row = model.dof[row].parent
        pose = state.link_pose[world, link]
        centre = wp.transform_get_translation(pose)
        turn = wp.transform_get_rotation(pose)
        push = model.link_mass[world, link] * (linear + wp.cross(angular, centre))
        spin = wp.cw_mul(model.link_inertia[world, link], wp.quat_rotate_inv(turn, angular))
        moment = wp.quat_rotate(turn, spin) + wp.cross(centre, push)
        row = model.link[link].nearest_dof + 0
        while row >= 0:
            last = space.row_dof[row]
            group = space.dof_group[last]
            end = last + 0
            if is_base(space, last):
                # Shifts of a base change nothing.
                end = group + _TURNS - 1
            else:
                for dof in range(group, last + 1):
                    rate = steps.response[rates + dof]
                    angular -= rate * steps.axis_angular[place * space.dofs + dof]
                    linear -= rate * steps.axis_linear[place * space.dofs + dof]
            for dof in range(group, end + 1):
                entry = place * space.dofs + dof
                axis = steps.axis_angular[entry]
                lift = wp.cross(axis, linear) + wp.cross(steps.axis_linear[entry], angular)
                steps.response[target + dof] += 2.0 * (
                    wp.dot(moment, wp.cross(axis, angular)) + wp.dot(push, lift)
                )
            row = model.dof[space.dof_row[group]].parent
