"""Worlds on a GPU, or on Warp's own CPU device, which has memory of its own and is asked for the same."""

from __future__ import annotations

import os
from operator import attrgetter
from typing import Any

import numpy as np
import pytest

pytest.importorskip("warp", reason="launches the kernels")

import torch
import warp as wp
from tests.engine.failing import everything, full_scene, spoil
from tests.physics.contact_scenes import add_ball, add_floor, earth
from tests.physics.test_contact_worlds import heap

import pybullet_data
from carom import Body, Camera, DistancePoints, World, Worlds
from carom.errors import SimulationWarning
from carom.gpu.array import DeviceArray
from carom.gpu.warp_device import WarpDevice
from carom.layouts.contacts import THERE

DATA = pybullet_data.getDataPath()
COUNT = 4
# What one second without contact may differ by: the compiler fuses products and sums, and has other sines.
CLOSE = 1e-9


def near(device: str) -> torch.device:
    """Where PyTorch has tensors that are on a device already."""
    if device == "warp-cpu":
        return torch.device("cpu")
    if not torch.cuda.is_available():
        pytest.skip("this PyTorch knows no GPU")
    return torch.device(device)


@pytest.fixture
def arm() -> tuple[World, Body]:
    world = earth()
    return world, world.load_urdf(f"{DATA}/franka_panda/panda.urdf", fixed_base=True)


@pytest.fixture
def balls() -> tuple[World, Body, Body]:
    world = earth()
    floor = add_floor(world)
    ball = add_ball(world, (0.0, 0.0, 0.3))
    add_ball(world, (5.0, 0.0, 3.0))
    return world, floor, ball


def test_a_second_of_an_arm_with_motors_is_that_of_worlds_on_the_processor(
    device: str, arm: tuple[World, Body]
) -> None:
    world, panda = arm
    random = np.random.default_rng(1)
    targets = random.uniform(-1.0, 1.0, (COUNT, 9))
    there, here = Worlds(world, COUNT, device=device), Worlds(world, COUNT)
    for worlds in (there, here):
        batch = worlds[panda]
        batch.joints[["panda_joint4"]].enable_sensors()
        batch.change_dynamics("panda_hand", mass=np.linspace(0.5, 2.0, COUNT))
        batch.joints.set_position_targets(targets, gains=0.1, max_forces=60.0)
        worlds.step(120)
        batch.links["panda_hand"].apply_force((0.0, 0.0, 5.0), (0.1, 0.2, 0.9))
        batch.joints[["panda_joint1"]].set_torques(0.5)
        worlds.step(120)
    for name in (
        "joints.positions", "joints.velocities", "joints.motor_torques", "links.poses", "links.velocities",
        "joints.reactions", "base_velocities",
    ):  # fmt: skip
        ours, theirs = np.asarray(attrgetter(name)(there[panda])), attrgetter(name)(here[panda])
        assert ours.shape == theirs.shape
        # Torques and wrenches are of the order of 100 N.
        wide = name in ("joints.motor_torques", "joints.reactions")
        np.testing.assert_allclose(ours, theirs, rtol=0, atol=100 * CLOSE if wide else CLOSE, err_msg=name)
    assert np.abs(here[panda].joints.positions).max() > 0.1
    assert there.time.tolist() == here.time.tolist()


def test_a_heap_outgrows_its_arrays_and_comes_to_lie_where_it_does_on_the_processor(device: str) -> None:
    scene = earth()
    heap(scene, 12)
    there, here = Worlds(scene, 2, device=device), Worlds(scene, 2)
    room = there._engine.contact_arrays.contacts.capacity["contact"]
    for worlds in (there, here):
        worlds.step(60)
    # Later, the number of points of boxes that lie on each other is up to rounding.
    counts = np.asarray(there._engine.contact_arrays.contacts.numpy["count_contacts"])[:, THERE]
    np.testing.assert_array_equal(
        counts, here._engine.contact_arrays.contacts.numpy["count_contacts"][:, THERE]
    )
    for worlds in (there, here):
        worlds.step(60)
    assert there._engine.contact_arrays.contacts.capacity["contact"] > room
    # Rounding differs on the device, and while boxes tumble over each other differences grow.
    for batch, other in zip(there, here, strict=True):
        np.testing.assert_allclose(
            np.asarray(batch.base_inertial_poses), other.base_inertial_poses, atol=2e-3
        )


def test_worlds_are_reset_left_out_and_extracted(device: str, balls: tuple[World, Body, Body]) -> None:
    world, floor, ball = balls
    there, here = Worlds(world, COUNT, device=device), Worlds(world, COUNT)
    mask = np.array([False, True, False, True])
    for worlds in (there, here):
        start = worlds.snapshot()
        worlds.step(40)
        worlds.restore(start, where=mask)
        worlds[ball].set_base_velocities((1.0, 0.0, 0.0, 0.0, 0.0, 0.0), where=[3])
        worlds.step(20, where=[0, 3])
        worlds[ball].set_base_inertial_poses((0.0, 0.0, 0.5), where=torch.tensor([False, False, True, False]))
        worlds.step(3)
    np.testing.assert_allclose(
        np.asarray(there[ball].base_inertial_poses), here[ball].base_inertial_poses, atol=CLOSE
    )
    assert there.time.tolist() == here.time.tolist()
    ours, theirs = there.contacts(ball, floor), here.contacts(ball, floor)
    for name, array in zip(ours._fields, ours, strict=True):
        expected = getattr(theirs, name)
        assert np.asarray(array).dtype == expected.dtype
        np.testing.assert_allclose(np.asarray(array), expected, atol=1e-6, err_msg=name)
    touching = np.asarray(there.links_in_contact(ball, floor))
    np.testing.assert_array_equal(touching, here.links_in_contact(ball, floor))
    assert touching.any() and not touching.all()
    lone, other = there.extract(0), here.extract(0)
    lone.step(30)
    other.step(30)
    np.testing.assert_allclose(lone.position, other.position, atol=CLOSE)


def test_a_world_that_is_not_finite_halts_alone(device: str, balls: tuple[World, Body, Body]) -> None:
    world, _, ball = balls
    worlds = Worlds(world, COUNT, device=device)
    start = worlds.snapshot()
    worlds[ball].base_inertial_poses[:, 0] = 0.25
    worlds._engine.arrays.state.numpy["dof_velocity"][1, ball.first_velocity + 3] = np.nan
    with pytest.warns(SimulationWarning, match=f"world 1 is halted: its body '{ball.name}' has a velocity"):
        worlds.step(4)
    assert worlds.halted.tolist() == [False, True, False, False]
    worlds.step(3)
    worlds.restore(start, where=worlds.halted)
    assert not worlds.halted.any()
    worlds.step()
    assert np.isfinite(np.asarray(worlds[ball].base_inertial_poses)).all()


def test_a_world_that_is_halted_has_the_state_of_before(device: str) -> None:
    world, last = full_scene()
    worlds = Worlds(world, COUNT, device=device)
    worlds.step(5)
    expected = everything(worlds.extract(1))
    spoil(worlds, last)
    with pytest.warns(SimulationWarning, match="world 1 is halted"):
        worlds.step(3)
    halted = everything(worlds.extract(1))
    for name, array in expected.items():
        np.testing.assert_array_equal(halted[name], array, err_msg=name)


def test_rays_and_gravity(device: str, balls: tuple[World, Body, Body]) -> None:
    world, _, ball = balls
    there, here = Worlds(world, COUNT, device=device), Worlds(world, COUNT)
    starts = np.array([[0.0, 0.0, 5.0], [3.0, 3.0, 5.0], [0.02, 0.0, 5.0], [0.0, 0.01, 5.0], [0.0, 0.0, 4.0]])
    found = []
    for worlds in (there, here):
        worlds.gravity = [[0.0, 0.0, -1.0 - number] for number in range(COUNT)]
        worlds.step(24)
        found.append(worlds.rays(starts, starts * [1.0, 1.0, -1.0]))
        assert worlds.gravity[2, 2] == -3.0
    for ours, theirs in zip(*found, strict=True):
        np.testing.assert_allclose(np.asarray(ours), theirs, atol=CLOSE)
    assert there.detect_collisions() is None
    np.testing.assert_allclose(
        np.asarray(there[ball].base_inertial_poses), here[ball].base_inertial_poses, atol=CLOSE
    )


def test_distances_of_shapes(device: str, balls: tuple[World, Body, Body]) -> None:
    world, floor, ball = balls
    scene = world.copy()
    scene.bodies[ball.id].add_sensor(
        "points",
        DistancePoints(link=ball.spec.base.name, other_link=floor.spec.base.name, other_body=floor.name),
    )
    found = []
    for where in (device, "cpu"):
        worlds = Worlds(scene, COUNT, device=where)
        worlds[ball.id].set_base_inertial_poses([[0.1, 0.2, 1.0 + number] for number in range(COUNT)])
        found.append(worlds[ball.id].sensors["points"].read())
    np.testing.assert_allclose(np.diff(found[1][:, 2]), 1.0, atol=CLOSE)
    np.testing.assert_allclose(*found, atol=CLOSE)


def test_balls_of_other_sizes(device: str, balls: tuple[World, Body, Body]) -> None:
    world, _, ball = balls
    found = []
    for where in (device, "cpu"):
        worlds = Worlds(world, COUNT, device=where)
        worlds[ball].shapes[0].size = [[0.2], [0.3], [0.4], [0.5]]
        worlds.step(240)
        sizes = np.asarray(worlds[ball].shapes[0].size)
        found.append((sizes, np.asarray(worlds[ball].pose.position), worlds[ball].bounds.lower))
        worlds.reset()
    for here, there in zip(*found, strict=True):
        np.testing.assert_allclose(here, there, atol=1e-6)
    np.testing.assert_allclose(found[0][1][:, 2], [0.1, 0.15, 0.2, 0.25], atol=2e-3)


def test_images_are_drawn_on_the_processor(device: str, balls: tuple[World, Body, Body]) -> None:
    world, _, ball = balls
    camera = Camera.with_field_of_view(32, 24, 60.0).look_at((2.0, 0.0, 0.6), (0.0, 0.0, 0.5))
    pictures = []
    for where in (device, "cpu"):
        worlds = Worlds(world, 2, device=where)
        worlds[ball].set_base_inertial_poses([[0.0, 0.0, 0.5], [0.0, 0.4, 0.5]])
        pictures.append(worlds.images(camera))
    np.testing.assert_array_equal(pictures[0].body_ids, pictures[1].body_ids)
    assert (pictures[0].body_ids[0] != pictures[0].body_ids[1]).any()


# What learning libraries get and give


@pytest.mark.parametrize(
    "name", ["joints.positions", "joints.velocities", "joints.torques", "base_inertial_poses"]
)
def test_libraries_see_the_memory_itself(device: str, arm: tuple[World, Body], name: str) -> None:
    world, panda = arm
    batch = Worlds(world, COUNT, device=device)[panda]
    view = attrgetter(name)(batch)
    assert near(device).type == torch.from_dlpack(view).device.type
    tensor = torch.from_dlpack(view)
    assert (tuple(tensor.shape), tensor.data_ptr()) == (view.shape, view.pointer)
    tensor[2, 1] = 0.125
    assert float(attrgetter(name)(batch)[2, 1]) == 0.125
    # NumPy gets a copy, as from any GPU.
    copy = np.asarray(view)
    tensor[2, 1] = 0.5
    assert copy[2, 1] == 0.125


@pytest.mark.skipif("CAROM_TEST_DEVICE" in os.environ, reason="NumPy sees the memory of the host only")
def test_numpy_sees_the_memory_of_the_host_itself(device: str, arm: tuple[World, Body]) -> None:
    world, panda = arm
    view: Any = Worlds(world, COUNT, device=device)[panda].joints.positions
    array = np.from_dlpack(view)
    assert (array.shape, array.ctypes.data) == (view.shape, view.pointer)
    view[1] = 0.25
    assert (array[1] == 0.25).all()


def test_a_tensor_shows_what_the_next_step_does(device: str, arm: tuple[World, Body]) -> None:
    world, panda = arm
    worlds = Worlds(world, COUNT, device=device)
    batch = worlds[panda]
    near(device)
    positions = torch.from_dlpack(batch.joints.positions)
    torch.from_dlpack(batch.joints.velocities)[1] = 0.5
    batch.joints.free()
    before = positions.clone()
    worlds.step()
    assert (positions[1] != before[1]).any()


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_what_a_network_gives_is_taken_where_it_is(
    device: str, arm: tuple[World, Body], dtype: torch.dtype, monkeypatch: pytest.MonkeyPatch
) -> None:
    world, panda = arm
    worlds = Worlds(world, COUNT, device=device)
    batch = worlds[panda]
    kind: dict[str, Any] = {"dtype": dtype, "device": near(device)}
    targets = torch.linspace(-9.0, 0.02, COUNT * 9, **kind).reshape(COUNT, 9).requires_grad_()
    # Nothing is read back on the way.
    monkeypatch.setattr(DeviceArray, "numpy", None)
    batch.joints.set_position_targets(targets, gains=0.5, max_forces=targets.detach().abs() + 100.0)
    batch.joints[[0, 1]].set_velocity_targets(torch.zeros(COUNT, 2, **kind))
    batch.joints.set_torques(targets)
    batch.joints.velocities = torch.full((9,), 0.25, **kind)
    batch.links["panda_hand"].apply_force(torch.ones(COUNT, 3, **kind))
    batch.links["panda_hand"].apply_torque(torch.ones(3, **kind))
    batch.set_base_velocities(torch.arange(6, **kind))
    monkeypatch.undo()
    motor = np.asarray(worlds._engine.arrays.state.numpy["dof_motor"])[:, batch._dofs]
    lower, upper = batch.joints.limits
    given = targets.detach().double().cpu().numpy()
    np.testing.assert_allclose(motor[:, 2:, 0], np.clip(given, lower, upper)[:, 2:], atol=1e-15)
    assert (motor[:, :2, 0] == 0.0).all()
    np.testing.assert_allclose(motor[:, 2:, 4], (np.abs(given) + 100.0)[:, 2:] / 240.0, rtol=1e-6)
    np.testing.assert_array_equal(np.asarray(batch.joints.torques), given)
    np.testing.assert_array_equal(np.asarray(batch.joints.velocities), np.full((COUNT, 9), 0.25))
    np.testing.assert_array_equal(np.asarray(batch.base_velocities)[1], np.arange(6.0))
    with pytest.raises(ValueError, match=r"torques has shape \(4, 5\); it must have shape \(4, 9\)"):
        batch.joints.set_torques(torch.zeros(COUNT, 5))


def test_arrays_are_indexed_as_numpy_does(device: str) -> None:
    values = np.arange(60.0).reshape(3, 4, 5)
    array = DeviceArray.zeros(values.shape, values.dtype, "cpu" if device == "warp-cpu" else device)
    array[...] = values
    for key in (
        1, (slice(None), 2), (..., 3), (slice(1, 3), slice(0, 4, 2)), ([2, 0],), (slice(None), [3, -1, 0], 2),
        (np.array([True, False, True]), slice(1, 3)), (-1, -2, -3),
    ):  # fmt: skip
        np.testing.assert_array_equal(array[key].numpy(), values[key])
        changed = values.copy()
        changed[key] += 100.0
        array[key] += 100.0
        np.testing.assert_array_equal(array.numpy(), changed)
        array[...] = values
    for wrong in (3, (0, 0, 0, 0), ([0], [1]), ([7],), (np.array([True]),)):
        with pytest.raises(IndexError):
            array[wrong]
    with pytest.raises(ValueError, match="does not broadcast"):
        array[0] = np.zeros((3, 5))
    with pytest.raises(ValueError, match="arrays of 4 axes cannot be combined"):
        _ = array.reshape(1, *values.shape) + 1.0
    np.testing.assert_array_equal((2.0 * array / 4.0 - 1.0).numpy(), values / 2.0 - 1.0)
    np.testing.assert_array_equal(
        np.clip(array, 3.0, values[..., :1] + 2.0), np.clip(values, 3.0, values[..., :1] + 2.0)
    )
    np.testing.assert_array_equal(
        np.cross(array[0, :, :3], [1.0, 2.0, 3.0]), np.cross(values[0, :, :3], [1, 2, 3])
    )


# Devices that are not there


def test_devices_are_refused_that_are_not_there(
    arm: tuple[World, Body], monkeypatch: pytest.MonkeyPatch
) -> None:
    world, _ = arm
    for name in ("toaster", "cuda:", "cuda:x", "cpu:0"):
        with pytest.raises(
            ValueError, match="device must be 'cpu', 'cuda' or a GPU by number such as 'cuda:1'"
        ):
            Worlds(world, 1, device=name)
    monkeypatch.setattr("carom.worlds.devices.util.find_spec", lambda name: None)
    with pytest.raises(ImportError, match=r"device 'cuda' needs NVIDIA Warp: pip install 'carom\[gpu\]'"):
        Worlds(world, 1, device="cuda")


@pytest.mark.skipif(wp.is_cuda_available(), reason="there is a GPU")
def test_without_a_gpu_that_is_said(arm: tuple[World, Body]) -> None:
    with pytest.raises(ValueError, match="there is no device 'cuda:1': no NVIDIA GPU or no driver"):
        Worlds(arm[0], 1, device="cuda:1")


def test_an_array_that_does_not_fit_is_refused_before_it_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    device = WarpDevice("cpu")
    monkeypatch.setattr(device, "free_memory", lambda: 2_000_000_000)
    with pytest.raises(MemoryError, match=r"an array of 8\.0 GB does not fit on cpu: 2\.0 GB are free"):
        device.zeros((1_000_000_000,), np.dtype(np.float64))
