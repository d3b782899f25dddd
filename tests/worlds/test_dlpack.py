"""Learning libraries get the state of many worlds, PyTorch without a copy."""

from __future__ import annotations

from operator import attrgetter

import numpy as np
import pytest

import pybullet_data
from carom import World, Worlds

torch = pytest.importorskip("torch", reason="is given the arrays")


@pytest.fixture
def arms():
    world = World(time_step=1 / 240)
    panda = world.load_urdf(f"{pybullet_data.getDataPath()}/franka_panda/panda.urdf", fixed_base=True)
    worlds = Worlds(world, 4)
    return worlds, worlds[panda]


@pytest.mark.parametrize(
    "name", ["joints.positions", "joints.velocities", "joints.torques", "base_inertial_poses"]
)
def test_a_tensor_is_the_view_and_not_a_copy(arms, name: str):
    _, panda = arms
    tensor = torch.from_dlpack(attrgetter(name)(panda))
    assert tensor.dtype == torch.float64
    assert tensor.data_ptr() == attrgetter(name)(panda).ctypes.data
    tensor[2, 1] = 0.125
    assert attrgetter(name)(panda)[2, 1] == 0.125


def test_a_tensor_shows_what_the_next_step_does(arms):
    worlds, panda = arms
    positions = torch.from_dlpack(panda.joints.positions)
    torch.from_dlpack(panda.joints.velocities)[1] = 0.5
    panda.joints.free()
    before = positions.clone()
    worlds.step()
    assert (positions[1] != before[1]).any()
    assert np.array_equal(positions.numpy(), panda.joints.positions)


@pytest.mark.filterwarnings("error")
def test_what_a_network_gives_is_taken(arms):
    worlds, panda = arms
    panda.joints.set_position_targets(torch.full((4, 9), 0.02, dtype=torch.float32), gains=0.5)
    worlds.step(200)
    assert np.allclose(panda.joints.positions[:, :3], 0.02, atol=1e-3)


def test_jax_takes_the_numbers_and_gives_some_back(arms):
    """By a copy: JAX sees memory without gaps only, and the joints of a body lie between its bases."""
    _, panda = arms
    panda.joints.positions[:] = 0.25
    jax = pytest.importorskip("jax", reason="JAX takes 600 MB, and is tried where it is there")
    with jax.enable_x64(True):
        array = jax.numpy.asarray(panda.joints.positions)
        assert array.dtype == np.float64
        assert float(array.sum()) == 9.0
        panda.joints.positions = 2.0 * array
    assert (panda.joints.positions == 0.5).all()
