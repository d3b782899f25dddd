"""What a scenario is, and the tools its author needs."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

ROBOTS = Path(__file__).resolve().parent / "robots"
ASSETS = Path(__file__).resolve().parents[2] / "src" / "pybullet_data"

Series = dict[str, np.ndarray]


class Kind(Enum):
    """What a scenario measures, which decides how closely the engines must agree."""

    MOTION = "motion"
    INFO = "info"


@dataclass(frozen=True)
class Scenario:
    """A named experiment.

    Attributes:
        name: Function name; the name of its golden file as well.
        run: Takes the `pybullet` module, connected to an empty world, and returns the series.
        kind: What it measures.
        single_precision: Names of series (or endings of names) that PyBullet rounds to float32.
        group: Name of the module it comes from.
        title: First line of its docstring.
        tolerance: Greatest relative error, where the scenario's docstring says why the usual one cannot hold;
            of all series, or by names of series (or endings of names).
    """

    name: str
    run: Callable[[Any], Mapping[str, Any]]
    kind: Kind
    single_precision: tuple[str, ...]
    group: str
    title: str
    tolerance: float | Mapping[str, float] | None = None

    def is_single_precision(self, series: str) -> bool:
        """Whether PyBullet rounds this series to float32 before handing it out."""
        return bool(self.single_precision) and series.endswith(self.single_precision)

    def series(self, pybullet: ModuleType) -> Series:
        """Run in a world of its own and return the series as arrays."""
        client = pybullet.connect(pybullet.DIRECT)
        try:
            return {name: np.asarray(values) for name, values in self.run(pybullet).items()}
        finally:
            pybullet.disconnect(client)


REGISTRY: dict[str, Scenario] = {}

ScenarioFunction = Callable[[Any], Mapping[str, Any]]


def scenario(
    kind: Kind = Kind.MOTION,
    single_precision: tuple[str, ...] = (),
    tolerance: float | Mapping[str, float] | None = None,
) -> Callable[[ScenarioFunction], ScenarioFunction]:
    """Register a function `(pybullet) -> {series name: values}` as a scenario."""

    def register(function: ScenarioFunction) -> ScenarioFunction:
        name = function.__name__
        if name in REGISTRY:
            raise ValueError(f"two scenarios are called {name}")
        title = (function.__doc__ or "").strip().splitlines()
        if not title:
            raise ValueError(f"scenario {name} needs a docstring")
        group = function.__module__.rpartition(".")[2]
        REGISTRY[name] = Scenario(name, function, kind, single_precision, group, title[0], tolerance)
        return function

    return register


class Trace:
    """Series sampled at every `stride`-th call and at the last one."""

    def __init__(self, stride: int = 8) -> None:
        self._stride = stride
        self._count = 0
        self._kept: list[Mapping[str, Any]] = []
        self._pending: Mapping[str, Any] | None = None

    def sample(self, values: Mapping[str, Any]) -> None:
        """Take the values after one more step; a value is a number or nested tuples of numbers."""
        if self._count % self._stride == 0:
            self._kept.append(values)
            self._pending = None
        else:
            self._pending = values
        self._count += 1

    def series(self) -> Series:
        """The samples as one array per name, time along the first axis."""
        samples = self._kept if self._pending is None else [*self._kept, self._pending]
        return {name: np.array([flat(sample[name]) for sample in samples]) for name in samples[0]}


def flat(value: Any) -> Any:
    """Flatten nested tuples of numbers; a plain number stays one."""
    if not isinstance(value, (tuple, list)):
        return value
    numbers: list[float] = []
    for item in value:
        part = flat(item)
        if isinstance(part, list):
            numbers.extend(part)
        else:
            numbers.append(part)
    return numbers


def simulate(
    p: Any,
    seconds: float,
    observe: Callable[[], Mapping[str, Any]],
    act: Callable[[int], None] | None = None,
    time_step: float = 1.0 / 240.0,
    stride: int = 8,
) -> Series:
    """Step for `seconds`, call `act(step)` before and `observe()` after each step."""
    trace = Trace(stride)
    for step in range(round(seconds / time_step)):
        if act is not None:
            act(step)
        p.stepSimulation()
        trace.sample(observe())
    return trace.series()


def under(prefix: str, series: Mapping[str, Any]) -> dict[str, Any]:
    """The same series with `prefix/` before their names: one case of several."""
    return {f"{prefix}/{name}": values for name, values in series.items()}


def load(p: Any, robot: str, **options: Any) -> int:
    """Load one of the suite's own robots."""
    return p.loadURDF(str(ROBOTS / robot), **options)


def load_asset(p: Any, path: str, **options: Any) -> int:
    """Load one of the files Carom ships, by its path inside `pybullet_data`."""
    return p.loadURDF(str(ASSETS / path), **options)


def movable_joints(p: Any, body: int) -> list[int]:
    """Indices of the joints that are not fixed."""
    return [joint for joint in range(p.getNumJoints(body)) if p.getJointInfo(body, joint)[2] != p.JOINT_FIXED]


def release_motors(p: Any, body: int) -> None:
    """Switch off the motor every joint has by default."""
    for joint in movable_joints(p, body):
        if p.getJointInfo(body, joint)[2] in (p.JOINT_REVOLUTE, p.JOINT_PRISMATIC):
            p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)
        else:
            p.setJointMotorControlMultiDof(
                body,
                joint,
                p.POSITION_CONTROL,
                targetPosition=[0.0, 0.0, 0.0, 1.0],
                positionGain=0.0,
                velocityGain=0.0,
                force=[0.0, 0.0, 0.0],
            )


def joint_motion(p: Any, body: int, joints: Sequence[int]) -> dict[str, Any]:
    """Positions, velocities and motor torques of some one-dof joints."""
    states = p.getJointStates(body, joints)
    return {
        "position": [state[0] for state in states],
        "velocity": [state[1] for state in states],
        "motor_torque": [state[3] for state in states],
    }


def base_motion(p: Any, body: int) -> dict[str, Any]:
    """Pose and velocity of a body's base."""
    position, orientation = p.getBasePositionAndOrientation(body)
    linear, angular = p.getBaseVelocity(body)
    return {
        "base_position": position,
        "base_orientation": orientation,
        "base_velocity": linear,
        "base_spin": angular,
    }
