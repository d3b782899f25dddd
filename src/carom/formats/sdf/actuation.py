"""Usual `<plugin>`s of models, as actuators of Carom."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

from carom.description import JointType, Pose
from carom.description.actuator import Actuator, GeneralActuator, Motor, PositionActuator, VelocityActuator
from carom.description.joint import WITHOUT_AXIS
from carom.description.pose import Vector3
from carom.description.transform import conjugate, rotate
from carom.files.xml_element import Element
from carom.formats.robot.context import shown
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.frames import Frames
from carom.formats.sdf.joint import Z
from carom.formats.sdf.parts import Parts
from carom.formats.sdf.scene import Mount, SdfModel
from carom.layouts.codes import ActivationDynamics

Read = Callable[["_Plugin"], None]
# Values of plugins of Gazebo that name topics or how they are served, which Carom has not.
_TOPICS = ("topic", "sub_topic", "robotNamespace", "commandSubTopic", "motorSpeedPubTopic", "actuator_number")


def read_actuators(parts: Parts, frames: Frames, model: SdfModel) -> None:
    """Give a model the actuators that its plugins and those of models in it mean; others are reported.

    Raises:
        DescriptionError: A number in one cannot be read, or a joint or link that it names does not exist.
    """
    _read(parts, frames, "", model)


def _read(parts: Parts, frames: Frames, prefix: str, model: SdfModel) -> None:
    context = frames.tree.context
    sources = [(context, frames.tree.element)]
    sources += [(it.context, it.element) for it in frames.tree.merged.values()]
    if frames.tree.stated[1] is not frames.tree.element:
        sources.append(frames.tree.stated)
    for of, owner in sources:
        for element in owner.children:
            if element.tag == "plugin":
                plugin = _Plugin(of, element, parts, prefix, model)
                read = _KNOWN.get(element.attributes.get("name", "").rpartition("::")[2])
                if read is None:
                    plugin.refuse("plugins are programs of Gazebo")
                else:
                    read(plugin)
    for inner in frames.tree.models:
        _read(parts, frames.inside(inner), f"{prefix}{inner.name}::", model)


class _Plugin:
    """One `<plugin>`, and what is made from it."""

    def __init__(
        self, context: SdfContext, element: Element, parts: Parts, prefix: str, model: SdfModel
    ) -> None:
        self.context = context
        self.element = element
        self.parts = parts
        self.prefix = prefix
        self.model = model
        element.note()
        _take(element, ("name", "filename"))

    def joint(self, tag: str) -> str:
        """The name of the joint that a child names; raises `DescriptionError` if there is none."""
        name = self.context.text(self.element, tag)
        if name is None:
            raise self.context.error(self.element, f"<{tag}> is missing")
        found = self.prefix + name
        if not any(joint.name == found for joint in self.parts.joints):
            place = self.element.first(tag) or self.element
            raise self.context.error(place, f"there is no joint {shown(name)}")
        return found

    def moves(self, joint: str) -> bool:
        """Whether a joint moves; reports that nothing is made if it does not."""
        if any(it.name == joint and it.type is not JointType.FIXED for it in self.parts.joints):
            return True
        self.refuse("its joint does not move")
        return False

    def bounds(self, lower: str, upper: str) -> tuple[float, float]:
        """A range that two children state; none where they say nothing."""
        least = self.context.value(self.element, lower, -inf)
        greatest = self.context.value(self.element, upper, inf)
        return (least, greatest) if least <= greatest else (-inf, inf)

    def refuse(self, reason: str) -> None:
        """Report that nothing is made from it."""
        self.context.leave_out_all(self.element, "the plugin does not run", reason)

    def add(self, owner: str, actuator: Actuator) -> None:
        """Add an actuator that has the name of what it drives."""
        taken = {name for _, name, _ in self.model.actuators}
        name, number = owner, 2
        while name in taken:
            name, number = f"{owner}@{number}", number + 1
        for tag in _TOPICS:
            self.element.first(tag)
        self.model.actuators.append((owner, name, actuator))


def _take(element: Element, names: tuple[str, ...]) -> None:
    for name in names:
        element.attributes.get(name)


def _position(plugin: _Plugin) -> None:
    """`JointPositionController`: a spring and a damper; what integrates the error is left out."""
    context, element = plugin.context, plugin.element
    if context.says(element, "use_velocity_commands"):
        plugin.refuse("it sets velocities; use the motor of the joint")
        return
    joint = plugin.joint("joint_name")
    if not plugin.moves(joint):
        return
    kp, kd = (context.value(element, tag, default) for tag, default in (("p_gain", 1.0), ("d_gain", 0.1)))
    if context.value(element, "i_gain", 0.1) != 0.0:
        context.leave_out(
            element.first("i_gain") or element,
            "the error is not integrated",
            "servos are springs and dampers",
        )
    bounds = plugin.bounds("cmd_min", "cmd_max")
    plugin.add(joint, PositionActuator(joint, kp=kp, kv=kd, force_range=bounds))


def _velocity(plugin: _Plugin) -> None:
    """`JointController`: a velocity servo if it exerts forces."""
    context, element = plugin.context, plugin.element
    if not context.says(element, "use_force_commands"):
        plugin.refuse("it sets velocities; use the motor of the joint")
        return
    joint = plugin.joint("joint_name")
    if not plugin.moves(joint):
        return
    for tag in ("i_gain", "d_gain"):
        if context.value(element, tag, 0.0) != 0.0:
            context.leave_out(element.first(tag) or element, "it has no effect", "servos are dampers")
    bounds = plugin.bounds("cmd_min", "cmd_max")
    gain = context.value(element, "p_gain", 1.0)
    plugin.add(joint, VelocityActuator(joint, kv=gain, force_range=bounds))


def _force(plugin: _Plugin) -> None:
    """`ApplyJointForce`: the control is the force."""
    joint = plugin.joint("joint_name")
    if plugin.moves(joint):
        plugin.add(joint, Motor(joint))


def _rotor(plugin: _Plugin) -> None:
    """`MulticopterMotorModel`: the control is the thrust, along the axis of the joint.

    The plugin gets a speed w, whose thrust is c w². The torque about the axis is in proportion to it.
    """
    context, element, parts = plugin.context, plugin.element, plugin.parts
    if (context.text(element, "motorType") or "velocity") != "velocity":
        plugin.refuse("only motors with the type velocity have a thrust")
        return
    joint = next(it for it in parts.joints if it.name == plugin.joint("jointName"))
    link = plugin.prefix + (context.text(element, "linkName") or "")
    index = next((k for k, it in enumerate(parts.links) if it.name == link), None)
    if index is None:
        raise context.error(element.first("linkName") or element, f"there is no link {shown(link)}")
    constant = context.value(element, "motorConstant", 8.54858e-6)
    fastest = context.value(element, "maxRotVelocity", 838.0)
    moment = context.value(element, "momentConstant", 0.016)
    axis = Z if joint.type in WITHOUT_AXIS else joint.axis
    in_model = rotate(parts.poses[joint.child].orientation, axis)
    turn = rotate(conjugate(parts.poses[index].orientation), in_model)
    sense = -1.0 if (context.text(element, "turningDirection") or "ccw") == "ccw" else 1.0
    x, y, z = turn
    torque: Vector3 = (sense * moment * x, sense * moment * y, sense * moment * z)
    time = context.value(element, "timeConstantUp", 1.0 / 80.0)
    name = f"{link}@thrust"
    plugin.model.mounts.append(Mount(name, link, Pose()))
    limits = (0.0, constant * fastest * fastest)
    context.leave_out(
        element,
        "none: the control is the thrust of the rotor; the air does not brake it",
        "a rotor is a force at its link",
    )
    for tag in (
        "timeConstantDown",
        "rotorDragCoefficient",
        "rollingMomentCoefficient",
        "rotorVelocitySlowdownSim",
        "motorNumber",
    ):
        element.first(tag)
    dynamics = ActivationDynamics.FILTER_EXACT if time > 0.0 else ActivationDynamics.NONE
    plugin.add(
        link,
        GeneralActuator(
            site=name,
            wrench=(x, y, z, *torque),
            control_range=limits,
            dynamics=dynamics,
            time_constant=time if time > 0.0 else 1.0,
        ),
    )


_KNOWN: dict[str, Read] = {
    "JointPositionController": _position,
    "JointController": _velocity,
    "ApplyJointForce": _force,
    "MulticopterMotorModel": _rotor,
}
