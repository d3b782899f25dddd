"""Contacts of a manifold block, and of one alone, against projected Gauss-Seidel in NumPy, sweep by sweep."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.contact_scenes import (
    HALF,
    add_ball,
    add_box,
    add_floor,
    earth,
    impulses,
    motion,
    place,
)

from carom import Body, World

MASS = 1.0
FRICTION = 0.6
# Angular, then linear; fast enough to slide and to turn, so that bounds of friction are reached by some.
START = np.array([0.4, -0.3, 1.5, 0.5, -0.8, -0.6])


def scene(sweeps: int, cone: bool, ball: bool) -> tuple[World, Body]:
    world = earth(solver_iterations=sweeps, solver_residual_threshold=0.0, cone_friction=cone)
    world.apply_parameters()
    add_floor(world, lateral_friction=1.0)
    body = (add_ball if ball else add_box)(world, (0.0, 0.0, HALF - 1e-4), lateral_friction=FRICTION)
    body.set_base_velocity(START[3:].tolist(), START[:3].tolist())
    return world, body


def gauss_seidel(world: World, body: Body, centre: np.ndarray, moment: float, sweeps: int, cone: bool):
    """Impulses of the contacts found, (contacts, 3), and the velocity they leave, (6,)."""
    parameters = world.parameters
    step = parameters.substep_time
    arrays = {name: world.contact_arrays.contacts.numpy[f"contact_{name}"][0] for name in (
        "shapes", "point_a", "point_b", "normal", "direction1", "direction2", "distance"
    )}  # fmt: skip
    count = world.contact_arrays.contact_count
    inverse_mass = np.diag([1.0 / moment] * 3 + [1.0 / MASS] * 3)
    velocity = START + step * np.array([0.0, 0.0, 0.0, *parameters.gravity])
    jacobians, wanted = np.zeros((count, 3, 6)), np.zeros((count, 3))
    for contact in range(count):
        is_a = arrays["shapes"][contact, 2] == body.first_link
        point = arrays["point_a" if is_a else "point_b"][contact] - centre
        for row, name in enumerate(("normal", "direction1", "direction2")):
            direction = arrays[name][contact] * (1.0 if is_a else -1.0)
            jacobians[contact, row] = [*np.cross(point, direction), *direction]
        gap = arrays["distance"][contact] + parameters.contact_slop
        parting = -gap / step * (parameters.contact_erp if gap <= 0.0 else 1.0)
        wanted[contact] = [parting, 0.0, 0.0] - jacobians[contact] @ velocity
    responses = jacobians @ inverse_mass
    gains = np.einsum("cri,cri->cr", jacobians, responses)
    found, change = np.zeros((count, 3)), np.zeros(6)

    def unbounded(contact: int, row: int) -> float:
        error = wanted[contact, row] - jacobians[contact, row] @ change
        return found[contact, row] + error / gains[contact, row]

    def take(contact: int, row: int, impulse: float) -> None:
        change[:] += responses[contact, row] * (impulse - found[contact, row])
        found[contact, row] = impulse

    for _ in range(sweeps):
        for contact in range(count):
            take(contact, 0, max(0.0, unbounded(contact, 0)))
        for contact in range(count):
            bound = FRICTION * found[contact, 0]
            if cone:
                both = np.array([unbounded(contact, 1), unbounded(contact, 2)])
                both *= min(1.0, bound / max(np.linalg.norm(both), 1e-300))
                take(contact, 1, both[0])
                take(contact, 2, both[1])
            elif bound > 0.0:
                # Where nothing pushes friction is left as it was, as in Bullet.
                for row in (1, 2):
                    take(contact, row, np.clip(unbounded(contact, row), -bound, bound))
    return found, velocity + change


@pytest.mark.parametrize("ball", [False, True], ids=["four contacts", "one contact"])
@pytest.mark.parametrize("cone", [True, False], ids=["cone", "pyramid"])
@pytest.mark.parametrize("sweeps", [1, 2, 7])
def test_sweeps_over_contacts_are_those_of_gauss_seidel(sweeps, cone, ball):
    world, body = scene(sweeps, cone, ball)
    centre = place(body)
    world.step()
    moment = (0.4 if ball else 4.0 / 6.0) * HALF**2 * MASS
    found, velocity = gauss_seidel(world, body, centre, moment, sweeps, cone)
    assert len(found) == (1 if ball else 4)
    assert_allclose(impulses(world), found, rtol=0, atol=1e-12)
    assert_allclose(motion(body), velocity, rtol=0, atol=1e-11)


def test_both_directions_of_a_pyramid_are_bounded_somewhere_and_free_elsewhere():
    """Else the comparison above would not notice what bounds do, or what one direction does to the other."""
    world, _ = scene(7, cone=False, ball=False)
    world.step()
    normal, first, second = impulses(world)[impulses(world)[:, 0] > 0.0].T
    shares = np.abs([first, second]) / (FRICTION * normal)
    assert (shares > 1.0 - 1e-9).any() and (shares < 0.9).any()
