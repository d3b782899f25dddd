"""A network learns to push a ball to a target, by gradients that go through the contact.

For a target it chooses the force on a plate at each of 30 steps, and never sees the ball. The six worlds have
different targets. Adam follows the gradient of the distance that is left at the end.
"""

import time

import torch

from carom import World, Worlds
from carom.examples import robot_file
from carom.examples.window import wants_window
from carom.torch import Stepper
from carom.viewer import Viewer

ROBOT = robot_file("pusher.urdf")
FORCE = "pusher.slide.torque"
TIME_STEP, STEPS, WORLDS = 1 / 50, 30, 6
NEAREST, FURTHEST = 0.6, 1.6
EFFORT = 1e-5


def make_world():
    world = World(TIME_STEP)
    world.gravity = (0, 0, -9.81)
    world.add_plane()
    ball = world.add_sphere(0.1, (0.2, 0, 0.1), mass=0.5, colour=(0.95, 0.5, 0.1, 1), name="ball")
    pusher = world.load_urdf(ROBOT, (0, 0, 0.1), fixed_base=True)
    pusher.joints.free()
    return world, ball, pusher.joints["slide"]


def make_policy():
    """From targets (n, 1) to forces (n, steps) [N]; at first about 1 N, to touch the ball."""
    torch.manual_seed(0)
    network = torch.nn.Sequential(
        torch.nn.Linear(1, 32), torch.nn.Tanh(), torch.nn.Linear(32, STEPS)
    ).double()
    return network, lambda targets: 1.0 + 5.0 * network(targets - 1.0)


def rolled_out(stepper, start, forces):
    """Positions of the balls along x after each step, (steps, n) [m]."""
    ball = stepper.coordinates.index("ball.base.x")
    state, path = start, []
    for step in range(STEPS):
        state = stepper(state, forces[:, step : step + 1])
        path.append(state.positions[:, ball])
    return torch.stack(path)


def show(world, ball, joint, policy):
    """Play what was learned in a window, for one target after the other."""
    viewer = Viewer(world, title="Pushing")
    print(f"The simulation is shown at {viewer.address}")
    viewer.open_browser()
    start = world.snapshot()
    while viewer.is_open:
        for target in torch.linspace(NEAREST, FURTHEST, 5, dtype=torch.float64):
            world.restore(start)
            viewer.plot("target [m]", float(target))
            for force in policy(target.reshape(1, 1))[0].tolist():
                joint.set_torque(force)
                world.step()
                viewer.plot("ball [m]", float(ball.links.base.pose.position[0]))
                time.sleep(TIME_STEP)
    viewer.close()


def main(iterations=40, window=False):
    record = {"loss": [], "targets": [], "before": [], "after": []}
    world, ball, joint = make_world()
    stepper = Stepper(Worlds(world, WORLDS), [FORCE])
    start = stepper.state()
    network, policy = make_policy()
    optimizer = torch.optim.Adam(network.parameters(), lr=0.02)
    schedule = torch.optim.lr_scheduler.CosineAnnealingLR(optimizer, iterations)
    targets = torch.linspace(NEAREST, FURTHEST, WORLDS, dtype=torch.float64)
    for iteration in range(iterations):
        forces = policy(targets[:, None])
        path = rolled_out(stepper, start, forces)
        loss = (path[-1] - targets).square().mean() + EFFORT * forces.square().mean()
        optimizer.zero_grad()
        loss.backward()
        optimizer.step()
        schedule.step()
        record["loss"].append(loss.item())
        if iteration == 0:
            record["before"] = path.T.tolist()
        if iteration % 10 == 0:
            print(f"iteration {iteration}: the loss is {loss.item():.4f} m²")
    with torch.no_grad():
        path = rolled_out(stepper, start, policy(targets[:, None]))
    record["after"], record["targets"] = path.T.tolist(), targets.tolist()
    error = (path[-1] - targets).abs()
    print(f"the balls end {error.mean():.3f} m from their targets, {error.max():.3f} m at most")
    if window:
        show(world, ball, joint, policy)
    return record


if __name__ == "__main__":
    main(window=wants_window())
