"""A rod on one joint and, in plain Python, what a step does to it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from tests.physics.robots import pendulum

from carom import Body, World
from carom.layouts.codes import (
    MOTOR_KD,
    MOTOR_KP,
    MOTOR_MAX_IMPULSE,
    MOTOR_POSITION,
    MOTOR_VELOCITY,
    MOTOR_VELOCITY_CLAMP,
)

DT = 1.0 / 240
LINK_DAMPING = float(np.float32(0.04))
MASS, LENGTH = 2.0, 1.0
MOMENT = MASS * LENGTH**2 / 12.0
ARM = LENGTH / 2.0
INERTIA = MOMENT + MASS * ARM**2
WEIGHT_MOMENT = MASS * 9.81 * ARM


@dataclass(frozen=True)
class Motor:
    """A motor's settings; impulse and clamp bound its effect."""

    position: float = 0.0
    velocity: float = 0.0
    kp: float = 0.0
    kd: float = 1.0
    max_impulse: float = 1.0
    clamp: float = math.inf

    def set_on(self, body: Body, joint: int = 0) -> None:
        """Give a joint's motor these settings."""
        row = body.world.motor[body.velocity_index[joint]]
        row[MOTOR_POSITION], row[MOTOR_VELOCITY] = self.position, self.velocity
        row[MOTOR_KP], row[MOTOR_KD] = self.kp, self.kd
        row[MOTOR_MAX_IMPULSE], row[MOTOR_VELOCITY_CLAMP] = self.max_impulse, self.clamp

    def impulse(self, q: float, v: float, time_step: float = DT) -> float:
        """What it gives a joint at `q` whose rate would be `v` without it."""
        wanted = self.kp * (self.position - q) / time_step + v + self.kd * (self.velocity - v)
        wanted = max(-self.clamp, min(self.clamp, wanted))
        return max(-self.max_impulse, min(self.max_impulse, (wanted - v) * INERTIA))


OFF = Motor(max_impulse=0.0)


def free_rate(
    q: float, v: float, torque: float = 0.0, *, damping: float = 0.0, time_step: float = DT
) -> float:
    """Rate after a step without motor and limits: gravity, link damping, joint damping, torque."""
    k, speed = LINK_DAMPING, ARM * abs(v)
    drag = MASS * ARM**2 * v * (k + k * speed) + MOMENT * v * (k + k * abs(v))
    rate = v + time_step * (torque - WEIGHT_MOMENT * math.sin(q) - drag - damping * v) / INERTIA
    return max(-100.0, min(100.0, rate))


def hanging_rod(time_step: float = DT, **joint: Any) -> Body:
    """A world with gravity and the rod of `free_rate` in it."""
    world = World(time_step, contact="bullet")
    world.gravity = (0.0, 0.0, -9.81)
    return world.load(pendulum(**joint))


def place(body: Body, q: float, v: float) -> None:
    """Set the joint's position and rate."""
    body.set_joint_state(0, [q], [v])


def joint_state(body: Body) -> tuple[float, float]:
    """Position and rate of the joint."""
    return float(body.world.position[body.position_index[0]]), float(
        body.world.velocity[body.velocity_index[0]]
    )
