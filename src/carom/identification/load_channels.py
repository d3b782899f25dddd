"""Sensors of force and torque as functions of a motion that are linear in inertial parameters."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.algorithms.regressor import inertial_parameters
from carom.checks import Array
from carom.identification.loads import OF_LOADS, LinkLoads
from carom.identification.motion import Motion
from carom.identification.unknowns import Unknowns
from carom.linearization.inputs import INERTIAL

if TYPE_CHECKING:
    from carom.description.sensor import SensorSpec
    from carom.scene.body import Body


class Channels(NamedTuple):
    """Numbers that were measured in each of m rows, and what they should be.

    Attributes:
        names: Of the numbers.
        measured: (m, n), NaN where unknown.
        constant: What they are with the world's parameters, (m, n).
        design: Derivatives by what is fitted, (m, n, np).
    """

    names: list[str]
    measured: Array
    constant: Array
    design: Array


def sensor_of(body: Body, name: str, readings: Array) -> SensorSpec:
    """The sensor of a body with a name and so many numbers.

    Raises:
        ValueError: There is none.
    """
    found = [it for it in body.spec.sensors if it.name == name]
    if len(found) != 1:
        known = ", ".join(it.name for it in body.spec.sensors) or "none"
        raise ValueError(f"{body.name!r} has no sensor {name!r}; its sensors are {known}")
    if readings.shape[1] != found[0].dim:
        raise ValueError(f"sensor {name!r} has {found[0].dim} numbers, the log {readings.shape[1]}")
    return found[0]


def sensor_names(sensor: SensorSpec) -> list[str]:
    """Names of the numbers of a sensor."""
    return [sensor.name] if sensor.dim == 1 else [f"{sensor.name}.{number}" for number in range(sensor.dim)]


def sensor_channels(body: Body, unknowns: Unknowns, motion: Motion) -> list[Channels]:
    """The channels of the sensors in a log.

    Raises:
        ValueError: There is no such sensor, it shows no forces, or it is not at a site of a link.
    """
    if not motion.sensors:
        return []
    sensors = [sensor_of(body, name, readings) for name, readings in motion.sensors.items()]
    for sensor in sensors:
        if sensor.kind not in OF_LOADS:
            raise ValueError(
                f"sensor {sensor.name!r} shows motion, which is measured here, and no forces: leave it out, "
                'or use residuals="prediction"'
            )
    loads, values = LinkLoads(body, motion.states), inertial_parameters(body).ravel()
    found: list[Channels] = []
    for sensor, measured in zip(sensors, motion.sensors.values(), strict=True):
        applied, regressors = loads.shown(sensor, motion.forces)
        design = np.zeros((len(measured), sensor.dim, len(unknowns.names)))
        for place, it in enumerate(unknowns.inputs):
            if it is not None and it.kind == INERTIAL:
                design[:, :, place] = regressors[:, :, 10 * (it.row - body.first_link) + it.place[1]]
        found.append(Channels(sensor_names(sensor), measured, applied + regressors @ values, design))
    return found
