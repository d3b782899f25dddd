"""What resets of bodies and joints leave of the contacts that were there."""

import pytest

import pybullet as p
from carom.layouts.contacts import HELD_BEFORE
from pybullet._calls.builtin import exports
from pybullet._clients.clients import clients


def starts() -> list[float]:
    """Counters of contacts: the solver starts from the impulses of those that have at least 1."""
    arrays = clients[0].world.contact_arrays
    rows = arrays.contacts.numpy["contact_warm_start"][0, : arrays.contact_count]
    return rows.ravel().tolist()


@pytest.mark.parametrize("in_python", [False, True])
def test_contacts_of_a_body_that_is_placed_start_at_nothing(client: int, in_python: bool) -> None:
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3)
    p.createMultiBody(0.0, box)
    p.setGravity(0, 0, -10)
    body = p.createMultiBody(1.0, box, basePosition=[0, 0, 0.2])
    for _ in range(5):
        p.stepSimulation()
    assert any(starts())
    p.resetBaseVelocity(body, [0, 0, 0])
    assert any(starts())
    function = (
        exports["resetBasePositionAndOrientation"].function
        if in_python
        else p.resetBasePositionAndOrientation
    )
    function(body, [0, 0, 0.2], [0, 0, 0, 1])
    assert starts()
    assert set(starts()) <= {0.0, HELD_BEFORE}
