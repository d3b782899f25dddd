"""Steps that JAX differentiates: the bits of `Worlds.step`, and its vector-Jacobian products."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

jax = pytest.importorskip("jax", reason="differentiates steps")

import jax.numpy as jnp  # noqa: E402  # pyright: ignore[reportMissingImports]
from numpy.testing import assert_array_equal  # noqa: E402
from tests.gradients.scenes import ball_on_plane, cartpole, differing, panda  # noqa: E402
from tests.linearization.scenes import ASSETS  # noqa: E402

from carom import World, Worlds  # noqa: E402
from carom.jax import Stepper  # noqa: E402


@pytest.fixture(autouse=True)
def _in_doubles():
    before = jax.config.jax_enable_x64
    jax.config.update("jax_enable_x64", True)
    yield
    jax.config.update("jax_enable_x64", before)


@pytest.mark.parametrize("scene", [cartpole, panda, ball_on_plane])
def test_steps_have_the_bits_of_worlds(scene: Callable[[], World]):
    world = scene()
    world.parameters.solver_iterations = 10
    world.parameters.contact_warm_starting = 0.85
    world.apply_parameters()
    worlds, beside = differing(world, 3), differing(world, 3)
    stepper = Stepper(worlds, ["target_positions"])
    targets = stepper.control_values()

    def body(state: Any, _: Any) -> Any:
        return stepper(state, targets), state.positions

    last, _ = jax.jit(lambda start: jax.lax.scan(body, start, length=10))(stepper.state())
    beside.step(10)
    other = Stepper(beside).state()
    assert_array_equal(last.positions, other.positions)
    assert_array_equal(last.velocities, other.velocities)
    assert_array_equal(worlds.snapshot().state["link_pose"], beside.snapshot().state["link_pose"])


@pytest.mark.parametrize(
    ("scene", "controls", "parameters"),
    [
        (cartpole, ["torques"], ["masses"]),
        (panda, ["target_positions"], ["damping"]),
        (ball_on_plane, [], ["friction"]),
    ],
)
def test_gradients_are_those_of_torch(scene: Callable[[], World], controls: list[str], parameters: list[str]):
    torch = pytest.importorskip("torch", reason="differentiates the same steps")
    from carom.torch import State
    from carom.torch import Stepper as TorchStepper

    worlds = differing(scene(), 2)
    stepper = Stepper(worlds, controls, parameters=parameters)
    beside = TorchStepper(worlds, controls, parameters=parameters)
    start = stepper.state()
    arguments = start.positions, start.velocities, stepper.control_values(), stepper.parameter_values()
    rng = np.random.default_rng(0)
    weights = rng.normal(size=start.velocities.shape)

    def total(positions: Any, velocities: Any, given: Any, parameters: Any) -> Any:
        state = start._replace(positions=positions, velocities=velocities)
        for _ in range(2):
            state = stepper(state, given, parameters)
        return (state.velocities * weights).sum() + (state.positions**2).sum()

    found = jax.jit(jax.grad(total, argnums=(0, 1, 2, 3)))(*arguments)
    tensors = [torch.from_numpy(np.array(it)).requires_grad_() for it in arguments]
    memory = stepper._packing.unpack(np.asarray(start.memory))
    state = State(tensors[0], tensors[1], torch.zeros((2, 0), dtype=torch.float64), memory)
    for _ in range(2):
        state = beside(state, *tensors[2:])
    ((state.velocities * torch.from_numpy(weights)).sum() + state.positions.square().sum()).backward()
    for mine, tensor in zip(found, tensors, strict=True):
        wanted = np.zeros(tensor.shape) if tensor.grad is None else tensor.grad.numpy()
        assert np.asarray(mine) == pytest.approx(wanted, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize("scene", [cartpole, ball_on_plane])
def test_gradients_are_those_of_central_differences(scene: Callable[[], World]):
    from jax.test_util import check_grads  # pyright: ignore[reportMissingImports]

    stepper = Stepper(differing(scene(), 2), parameters=["masses"])
    start = stepper.state()

    def simulate(positions: Any, velocities: Any, torques: Any, masses: Any) -> Any:
        state = start._replace(positions=positions, velocities=velocities)
        for _ in range(2):
            state = stepper(state, torques, masses)
        return state.positions, state.velocities

    arguments = start.positions, start.velocities, stepper.control_values(), stepper.parameter_values()
    check_grads(simulate, arguments, order=1, modes=["rev"], eps=1e-6, atol=1e-5, rtol=1e-4)


@pytest.mark.parametrize("scene", [cartpole, panda, ball_on_plane])
def test_vmap_over_steps_and_gradients_is_a_loop_in_one_call(
    scene: Callable[[], World], monkeypatch: pytest.MonkeyPatch
):
    worlds = differing(scene(), 2)
    worlds.change_parameters(gravity=(0.0, 0.1, -9.0), where=[1])
    stepper = Stepper(worlds, ["torques"], parameters=["damping"])
    start, rates = stepper.state(), stepper.parameter_values()
    before = worlds.snapshot().state["position"]
    rng = np.random.default_rng(0)
    torques = jnp.asarray(rng.normal(size=(3, *stepper.control_values().shape)))
    velocities = start.velocities * jnp.asarray(rng.uniform(0.9, 1.1, (3, 1, 1)))

    def total(velocities: Any, given: Any, rates: Any) -> Any:
        state = start._replace(velocities=velocities)
        for _ in range(2):
            state = stepper(state, given, rates)
        return (state.velocities**2).sum() + state.positions.sum()

    calls: list[int] = []
    took, derived = Worlds.step, Worlds._derivatives
    monkeypatch.setattr(Worlds, "step", lambda own, *rest: calls.append(own.count) or took(own, *rest))
    monkeypatch.setattr(
        Worlds, "_derivatives", lambda own, *rest: calls.append(-own.count) or derived(own, *rest)
    )
    both = jax.value_and_grad(total, argnums=(0, 1, 2))
    found = jax.block_until_ready(jax.jit(jax.vmap(both, in_axes=(0, 0, None)))(velocities, torques, rates))
    assert calls == [6, 6, -6, -6]
    assert_array_equal(worlds.snapshot().state["position"], before)
    for number in range(3):
        wanted = both(velocities[number], torques[number], rates)
        for each, other in zip(jax.tree.leaves(found), jax.tree.leaves(wanted), strict=True):
            assert_array_equal(each[number], other)


def test_vmap_may_be_nested_and_batches_may_be_split(monkeypatch: pytest.MonkeyPatch):
    from carom.worlds.algorithms import repeated

    monkeypatch.setattr(repeated, "_TOGETHER", 8)
    worlds = differing(cartpole(), 4)
    stepper = Stepper(worlds, where=[1, 3])
    start = stepper.state()
    torques = jnp.asarray(np.random.default_rng(0).normal(size=(3, 2, 2, 2)))

    def after(given: Any) -> Any:
        state = stepper(stepper(start, given), given)
        return state, stepper(state, given).velocities

    found = jax.vmap(jax.vmap(after))(torques)
    for place in np.ndindex(3, 2):
        for each, other in zip(jax.tree.leaves(found), jax.tree.leaves(after(torques[place])), strict=True):
            assert_array_equal(each[place], other)


def test_batches_have_the_parameters_of_the_moment():
    worlds = differing(cartpole(), 2)
    stepper = Stepper(worlds)
    start, torques = stepper.state(), jnp.ones((3, 2, 2))
    for gravity in (-9.81, -3.0):
        worlds.change_parameters(gravity=(0.0, 0.0, gravity), where=[1])
        found = jax.vmap(lambda given: stepper(start, given).velocities)(torques)
        assert_array_equal(found[2], stepper(start, torques[2]).velocities)


def test_mistakes_are_named():
    stepper = Stepper(differing(cartpole(), 2))
    state, torques = stepper.state(), stepper.control_values()
    with pytest.raises(TypeError, match=r"controls are float32, .* use .astype\(float\)"):
        stepper(state, torques.astype(np.float32))
    with pytest.raises(ValueError, match=r"controls must have shape \(2, 2\), not \(2, 1\)"):
        stepper(state, torques[:, :1])
    with pytest.raises(ValueError, match=r"controls must have shape \(2, 2\), and are missing"):
        stepper(state)
    with pytest.raises(ValueError, match=r"the memory must have shape \(2, "):
        stepper(state._replace(memory=state.memory[:1]), torques)
    # What a callback raises has JAX's type.
    with pytest.raises(Exception, match="controls must be finite"):
        jax.block_until_ready(stepper(state, torques * np.nan))
    with pytest.raises(TypeError, match="forward-mode"):
        jax.jvp(lambda given: stepper(state, given).velocities, (torques,), (torques,))
    jax.config.update("jax_enable_x64", False)
    with pytest.raises(ValueError, match="jax_enable_x64"):
        Stepper(differing(cartpole(), 2))


def test_memory_has_room_for_so_many_contacts():
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(f"{ASSETS}/plane.urdf")
    for number in range(3):
        world.load_urdf(f"{ASSETS}/cube.urdf", (3.0 * number, 0.0, 0.51))
    stepper = Stepper(Worlds(world, 1, threads=1), [], contact_room=8)
    with pytest.raises(Exception, match=r"a world has 12 contacts, .* contact_room=12 or more"):
        state = stepper.state()
        for _ in range(30):
            state = jax.block_until_ready(stepper(state))
