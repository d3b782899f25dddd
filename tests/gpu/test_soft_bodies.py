"""Worlds with soft bodies in fine launches: as on the processor, whatever happens in between.

They run on the CPU with kernels compiled as those of the native library are, bit for bit, and on Warp's CPU
device or a GPU, up to rounding.
"""

from __future__ import annotations

from collections.abc import Callable
from math import sqrt

import numpy as np
import pytest

pytest.importorskip("warp", reason="launches the kernels")

import torch
from tests.gpu.native_device import NativeDevice
from tests.soft.scenes import rigid, world

import pybullet_data
from carom import World, Worlds
from carom.description import Box, Plane, Sphere
from carom.errors import SimulationWarning
from carom.gpu.device import Device
from carom.layouts.codes import ASLEEP
from carom.layouts.flags import ActivationChange
from carom.layouts.status import STATUS

COUNT = 3
# What a quarter of a second may differ by: other compilers fuse products and sums, and have other sines.
CLOSE = 1e-9
FINGERS = ("panda_finger_joint1", "panda_finger_joint2")


def cloth_on_a_ball() -> World:
    """Cloth on a ball that it pushes, which lies on a plane."""
    where = world()
    rigid(where, Plane())
    rigid(where, Sphere(0.12), 0.5, (0.02, 0.0, 0.121))
    where.load_cloth((0.5, 0.5), (8, 8), (0.0, 0.0, 0.26))
    return where


def anchored_cloth() -> World:
    """Cloth held by a box that hangs on it, and by the world; it may touch itself. There is no plane."""
    where = world()
    where.parameters.substeps = 2
    block = rigid(where, Box((0.1, 0.1, 0.1)), 1.0, (-0.3, -0.3, 0.5))
    cloth = where.load_cloth((0.6, 0.6), (6, 6), (0.0, 0.0, 0.5), self_collision=True)
    cloth.anchor(0, block)
    cloth.anchor(48)
    return where


def hanging_rope() -> World:
    """A rope and nothing else, without a shape of any kind."""
    where = world()
    where.load_rope(0.4, 8, (0.0, 0.0, 1.0)).anchor(0)
    return where


def soft_cubes() -> World:
    """Two solids, one on a plane and the other falling on it."""
    where = world()
    rigid(where, Plane())
    where.load_soft_solid((0.2, 0.2, 0.2), (2, 2, 2), (0.0, 0.0, 0.106))
    where.load_soft_solid((0.2, 0.2, 0.2), (2, 2, 2), (0.04, 0.02, 0.33))
    return where


def towel_between_links() -> World:
    """Cloth between the fingers of an arm, which close on it."""
    where = world()
    arm = where.load_urdf(f"{pybullet_data.getDataPath()}/franka_panda/panda.urdf", fixed_base=True)
    for finger in FINGERS:
        arm.joints[finger].reset(0.015)
        arm.joints[finger].set_position_target(0.0, max_force=20.0)
    tips = [arm.joints[finger].child.pose.position for finger in FINGERS]
    place = tuple(np.mean(tips, axis=0) - [0.0, 0.0, 0.09])
    where.load_cloth((0.16, 0.16), (8, 8), place, (sqrt(0.5), 0.0, 0.0, sqrt(0.5)), mass=0.05)
    return where


SCENES: list[Callable[[], World]] = [
    cloth_on_a_ball,
    anchored_cloth,
    hanging_rope,
    soft_cubes,
    towel_between_links,
]


def last_body(scene: World) -> int:
    """The number of the last body of a scene, which is soft."""
    return max(scene.bodies.keys())


def stirred(scene: World, device: str | Device) -> Worlds:
    """Worlds of a scene, each with its gravity, friction and motion; a force acts on a node for one step."""
    worlds = Worlds(scene, COUNT, device=device)
    soft = worlds[last_body(scene)]
    worlds.gravity = [[0.1 * number, 0.0, -9.81] for number in range(COUNT)]
    soft.change_dynamics(-1, lateral_friction=np.linspace(0.2, 0.8, COUNT))
    for number in range(COUNT):
        soft.node_velocities[number, :, 0] += 0.1 * number
    soft.node_forces[:, 5, 2] = 0.5
    return worlds


def state(worlds: Worlds) -> dict[str, np.ndarray]:
    """The rows of the state that are in use, on the host."""
    arrays = worlds._engine.arrays
    return {
        name: np.asarray(array)[:, : arrays.used[axis]].copy()
        for name, array in arrays.state.numpy.items()
        if (axis := name.partition("_")[0]) in arrays.used
    }


@pytest.fixture(params=["compiled like the native library", "Warp"])
def kind(request: pytest.FixtureRequest) -> tuple[str | Device, float]:
    """A device, and what it may differ from the processor by."""
    if request.param == "Warp":
        return request.getfixturevalue("device"), CLOSE
    return NativeDevice(), 0.0


@pytest.mark.long
@pytest.mark.parametrize("scene", SCENES)
def test_worlds_are_those_of_the_processor(
    scene: Callable[[], World], kind: tuple[str | Device, float]
) -> None:
    made = scene()
    device, close = kind
    there, here = stirred(made, device), stirred(made, "cpu")
    before = state(here)
    for worlds in (there, here):
        start = worlds.snapshot()
        worlds.step(20)
        worlds.restore(start, where=np.array([False, True, False]))
        worlds.step(15, where=[0, 1])
        middle = worlds.snapshot(where=[2])
        worlds.step(15)
        worlds.restore(middle, where=[0])
        worlds.step(25)
    assert there.time.tolist() == here.time.tolist()
    ours, theirs = state(there), state(here)
    for name, expected in theirs.items():
        np.testing.assert_allclose(ours[name], expected, rtol=0.0, atol=close, err_msg=name)
    assert np.abs(theirs["node_position"] - before["node_position"]).max() > 1e-3
    assert theirs["node_push"].any() == (scene is not hanging_rope)
    assert not np.array_equal(theirs["node_position"][1], theirs["node_position"][2])
    np.testing.assert_array_equal(theirs["node_force"], 0.0)


def test_rows_that_nodes_need_on_an_arm_find_room() -> None:
    """A step for which there is no room is repeated, with the forces of users."""
    made = towel_between_links()
    there, here = stirred(made, NativeDevice()), stirred(made, "cpu")
    for worlds in (there, here):
        worlds.step(40)
    assert there._engine.growths > 0
    for name, expected in state(here).items():
        np.testing.assert_array_equal(state(there)[name], expected, err_msg=name)


def test_bodies_that_are_not_finite_take_their_own_world_back_and_no_other(
    kind: tuple[str | Device, float],
) -> None:
    made = cloth_on_a_ball()
    device, close = kind
    there, here = stirred(made, device), stirred(made, "cpu")
    ball, cloth = list(made.bodies.values())[1:]
    before = {}
    for worlds in (there, here):
        worlds.step(5)
        worlds[cloth].node_velocities[1, 7, 2] = np.nan
        worlds[cloth].node_forces[1:, 3, 2] = 2.0
        # The cloth on it would not be finite either, soon after.
        worlds._engine.arrays.state.numpy["dof_velocity"][2, ball.first_velocity + 3] = np.nan
        before = state(worlds)
        with pytest.warns(SimulationWarning, match="halted"):
            worlds.step(3)
        assert worlds.halted.tolist() == [False, True, True]
    for name in ("node_position", "node_velocity", "position", "dof_velocity"):
        np.testing.assert_array_equal(state(there)[name][1:], before[name][1:], err_msg=name)
    for name, expected in state(here).items():
        np.testing.assert_allclose(state(there)[name], expected, rtol=0.0, atol=close, err_msg=name)
    # The force does not act in a later step either.
    np.testing.assert_array_equal(state(there)["node_force"], 0.0)
    at_fault = [1 + made.bodies[body.id].rows.tree for body in (cloth, ball)]
    for worlds in (there, here):
        assert worlds._engine.status[1:, STATUS].tolist() == at_fault


def test_cloth_wakes_a_box_on_which_it_falls() -> None:
    made = world()
    rigid(made, Plane())
    box = rigid(made, Box((0.2, 0.2, 0.2)), 1.0, (0.0, 0.0, 0.1))
    box.change_dynamics(-1, activation_state=int(ActivationChange.ENABLE_SLEEPING))
    cloth = made.load_cloth((0.3, 0.3), (4, 4), (0.0, 0.0, 1.0))
    cloth.anchor(0)
    cloth.anchor(24)
    there, here = Worlds(made, 2, device=NativeDevice()), Worlds(made, 2)
    for worlds in (there, here):
        worlds.step(600)
        assert (worlds._engine.arrays.state.numpy["tree_activity"][:, box.rows.tree] == ASLEEP).all()
        worlds[cloth].nodes[1, :, 2] -= 0.7
        worlds[cloth].node_velocities[1, :, 2] = -2.0
        worlds.step(30)
    asleep = state(there)["tree_activity"][:, box.rows.tree] == ASLEEP
    assert asleep.tolist() == [True, False]
    for name, expected in state(here).items():
        np.testing.assert_array_equal(state(there)[name], expected, err_msg=name)


def test_nodes_are_shared_with_other_libraries_and_copied_to_lone_worlds(device: str) -> None:
    if device != "warp-cpu" and not torch.cuda.is_available():
        pytest.skip("this PyTorch knows no GPU")
    made = anchored_cloth()
    worlds = Worlds(made, COUNT, device=device)
    soft = worlds[last_body(made)]
    tensor = torch.from_dlpack(soft.nodes)
    assert tuple(tensor.shape) == (COUNT, 49, 3)
    tensor[1, :, 2] += 0.25
    worlds.step(10)
    lone, moved = worlds.extract(0), worlds.extract(1)
    nodes = np.asarray(soft.nodes)
    for number, other in enumerate((lone, moved)):
        np.testing.assert_array_equal(other.arrays.state.numpy["node_position"][0, :49], nodes[number])
    assert (nodes[1, 20, 2] - nodes[0, 20, 2]) > 0.1
    lone.step(10)
    worlds.step(10)
    np.testing.assert_allclose(
        lone.arrays.state.numpy["node_position"][0, :49], np.asarray(soft.nodes)[0], rtol=0.0, atol=CLOSE
    )
