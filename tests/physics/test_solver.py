"""Projected Gauss-Seidel against the same method in NumPy, and against the exact solution."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.one_joint import DT, Motor, hanging_rod, place
from tests.physics.robots import coordinates, joint_coordinates, let_go, pendulum, put_in_motion, random_tree

from carom import Body, World
from carom.algorithms import mass_matrix
from carom.model.solver_order import quicksort_order

WANTED = [0.5, -0.4, 0.3, -0.2, 0.1, 0.6]


def driven_chain(sweeps: int, threshold: float, max_impulse: float) -> Body:
    """Six rods in a world without gravity, each with a target rate."""
    world = World(contact="bullet")
    world.parameters.solver_iterations = sweeps
    world.parameters.solver_residual_threshold = threshold
    world.apply_parameters()
    body = world.load(pendulum(len(WANTED)))
    for joint, rate in enumerate(WANTED):
        Motor(velocity=rate, max_impulse=max_impulse).set_on(body, joint)
    return body


def gauss_seidel(
    response: np.ndarray, wanted: np.ndarray, bound: float, sweeps: int, threshold: float
) -> tuple[np.ndarray, np.ndarray, int, float]:
    """Rates, impulses, sweeps and last residual; rows are visited last to first, then first to last."""
    order = quicksort_order([0] * len(wanted))
    rates, impulses = np.zeros_like(wanted), np.zeros_like(wanted)
    sweep, residual = 0, np.inf
    while sweep < sweeps and residual > threshold:
        residual = 0.0
        for row in order if sweep % 2 else reversed(order):
            before = impulses[row]
            unbounded = before + (wanted[row] - rates[row]) / response[row, row]
            impulses[row] = min(bound, max(-bound, unbounded))
            rates += response[:, row] * (impulses[row] - before)
            residual = max(residual, ((impulses[row] - before) * response[row, row]) ** 2)
        sweep += 1
    return rates, impulses, sweep, residual


@pytest.mark.parametrize("bound", [1e6, 0.8], ids=["strong", "weak"])
@pytest.mark.parametrize(("sweeps", "threshold"), [(1, 0.0), (2, 0.0), (7, 0.0), (50, 1e-7), (5000, 1e-3)])
def test_sweeps_are_those_of_gauss_seidel(sweeps, threshold, bound):
    body = driven_chain(sweeps, threshold, bound)
    response = np.linalg.inv(mass_matrix(body, np.zeros(len(WANTED))))
    rates, impulses, done, residual = gauss_seidel(response, np.array(WANTED), bound, sweeps, threshold)
    body.world.step()
    assert_allclose(joint_coordinates(body)[1], rates, rtol=0, atol=1e-10)
    assert_allclose(body.world.motor_impulse[6 : 6 + len(WANTED)], impulses, rtol=0, atol=1e-10)
    (report,) = body.world.analytics()
    assert report["numIterationsUsed"] == done
    assert report["remainingResidual"] == pytest.approx(residual, rel=1e-6, abs=1e-20)
    assert report["numBodies"] == len(WANTED)


def test_enough_sweeps_reach_all_targets():
    body = driven_chain(20_000, 0.0, 1e6)
    body.world.step()
    assert_allclose(joint_coordinates(body)[1], WANTED, rtol=0, atol=1e-9)


@pytest.mark.parametrize("inner", [1, 3])
def test_inner_passes_repeat_a_sweep(inner):
    """All passes of a sweep go the same way."""
    body = driven_chain(1, 0.0, 1e6)
    body.world.parameters.noncontact_inner_iterations = inner
    body.world.apply_parameters()
    response = np.linalg.inv(mass_matrix(body, np.zeros(len(WANTED))))
    rates = np.zeros(len(WANTED))
    for _ in range(inner):
        for row in reversed(quicksort_order([0] * len(WANTED))):
            rates += response[:, row] * (WANTED[row] - rates[row]) / response[row, row]
    body.world.step()
    assert_allclose(joint_coordinates(body)[1], rates, rtol=0, atol=1e-11)


def test_sweeps_end_when_rows_no_longer_change():
    body = hanging_rod()
    body.world.gravity = (0.0, 0.0, 0.0)
    for rate, sweeps in ((0.0, 1), (1.0, 2)):
        # The first sweep solves a single row; only the second finds nothing left to do.
        place(body, 0.0, rate)
        body.world.step()
        (report,) = body.world.analytics()
        assert report["numIterationsUsed"] == sweeps
        assert report["remainingResidual"] <= 1e-7


def test_an_impulse_on_a_joint_moves_all_of_a_free_tree():
    """The response to a row is that of the whole tree, its floating base included."""
    world = World(contact="bullet")
    body = world.load(random_tree(21, 6, fixed_base=False))
    put_in_motion(body, np.random.default_rng(21), speed=0.0)
    let_go(body)
    joint = next(j for j, count in enumerate(body.velocity_count) if count == 1)
    Motor(velocity=1.0, max_impulse=0.01).set_on(body, joint)
    body.set_inertial_pose((0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0))
    matrix = mass_matrix(body, joint_coordinates(body)[0])
    world.step()
    rates = coordinates(body)[1]
    impulse = np.zeros(len(rates))
    impulse[body.velocity_index[joint]] = 0.01
    assert_allclose(matrix @ rates, impulse, rtol=0, atol=1e-14)
    assert_allclose(coordinates(body)[0][:3], DT * rates[3:6], rtol=0, atol=1e-15)
