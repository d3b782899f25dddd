"""Actuators of joints, as descriptions: what drives a joint, by which law, within which bounds."""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi

from carom.description.pose import Vector3
from carom.errors import DescriptionError
from carom.layouts.codes import ActivationDynamics

Range = tuple[float, float]
UNBOUNDED: Range = (-inf, inf)


Wrench = tuple[float, float, float, float, float, float]
NO_WRENCH: Wrench = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True)
class MuscleSpec:
    """The force of a muscle, by its length and velocity.

    Attributes:
        force: Greatest active force [N].
        fibre: Length of the fibre at rest: the unit of normalised lengths [m].
        tendon: Length of what does not stretch [m].
        shortest: Normalised length from which on it acts.
        longest: Normalised length up to which it acts.
        speed: Greatest speed of shortening, in lengths at rest per second.
        passive: Passive force at the longest length, per greatest active force.
        lengthening: Active force when lengthened fast, per greatest active force.
        fall_time: Time constant of the activation where it falls [s]; `time_constant` is that of rising.
        smoothing: Width of the range of controls over which one becomes the other; 0 for none.
    """

    force: float
    fibre: float
    tendon: float
    shortest: float = 0.5
    longest: float = 1.6
    speed: float = 1.5
    passive: float = 1.3
    lengthening: float = 1.2
    fall_time: float = 0.04
    smoothing: float = 0.0


@dataclass(frozen=True, slots=True)
class ActuatorSpec:
    """An actuator of a joint with one degree of freedom, of a tendon or a site, as the engine simulates it.

    Its length is `gear` times the position of the joint, and its velocity `gear` times its rate. Its force is
    (gain · (1, length, velocity)) · input + bias · (1, length, velocity), within `force_range`; the joint
    feels `gear` times that. The input is the control, or the activation if there are dynamics. For a tendon,
    its length takes the place of the position. At a site it exerts `gear` times `wrench`. A link is pulled
    towards all that touches it: contacts within their margins share the force alike, along their normals; its
    length is 0.

    Attributes:
        name: Its name among the actuators of the body.
        joint: Name of the joint; empty if it acts on something else.
        gain: Force per input; its change per length and per velocity.
        bias: Force without input; its change per length and per velocity.
        gear: Length per position of the joint; not 0.
        control_range: Bounds of the control.
        force_range: Bounds of the force [N or N m].
        dynamics: How the activation follows the control.
        time_constant: Of a filter [s].
        activation_range: Bounds of the activation.
        tendon: Name of the tendon that it pulls.
        site: Name of the site at which it exerts a wrench.
        reference_site: Name of a site in whose axes the wrench is given; its length is then the pose of the
            other relative to this one. Empty for the axes of the site; then its length is 0.
        wrench: Force along the axes, then torque about them, per force of the actuator.
        slider_site: Name of a site along whose z axis a slider moves, which a rod connects to `site`: the
            actuator then pushes the slider, and its length is `gear` times the position of the slider.
        rod: Length of that rod [m].
        joint_range: Bounds of what all actuators of its joint together exert on the joint [N or N m], the
            same for each of them; `force_range` bounds its own force before. Of a tendon: of the sum of their
            forces, which are then all scaled alike; `force_range` bounds each of them afterwards.
        muscle: How its force depends on length and velocity if it is a muscle; then gain and bias have no
            meaning.
        acts_early: Whether the force follows the activation that is there after a substep, and not the one
            before; without dynamics it has no meaning.
        link: Name of the link that it pulls towards all that touches it.
    """

    name: str
    joint: str
    gain: Vector3 = (1.0, 0.0, 0.0)
    bias: Vector3 = (0.0, 0.0, 0.0)
    gear: float = 1.0
    control_range: Range = UNBOUNDED
    force_range: Range = UNBOUNDED
    dynamics: ActivationDynamics = ActivationDynamics.NONE
    time_constant: float = 1.0
    activation_range: Range = UNBOUNDED
    tendon: str = ""
    site: str = ""
    reference_site: str = ""
    wrench: Wrench = NO_WRENCH
    muscle: MuscleSpec | None = None
    slider_site: str = ""
    rod: float = 0.0
    joint_range: Range = UNBOUNDED
    acts_early: bool = False
    link: str = ""

    def check(self) -> None:
        """Raise `DescriptionError` unless the numbers have a meaning."""
        for name in ("control_range", "force_range", "activation_range", "joint_range"):
            lower, upper = getattr(self, name)
            if not lower <= upper:
                raise DescriptionError(f"actuator {self.name!r}: {name} {lower:g} to {upper:g} is empty")
        numbers = (self.gear, self.time_constant, *self.gain, *self.bias, *self.wrench)
        if not all(-inf < number < inf for number in numbers):
            raise DescriptionError(f"actuator {self.name!r}: gear, gain, bias and time must be finite")
        if self.gear == 0.0:
            raise DescriptionError(f"actuator {self.name!r}: its gear is 0, so it moves nothing")
        if self.link and (self.gear != 1.0 or self.muscle is not None):
            raise DescriptionError(f"actuator {self.name!r} pulls a link: it has no gear, and is no muscle")
        if self.slider_site and not 0.0 < self.rod < inf:
            raise DescriptionError(f"actuator {self.name!r}: its rod must be longer than 0")
        if not self.time_constant > 0.0:
            raise DescriptionError(f"actuator {self.name!r}: its time constant must be greater than 0")


@dataclass(frozen=True, slots=True)
class GeneralActuator:
    """An actuator of a joint, a tendon, a site or a link; attributes as of `ActuatorSpec`."""

    joint: str = ""
    gain: Vector3 = (1.0, 0.0, 0.0)
    bias: Vector3 = (0.0, 0.0, 0.0)
    gear: float = 1.0
    control_range: Range = UNBOUNDED
    force_range: Range = UNBOUNDED
    dynamics: ActivationDynamics = ActivationDynamics.NONE
    time_constant: float = 1.0
    activation_range: Range = UNBOUNDED
    tendon: str = ""
    site: str = ""
    reference_site: str = ""
    wrench: Wrench = NO_WRENCH
    muscle: MuscleSpec | None = None
    slider_site: str = ""
    rod: float = 0.0
    acts_early: bool = False
    link: str = ""

    def spec(self, name: str) -> ActuatorSpec:
        """The same with a name."""
        return ActuatorSpec(
            name,
            self.joint,
            self.gain,
            self.bias,
            self.gear,
            self.control_range,
            self.force_range,
            self.dynamics,
            self.time_constant,
            self.activation_range,
            self.tendon,
            self.site,
            self.reference_site,
            self.wrench,
            self.muscle,
            self.slider_site,
            self.rod,
            acts_early=self.acts_early,
            link=self.link,
        )


@dataclass(frozen=True, slots=True)
class Motor:
    """Its force is the control."""

    joint: str
    gear: float = 1.0
    control_range: Range = UNBOUNDED
    force_range: Range = UNBOUNDED

    def spec(self, name: str) -> ActuatorSpec:
        """The actuator with a name."""
        return ActuatorSpec(
            name, self.joint, gear=self.gear, control_range=self.control_range, force_range=self.force_range
        )


@dataclass(frozen=True, slots=True)
class PositionActuator:
    """A position servo: force = kp (control - length) - kv velocity, implicit in velocity.

    Attributes:
        joint: Name of the joint.
        kp: Stiffness [N m/rad or N/m].
        kv: Damping [N m s/rad or N s/m].
        gear: Length per position of the joint.
        control_range: Bounds of the control, a length.
        force_range: Bounds of the force.
        time_constant: Of the exact first-order filter of the control [s]; 0 for none.
    """

    joint: str
    kp: float = 1.0
    kv: float = 0.0
    gear: float = 1.0
    control_range: Range = UNBOUNDED
    force_range: Range = UNBOUNDED
    time_constant: float = 0.0

    def spec(self, name: str) -> ActuatorSpec:
        """The actuator with a name."""
        filtered = self.time_constant != 0.0
        return ActuatorSpec(
            name,
            self.joint,
            (self.kp, 0.0, 0.0),
            (0.0, -self.kp, -self.kv),
            self.gear,
            self.control_range,
            self.force_range,
            ActivationDynamics.FILTER_EXACT if filtered else ActivationDynamics.NONE,
            self.time_constant if filtered else 1.0,
        )


@dataclass(frozen=True, slots=True)
class VelocityActuator:
    """A velocity servo: force = kv (control - velocity), implicit in velocity."""

    joint: str
    kv: float = 1.0
    gear: float = 1.0
    control_range: Range = UNBOUNDED
    force_range: Range = UNBOUNDED

    def spec(self, name: str) -> ActuatorSpec:
        """The actuator with a name."""
        gain, bias = (self.kv, 0.0, 0.0), (0.0, 0.0, -self.kv)
        return ActuatorSpec(name, self.joint, gain, bias, self.gear, self.control_range, self.force_range)


@dataclass(frozen=True, slots=True)
class IntegratedVelocityActuator:
    """A position servo whose target is the integral of the control, within `activation_range`."""

    joint: str
    kp: float = 1.0
    kv: float = 0.0
    gear: float = 1.0
    control_range: Range = UNBOUNDED
    force_range: Range = UNBOUNDED
    activation_range: Range = UNBOUNDED

    def spec(self, name: str) -> ActuatorSpec:
        """The actuator with a name."""
        return ActuatorSpec(
            name,
            self.joint,
            (self.kp, 0.0, 0.0),
            (0.0, -self.kp, -self.kv),
            self.gear,
            self.control_range,
            self.force_range,
            ActivationDynamics.INTEGRATOR,
            activation_range=self.activation_range,
        )


@dataclass(frozen=True, slots=True)
class Damper:
    """A damper that the control sets: force = -kv control velocity; the control is not negative."""

    joint: str
    kv: float = 1.0
    gear: float = 1.0
    control_range: Range = (0.0, inf)
    force_range: Range = UNBOUNDED

    def spec(self, name: str) -> ActuatorSpec:
        """The actuator with a name; raises `DescriptionError` if controls may be negative."""
        if self.control_range[0] < 0.0:
            raise DescriptionError(f"actuator {name!r}: the control of a damper must not be negative")
        return ActuatorSpec(
            name,
            self.joint,
            (0.0, 0.0, -self.kv),
            gear=self.gear,
            control_range=self.control_range,
            force_range=self.force_range,
        )


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A pneumatic or hydraulic cylinder: the control is filtered to a pressure that acts on an area.

    Attributes:
        joint: Name of the joint.
        time_constant: Of the pressure [s].
        area: [m²]; not used if there is a diameter.
        diameter: [m]; 0 for none.
        bias: See `ActuatorSpec`.
        gear: Length per position of the joint.
        control_range: Bounds of the control.
        force_range: Bounds of the force.
    """

    joint: str
    time_constant: float = 1.0
    area: float = 1.0
    diameter: float = 0.0
    bias: Vector3 = (0.0, 0.0, 0.0)
    gear: float = 1.0
    control_range: Range = UNBOUNDED
    force_range: Range = UNBOUNDED

    def spec(self, name: str) -> ActuatorSpec:
        """The actuator with a name."""
        area = 0.25 * pi * self.diameter**2 if self.diameter else self.area
        return ActuatorSpec(
            name,
            self.joint,
            (area, 0.0, 0.0),
            self.bias,
            self.gear,
            self.control_range,
            self.force_range,
            ActivationDynamics.FILTER,
            self.time_constant,
        )


@dataclass(frozen=True, slots=True)
class Adhesion:
    """Pulls a link towards all that touches it, by the control times a gain, as `<adhesion>` of MJCF files.

    All contacts of the link within their margins share the force alike, along their normals.

    Attributes:
        link: Name of the link.
        gain: Force per control [N].
        control_range: Bounds of the control, which are not negative.
        force_range: Bounds of the force [N].
    """

    link: str
    gain: float = 1.0
    control_range: Range = (0.0, 1.0)
    force_range: Range = UNBOUNDED

    def spec(self, name: str) -> ActuatorSpec:
        """The actuator with a name; raises `DescriptionError` if controls may be negative."""
        if self.control_range[0] < 0.0:
            raise DescriptionError(f"actuator {name!r}: the control of adhesion must not be negative")
        return ActuatorSpec(
            name,
            "",
            (self.gain, 0.0, 0.0),
            control_range=self.control_range,
            force_range=self.force_range,
            link=self.link,
        )


Actuator = (
    GeneralActuator
    | Motor
    | PositionActuator
    | VelocityActuator
    | IntegratedVelocityActuator
    | Damper
    | Cylinder
    | Adhesion
)
