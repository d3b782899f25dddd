"""Mass matrices and bias forces of bodies, compared by the names of joints."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_allclose

from carom import algorithms


def assert_same_dynamics(first, second, tolerance=1e-12):
    """Compare M and C v + g of bodies at random states; those that move, in order."""
    ones, others = moving(first), moving(second)
    assert len(ones) == len(others)
    for one, other in zip(ones, others, strict=True):
        assert one.fixed_base == other.fixed_base
        names, same = list(joints_of(one)), list(joints_of(other))
        if set(names) == set(same):
            same = names
        # Others have names that the readers made up, in the order of the file.
        assert len(names) == len(same)
        rng = np.random.default_rng(3)
        state = {name: random_state(one, index, rng) for name, index in joints_of(one).items()}
        turn = rng.normal(size=4)
        base = ([*rng.normal(size=3), *(turn / np.linalg.norm(turn))], rng.normal(size=6))
        states = [state, {new: state[old] for old, new in zip(names, same, strict=True)}]
        found = [
            answers(body, order, each, base)
            for body, order, each in zip((one, other), (names, same), states, strict=True)
        ]
        matrix, bias = found[0]
        speed = max([1.0, *(abs(number) for _, rates in state.values() for number in rates), *abs(base[1])])
        # The bias consists of terms of this size, which cancel.
        sizes = max(1.0, np.abs(matrix).max()), max(1.0, np.abs(matrix).max()) * (speed**2 + 9.81)
        for expected, given, size in zip((matrix, bias), found[1], sizes, strict=True):
            assert_allclose(given, expected, rtol=0, atol=tolerance * size)


def moving(bodies):
    return [body for body in bodies if not body.fixed_base or joints_of(body)]


def joints_of(body):
    """Numbers of the links of joints that move, by name."""
    return {
        link.joint_name: index for index, link in enumerate(body.spec.links) if body.velocity_count[index]
    }


def random_state(body, index, rng):
    position = rng.uniform(-1.0, 1.0, body.position_count[index])
    if body.position_count[index] == 4:
        position /= np.linalg.norm(position)
    return position, rng.normal(size=body.velocity_count[index])


def answers(body, names, state, base):
    own = list(joints_of(body))
    positions = [number for name in own for number in state[name][0]]
    velocities = [number for name in own for number in state[name][1]]
    if not body.fixed_base:
        velocities = [*base[1], *velocities]
    free = [] if body.fixed_base else list(base[0])
    matrix = algorithms.mass_matrix(body, positions)
    bias = algorithms.bias_forces(body, [*free, *positions], velocities)
    # In the order of the names.
    first = 0 if body.fixed_base else 6
    places, at = {}, first
    for name in own:
        places[name] = list(range(at, at + len(state[name][1])))
        at += len(state[name][1])
    order = [*range(first), *(place for name in names for place in places[name])]
    return matrix[np.ix_(order, order)], bias[order]
