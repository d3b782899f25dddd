"""The law of an actuator: how its gain, bias and dynamics follow from shortcuts and defaults.

`<motor>`, `<position>` and so on are shortcuts for a `<general>` actuator. A class has one law, that of the
last of its elements: it is the default for actuators of that kind and for general ones. For other kinds there
is none, unless a general one came last, whose numbers are for all kinds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from math import pi

from carom.formats.mjcf.compiled.actuation.dc_motor import DcMotor
from carom.formats.mjcf.defaults import Attributes

Numbers = Callable[[str, str, int], list[float]]
"""Of an attribute's name and text, and the most numbers it may have: its numbers."""

FIXED, AFFINE, NONE = "fixed", "affine", "none"
FILTER, FILTER_EXACT, INTEGRATOR = "filter", "filterexact", "integrator"
MUSCLE, DC_MOTOR = "muscle", "dcmotor"
PLUGIN = "plugin"
ADHESION = "adhesion"
PID = "pid"
INPUTS = ("pos", "vel", "ff")
"""Of a `pid`, in the order of its controls: targets of length and velocity, and a force."""
SHORTCUTS = (
    "general", "motor", "position", "velocity", "intvelocity", "damper", "cylinder", "muscle", "dcmotor",
    ADHESION, PID,
)  # fmt: skip
_UNBUILT = ("orientation",)
KINDS = (*SHORTCUTS, *_UNBUILT, PLUGIN)


_NUMBERS = 10
_TIMES = (0.01, 0.04, 0.0)
"""Of a muscle: time constants of rising and falling, and the width of the range between them."""
_OF_MUSCLES = (0.75, 1.05, -1.0, 200.0, 0.5, 1.6, 1.5, 1.3, 1.2)
_NAMES = ("force", "scale", "lmin", "lmax", "vmax", "fpmax", "fvmax")
"""Attributes for the parameters of a muscle after its range."""


def padded(*numbers: float) -> list[float]:
    """Parameters of a law of which these are the first, and the others 0."""
    return [*numbers, *(0.0,) * (_NUMBERS - len(numbers))]


def _one() -> list[float]:
    return padded(1.0)


def _zero() -> list[float]:
    return padded()


@dataclass(frozen=True)
class Pid:
    """What a `pid` has besides the law of a servo.

    Attributes:
        inputs: Those of `INPUTS` that it has.
        integral: Force per integral of the error; 0 for none.
        slew: Greatest rate of the target; 0 for any.
    """

    inputs: tuple[str, ...] = ("pos", "vel")
    integral: float = 0.0
    slew: float = 0.0

    @property
    def memories(self) -> int:
        """How many activations it has in MuJoCo."""
        return (self.integral != 0.0) + (self.slew > 0.0)


@dataclass
class Law:
    """Gain, bias and dynamics, as MuJoCo names their types.

    Attributes:
        gain_type: `fixed`, `affine` or `muscle`; another one, or the name of an element, is not built.
        bias_type: `none`, `affine` or `muscle`.
        dynamics: `none`, `integrator`, `filter`, `filterexact` or `muscle`.
        gain: Parameters of the gain.
        bias: Parameters of the bias. A positive third one of a servo is a damping ratio.
        times: Parameters of the dynamics.
        inherited: Factor on the range of the joint that bounds the target; 0 for none.
        shortcut: The shortcut that it is of; empty for a general one.
        bounded: Names of the ranges that count wherever they are stated; that of controls has to be.
        motor: Of a `dcmotor`, what the law follows from.
        pid: Of a `pid`, what it has besides; gain and bias are those of its servo.
    """

    gain_type: str = FIXED
    bias_type: str = NONE
    dynamics: str = NONE
    gain: list[float] = field(default_factory=_one)
    bias: list[float] = field(default_factory=_zero)
    times: list[float] = field(default_factory=_one)
    inherited: float = 0.0
    shortcut: str = ""
    bounded: tuple[str, ...] = ()
    motor: DcMotor | None = None
    pid: Pid = field(default_factory=Pid)

    def copy(self) -> Law:
        """One that changes on its own."""
        return replace(self, gain=[*self.gain], bias=[*self.bias], times=[*self.times])

    def without_length(self) -> Law:
        """The same where the length is always 0."""
        law = self.copy()
        law.gain[1] = law.bias[1] = 0.0
        return law

    def apply(self, tag: str, attributes: Attributes, numbers: Numbers) -> None:
        """Change it by the attributes of an element, or by those of its defaults."""

        def number(name: str, default: float) -> float:
            text = attributes.get(name)
            return default if text is None else numbers(name, text, 1)[0]

        def several(name: str, default: list[float], most: int) -> list[float]:
            text = attributes.get(name)
            return default if text is None else [*numbers(name, text, most), *default][:3]

        earlier, self.shortcut = self.shortcut, "" if tag == "general" else tag
        if tag == "position" and not earlier:
            # Those of a general default don't reach it.
            self.dynamics, self.times = NONE, _one()
        match tag:
            case "general":
                if self.motor is not None and {"gainprm", "biasprm", "dynprm"} & {*attributes}:
                    # These would be numbers of the motor.
                    self.motor = replace(self.motor, missing=("other parameters",))
                self.gain_type = attributes.get("gaintype", self.gain_type)
                self.bias_type = attributes.get("biastype", self.bias_type)
                self.dynamics = attributes.get("dyntype", self.dynamics)
                self._overlay(self.gain, "gainprm", attributes, numbers)
                self._overlay(self.bias, "biasprm", attributes, numbers)
                self._overlay(self.times, "dynprm", attributes, numbers)
            case "motor":
                self._set(FIXED, NONE, NONE, _one(), _zero())
            case "position" | "intvelocity":
                self._servo(tag, attributes, number)
            case "velocity":
                kv = number("kv", self.gain[0])
                self._set(FIXED, AFFINE, NONE, padded(kv), padded(0.0, 0.0, -kv))
            case "damper":
                kv = number("kv", 0.0)
                self._set(AFFINE, NONE, NONE, padded(0.0, 0.0, -kv), _zero())
                self.bounded = ("ctrl",)
            case "cylinder":
                self.times[0] = number("timeconst", self.times[0])
                area, diameter = number("area", self.gain[0]), number("diameter", -1.0)
                if diameter >= 0.0:
                    area = 0.25 * pi * diameter * diameter
                bias = several("bias", self.bias, 3)
                self._set(FIXED, AFFINE, FILTER, padded(area), padded(*bias))
            case "dcmotor":
                motor = (self.motor or DcMotor()).with_attributes(attributes, numbers)
                share = motor.constant / motor.resistance if motor.resistance > 0.0 else 0.0
                self._set(FIXED, AFFINE, NONE, padded(share), padded(0.0, 0.0, -share * motor.constant))
                self.motor = motor
            case "muscle":
                if earlier != MUSCLE:
                    self.gain, self.times = padded(*_OF_MUSCLES), padded(*_TIMES)
                self._overlay(self.times, "timeconst", attributes, numbers, 2)
                self.times[2] = number("tausmooth", self.times[2])
                self._overlay(self.gain, "range", attributes, numbers, 2)
                for place, name in enumerate(_NAMES, 2):
                    self.gain[place] = number(name, self.gain[place])
                self._set(MUSCLE, MUSCLE, MUSCLE, self.gain, [*self.gain])
            case _ if tag == PID:
                kp = number("kp", -self.bias[1] if earlier == PID else 1.0)
                last = self.bias[2] if earlier == PID else 0.0
                if "kv" in attributes:
                    last = -number("kv", 0.0)
                if "dampratio" in attributes:
                    last = number("dampratio", 0.0)
                # A bound of the integral alone does nothing.
                number("imax", 0.0)
                self.pid = Pid(
                    tuple(attributes.get("input", " ".join(self.pid.inputs)).split()),
                    number("ki", self.pid.integral),
                    number("slewmax", self.pid.slew),
                )
                self._set(FIXED, AFFINE, NONE, padded(kp), padded(0.0, -kp, last))
                self.inherited = number("inheritrange", self.inherited)
            case _ if tag == ADHESION:
                self._set(FIXED, NONE, self.dynamics, padded(number("gain", self.gain[0])), _zero())
                self.bounded = ("ctrl",)
            case _:
                self.gain_type = tag

    def _servo(self, tag: str, attributes: Attributes, number: Callable[[str, float], float]) -> None:
        kp = number("kp", self.gain[0])
        last = self.bias[2]
        if "kv" in attributes:
            last = -number("kv", 0.0)
        if "dampratio" in attributes:
            last = number("dampratio", 0.0)
        dynamics = INTEGRATOR if tag == "intvelocity" else self.dynamics
        if tag == "position" and "timeconst" in attributes:
            self.times[0] = number("timeconst", 0.0)
            dynamics = NONE if self.times[0] == 0.0 else FILTER_EXACT
        self._set(FIXED, AFFINE, dynamics, padded(kp), padded(0.0, -kp, last))
        self.inherited = number("inheritrange", self.inherited)
        if tag == "intvelocity":
            self.bounded = ("act",)

    def _set(
        self, gain_type: str, bias_type: str, dynamics: str, gain: list[float], bias: list[float]
    ) -> None:
        self.gain_type, self.bias_type, self.dynamics = gain_type, bias_type, dynamics
        self.motor = None
        self.gain, self.bias = gain, bias

    @staticmethod
    def _overlay(
        values: list[float], name: str, attributes: Attributes, numbers: Numbers, most: int = _NUMBERS
    ) -> None:
        text = attributes.get(name)
        if text is not None:
            found = numbers(name, text, most)
            values[: len(found)] = found

    def unbuilt(self) -> str:
        """What of it is not built; empty if nothing is."""
        if self.motor is not None and self.motor.missing:
            return f"{DC_MOTOR} ({', '.join(self.motor.missing)})"
        for kind, built in (
            (self.gain_type, (FIXED, AFFINE, MUSCLE)),
            (self.bias_type, (NONE, MUSCLE) if self.is_muscle else (NONE, AFFINE)),
            (self.dynamics, (NONE, INTEGRATOR, FILTER, FILTER_EXACT, *(MUSCLE,) * self.is_muscle)),
        ):
            if kind not in built:
                return kind
        return ""

    @property
    def is_muscle(self) -> bool:
        """Its force depends on length and velocity as that of a muscle, by the parameters of the gain."""
        return self.gain_type == MUSCLE

    @property
    def gains(self) -> tuple[float, float, float]:
        """Gain, and its change per length and per velocity."""
        first, second, third = self.gain[:3]
        return (first, second, third) if self.gain_type == AFFINE else (first, 0.0, 0.0)

    @property
    def biases(self) -> tuple[float, float, float]:
        """Bias, and its change per length and per velocity, without that of a damping ratio."""
        first, second, third = self.bias[:3]
        if self.damping_ratio:
            third = 0.0
        return (first, second, third) if self.bias_type == AFFINE else (0.0, 0.0, 0.0)

    @property
    def damping_ratio(self) -> float:
        """Of a servo whose damping is to be found from the inertia that it moves; 0 for none."""
        is_servo = self.bias_type == AFFINE and self.gain[0] == -self.bias[1]
        return max(self.bias[2], 0.0) if is_servo else 0.0


class Laws:
    """The law that the defaults of a class have left: one for elements of all kinds."""

    def __init__(self) -> None:
        self._last = Law()

    def apply(self, tag: str, attributes: Attributes, numbers: Numbers) -> Law:
        """The law of an element, which is a default for those that follow."""
        # A shortcut of another kind than the last one begins anew.
        is_other = self._last.shortcut not in ("", tag) and tag != "general"
        law = Law() if is_other else self._last.copy()
        law.apply(tag, attributes, numbers)
        self._last = law
        return law
