"""Energy and momentum of a body, added up over its links."""

from __future__ import annotations

import numpy as np
from tests.physics.aba_reference import rotation

from carom import Body


def link_motions(body: Body) -> list[tuple[float, np.ndarray, np.ndarray, np.ndarray, np.ndarray]]:
    """Mass, world inertia, centre of mass, its velocity and angular velocity of each link and the base."""
    body.update_link_poses()
    body.update_link_velocities()
    motions = []
    for link in range(-1, body.joint_count):
        dynamics = body.dynamics(link)
        row = body.first_link + 1 + link
        pose, twist = body.world.link_pose[row], body.world.link_velocity[row]
        axes = rotation(pose[3:])
        inertia = axes @ np.diag(dynamics.inertia) @ axes.T
        motions.append((dynamics.mass, inertia, pose[:3].copy(), twist[:3].copy(), twist[3:].copy()))
    return motions


def energy(body: Body) -> float:
    """Kinetic plus potential energy."""
    gravity = body.world.gravity
    total = 0.0
    for mass, inertia, centre, velocity, omega in link_motions(body):
        total += 0.5 * mass * velocity @ velocity + 0.5 * omega @ inertia @ omega - mass * gravity @ centre
    return float(total)


def momentum(body: Body) -> np.ndarray:
    """Linear momentum and angular momentum about the world's origin, shape (6,)."""
    total = np.zeros(6)
    for mass, inertia, centre, velocity, omega in link_motions(body):
        total[:3] += mass * velocity
        total[3:] += inertia @ omega + np.cross(centre, mass * velocity)
    return total


def order_of_convergence(time_steps: list[float], errors: list[float]) -> float:
    """Power of the time step by which an error falls."""
    return float(np.polyfit(np.log(time_steps), np.log(errors), 1)[0])
