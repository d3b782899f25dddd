"""Steps that PyTorch differentiates: the bits of `Worlds.step`, and gradients beside finite differences."""

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

torch = pytest.importorskip("torch", reason="differentiates steps")

from numpy.testing import assert_array_equal  # noqa: E402
from tests.gradients.scenes import ball_on_plane, cartpole, differing, panda  # noqa: E402
from tests.linearization.scenes import excite, motors_off, new_world  # noqa: E402

import carom.torch  # noqa: E402
from carom import World, Worlds  # noqa: E402
from carom.description.actuator import ActivationDynamics, GeneralActuator  # noqa: E402
from carom.errors import SimulationError, SimulationWarning  # noqa: E402
from carom.layouts.codes import ABSENT, ASLEEP  # noqa: E402
from carom.torch import State, Stepper  # noqa: E402

ROBOTS = Path(__file__).parents[1] / "conformance" / "robots"


def gradient(tensor: Any) -> np.ndarray:
    """The gradient that `backward` has left."""
    assert tensor.grad is not None
    return tensor.grad.numpy()


def passes_gradcheck(stepper: Stepper, steps: int) -> bool:
    """Whether the gradients of some steps by all that they start from are those of central differences."""
    start = stepper.state()
    given = [start.positions, start.velocities, stepper.control_values(), stepper.parameter_values()]
    names = [name for name, it in zip("qvcp", given, strict=True) if it.shape[1]]

    def simulate(*tensors: Any) -> Any:
        parts = dict(zip(names, tensors, strict=True))
        state = start.replaced(positions=parts["q"], velocities=parts["v"])
        for _ in range(steps):
            state = stepper(state, parts.get("c"), parts.get("p"))
        return state.positions, state.velocities

    tensors = [it.clone().requires_grad_() for it in given if it.shape[1]]
    return torch.autograd.gradcheck(simulate, tensors, eps=1e-6, atol=1e-6, rtol=1e-4)


@pytest.mark.parametrize(
    ("scene", "controls", "parameters", "steps"),
    [
        (cartpole, ["torques"], ["masses", "inertias"], 3),
        (panda, ["target_positions"], ["panda.panda_link3.mass", "motor_position_gains"], 1),
        (ball_on_plane, [], ["masses", "friction"], 2),
    ],
)
def test_gradients_are_those_of_central_differences(
    scene: Callable[[], World], controls: list[str], parameters: list[str], steps: int
):
    assert passes_gradcheck(Stepper(differing(scene(), 2), controls, parameters=parameters), steps)


def test_gradients_by_spherical_and_planar_joints():
    world = new_world()
    for name in ("spherical_chain", "planar_body"):
        place = (0.0, 5.0 * len(world.bodies), 0.0)
        robot = world.load_urdf(ROBOTS / f"{name}.urdf", place, fixed_base=True)
        excite(robot)
        motors_off(robot)
    assert passes_gradcheck(Stepper(Worlds(world, 2, threads=1), ["torques"]), 2)


@pytest.mark.parametrize("scene", [cartpole, panda, ball_on_plane])
def test_steps_have_the_bits_of_worlds(scene: Callable[[], World]):
    world = scene()
    # As users have it: sweeps stop early, and begin with the impulses of the step before.
    world.parameters.solver_iterations = 10
    world.parameters.contact_warm_starting = 0.85
    world.apply_parameters()
    worlds, beside = differing(world, 3), differing(world, 3)
    stepper = Stepper(worlds, ["target_positions"])
    state, targets = stepper.state(), stepper.control_values()
    for _ in range(10):
        # What else is done with the worlds does not matter.
        stepper(state.replaced(velocities=state.velocities + 1.0), targets)
        state = stepper(state, targets)
        beside.step()
    mine, its = worlds.snapshot(), beside.snapshot()
    for name, array in its.state.items():
        assert_array_equal(mine.state[name], array, name)
    assert_array_equal(mine.contacts["count_contacts"], its.contacts["count_contacts"])
    assert_array_equal(worlds.time, beside.time)
    assert_array_equal(state.velocities.numpy(), Stepper(beside).state().velocities.numpy())


def test_backward_does_not_change_worlds_and_is_the_vjp_of_worlds():
    worlds = differing(panda(), 3)
    stepper = Stepper(worlds, ["torques"], parameters=["masses"])
    state = stepper.state()
    velocities = state.velocities.clone().requires_grad_()
    torques = stepper.control_values().requires_grad_()
    masses = stepper.parameter_values().requires_grad_()
    weights = np.random.default_rng(0).normal(size=(3, 2, len(stepper.velocities)))
    wanted = worlds.step_vjp(weights.reshape(3, -1), ["torques"], parameters=["masses"])
    after = stepper(state.replaced(velocities=velocities), torques, masses)
    tables = [worlds._engine.arrays.state.numpy, worlds._engine.arrays.model.numpy]
    before = [array.tobytes() for table in tables for array in table.values()]
    given = torch.from_numpy(weights)
    ((after.positions * given[:, 0]).sum() + (after.velocities * given[:, 1]).sum()).backward()
    assert [array.tobytes() for table in tables for array in table.values()] == before
    assert_array_equal(gradient(velocities), wanted[0][:, len(stepper.velocities) :])
    assert_array_equal(gradient(torques), wanted[1])
    assert_array_equal(gradient(masses), wanted[2])


@pytest.mark.parametrize(("scene", "chosen"), [(ball_on_plane, "friction"), (cartpole, "masses")])
def test_gradients_of_earlier_steps_do_not_depend_on_later_ones(scene: Callable[[], World], chosen: str):
    stepper = Stepper(differing(scene(), 2), [], parameters=[chosen])
    state, values = stepper.state(), stepper.parameter_values()
    found: list[np.ndarray] = []
    for other in (False, True):
        given = values.clone().requires_grad_()
        after = stepper(state, None, given)
        if other:
            later = stepper(after.detach(), None, 3.0 * values)
            stepper(later, None, 0.1 * values)
        after.velocities.square().sum().backward()
        found.append(gradient(given))
    assert found[0].any()
    assert_array_equal(found[0], found[1])


def test_some_worlds_take_steps_and_one_row_is_for_all():
    worlds = differing(cartpole(), 4)
    whole = Stepper(worlds)
    start = whole.state()
    torques = torch.tensor([3.0, -0.2], dtype=torch.float64, requires_grad=True)
    every = whole(start, torques)
    (alone,) = torch.autograd.grad(every.velocities[[3, 1]].sum(), torques)
    worlds.restore(start.memory)
    some = Stepper(worlds, where=[3, 1])
    before = worlds.snapshot()
    after = some(some.state(), torques)
    assert_array_equal(after.velocities.detach().numpy(), every.velocities.detach().numpy()[[3, 1]])
    after.velocities.sum().backward()
    assert gradient(torques) == pytest.approx(alone.numpy(), rel=1e-12)
    assert_array_equal(worlds.snapshot([0, 2]).state["position"], before.state["position"][[0, 2]])


def test_activations_have_gradients():
    world = cartpole()
    robot = world.bodies[0]
    robot.add_actuator(
        "pull",
        GeneralActuator(robot.joints.movable[0].name, dynamics=ActivationDynamics.FILTER, time_constant=0.1),
    )
    stepper = Stepper(Worlds(world, 2, threads=1), ["actuators"])
    controls = torch.ones((2, 1), dtype=torch.float64, requires_grad=True)
    state = stepper.state()
    assert len(stepper.activations) == 1
    for _ in range(2):
        state = stepper(state, controls)
    state.activations.sum().backward()
    share = world.parameters.time_step / 0.1
    assert gradient(controls) == pytest.approx(1.0 - (1.0 - share) ** 2)


def test_quaternions_of_any_norm_are_made_unit():
    stepper = Stepper(differing(ball_on_plane(), 1), [])
    state = stepper.state()
    longer = state.positions.clone()
    longer[:, 3:] *= 2.0
    after = stepper(state.replaced(positions=longer))
    assert_array_equal(after.positions.numpy(), stepper(state).positions.numpy())
    longer[:, 3:] = 0.0
    with pytest.raises(ValueError, match="a quaternion is 0"):
        stepper(state.replaced(positions=longer))


def test_mistakes_are_named():
    worlds = differing(cartpole(), 2)
    stepper = Stepper(worlds, parameters=["masses"])
    state, torques, masses = stepper.state(), stepper.control_values(), stepper.parameter_values()
    cases: list[tuple[type[Exception], list[Any], str]] = [
        (TypeError, [state, torques.float(), masses], r"controls are torch.float32, .* use .double\(\)"),
        (TypeError, [state, torques.numpy(), masses], "controls must be a tensor, not ndarray"),
        (ValueError, [state, torques.to("meta"), masses], r"controls are on 'meta', .* use .cpu\(\)"),
        (ValueError, [state, torques[:, :1], masses], r"controls must have shape \(2, 2\), not \(2, 1\)"),
        (ValueError, [state, torques], r"parameters must have shape \(2, 2\), and are missing"),
        (ValueError, [state, torques, -masses], r"'physics.cart.mass' must be at least 0, not -"),
        (ValueError, [state, torques * np.nan, masses], "controls must be finite"),
    ]
    for error, arguments, message in cases:
        with pytest.raises(error, match=message):
            stepper(*arguments)
    with pytest.raises(ValueError, match="the state is of 1 worlds; this stepper has 2"):
        stepper(Stepper(worlds, where=[0]).state(), torques, masses)
    with pytest.raises(ValueError, match="where names a world twice"):
        Stepper(worlds, where=[0, 0])
    with pytest.raises(NotImplementedError, match="choose masses and inertias instead"):
        Stepper(worlds, parameters=["inertial_parameters"])
    with pytest.raises(TypeError, match="must be sequences of names"):
        Stepper(worlds, "torques")  # pyright: ignore[reportArgumentType]
    with pytest.warns(SimulationWarning), pytest.raises(SimulationError, match="world 0 has no next step"):
        stepper(state.replaced(velocities=state.velocities + 1e200), torques, masses)
    # It is as before after that.
    assert torch.isfinite(stepper(state, torques, masses).velocities).all()


@pytest.mark.parametrize(("activity", "word"), [(ASLEEP, "asleep"), (ABSENT, "absent")])
def test_bodies_that_do_not_move_are_refused(activity: int, word: str):
    worlds = differing(ball_on_plane(), 2)
    worlds._engine.arrays.state.numpy["tree_activity"][1, worlds.bodies[1]._body.rows.tree] = activity
    with pytest.raises(NotImplementedError, match=f"where bodies are {word}"):
        # Of absent bodies it is known before the first step.
        (stepper := Stepper(worlds, []))(stepper.state())


def test_steps_of_several_substeps_are_refused():
    world = cartpole()
    world.parameters.substeps = 3
    with pytest.raises(NotImplementedError, match="substeps"):
        Stepper(Worlds(world, 1))


def test_second_derivatives_are_refused():
    stepper = Stepper(differing(cartpole(), 1))
    torques = stepper.control_values().requires_grad_()
    total = stepper(stepper.state(), torques).velocities.square().sum()
    (first,) = torch.autograd.grad(total, torques, create_graph=True)
    with pytest.raises(RuntimeError, match="once_differentiable"):
        first.sum().backward()


def test_states_can_be_cut_off():
    stepper = Stepper(differing(cartpole(), 1))
    torques = stepper.control_values().requires_grad_()
    state = stepper(stepper.state(), torques)
    assert isinstance(state, State) and state.velocities.requires_grad
    assert not state.detach().velocities.requires_grad


@pytest.mark.parametrize("module", ["torch", "jax"])
def test_importing_carom_imports_neither(module: str):
    program = f"import sys, carom; sys.exit({module!r} in sys.modules)"
    subprocess.run([sys.executable, "-c", program], check=True)
    assert carom.torch.__name__ == "carom.torch"


def test_what_never_has_derivatives_is_refused_before_the_first_step():
    world = cartpole()
    world.parameters.fluid_density = 1.2
    world.apply_parameters()
    with pytest.raises(NotImplementedError, match="where forces of a fluid act"):
        Stepper(Worlds(world, 2), parameters=["masses"])
