"""Masses, friction, damping, limits and sensors of links."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn

from carom.description.pose import Quaternion, Vector3
from carom.layouts.dynamics_parameters import BODY, PARAMETERS
from carom.native.change import Change
from pybullet._calls.arguments import MAX_MAGNITUDE, Vector, integer, real, vector3
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail, logger
from pybullet._clients.clients import client_of
from pybullet._clients.lookup import BASE, body_access, has_joint, link_or_warning, no_joint

__all__ = ["changeDynamics", "enableJointForceTorqueSensor", "getDynamicsInfo"]

DynamicsInfo = tuple[
    float, float, Vector3, Vector3, Quaternion, float, float, float, float, float, int, float
]

_MULTI_BODY, _SOFT_BODY = 2, 3

# Default arguments, compared with `is`, because `==` fails for arrays.
_UNCHANGED, _NO_LIMIT = -1, 1
# Parameters of the whole body, among which PyBullet counts the margin of shapes.
_OF_BODY = {name for name, row in PARAMETERS.items() if row.owner == BODY} | {"collision_margin"}
# Arguments that are numbers, in the order in which PyBullet takes them, after those that come first.
_IN_ORDER = (
    *("mass", "lateralFriction", "spinningFriction", "rollingFriction", "linearDamping", "angularDamping"),
    *("jointDamping", "restitution", "contactStiffness", "contactDamping", "frictionAnchor"),
    *("ccdSweptSphereRadius", "activationState", "contactProcessingThreshold", "maxJointVelocity"),
    "collisionMargin",
)
_CONVERSIONS: dict[str, Callable[[Any, str], float]] = {"r": real, "i": integer}
_BY_ARGUMENT = {row.argument: row for row in PARAMETERS.values()}
# Their parameters and conversions.
_NUMBERS = {name: (_BY_ARGUMENT[name].name, _CONVERSIONS[_BY_ARGUMENT[name].kind]) for name in _IN_ORDER}
# Changes of these parameters make a whole `BodyAccess` outdated, or only its equations of motion.
_LIMITS = {"joint_lower_limit", "joint_upper_limit"}
_INERTIA = {"mass", "inertia"}


@exported
def getDynamicsInfo(bodyUniqueId: int, linkIndex: int, physicsClientId: int = 0) -> DynamicsInfo:
    """Mass, inertia and contact parameters of a link.

    Args:
        bodyUniqueId: The body.
        linkIndex: The link, from 0; -1 for the base.
        physicsClientId: The connection.

    Returns:
        12 fields: 0 mass [kg], 0 for a fixed base; 1 lateral friction; 2 principal moments of inertia
        [kg m²]; 3 position [m] and 4 quaternion (x, y, z, w) of the inertial frame in the link frame;
        5 restitution; 6 rolling and 7 spinning friction; 8 contact damping and 9 contact stiffness,
        -1 when not set; 10 type of the body, 2 for articulated ones,
        3 for soft ones; 11 collision margin [m].

    Raises:
        pybullet.error: Not connected, or there is no such body or link.

    Examples:
        >>> mass, friction = p.getDynamicsInfo(cube, -1)[:2]
        >>> mass, friction
        (0.1, 1.0)
    """
    problem = "getDynamicsInfo failed; invalid return status"
    access = body_access(
        bodyUniqueId, physicsClientId, problem, "getDynamicsInfo failed; invalid bodyUniqueId"
    )
    body, link = access.body, integer(linkIndex, "linkIndex")
    if link < BASE:
        fail("getDynamicsInfo failed; invalid linkIndex", f"{link} is less than -1, the base.")
    if link >= body.joint_count:
        fail(problem, no_joint(body, link))
    dynamics = body.dynamics(link)
    frame = body.link_inertial_frame(link)
    soft = body.spec.soft
    return (
        dynamics.mass if soft is None else float(soft.masses.sum()),
        dynamics.lateral_friction,
        dynamics.inertia,
        frame.position,
        frame.orientation,
        dynamics.restitution,
        dynamics.rolling_friction,
        dynamics.spinning_friction,
        dynamics.contact_damping,
        dynamics.contact_stiffness,
        _MULTI_BODY if soft is None else _SOFT_BODY,
        dynamics.collision_margin if soft is None else soft.margin,
    )


@exported
def changeDynamics(
    bodyUniqueId: int,
    linkIndex: int,
    mass: float = -1,
    lateralFriction: float = -1,
    spinningFriction: float = -1,
    rollingFriction: float = -1,
    restitution: float = -1,
    linearDamping: float = -1,
    angularDamping: float = -1,
    contactStiffness: float = -1,
    contactDamping: float = -1,
    frictionAnchor: int = -1,
    localInertiaDiagonal: Vector | None = None,
    ccdSweptSphereRadius: float = -1,
    contactProcessingThreshold: float = -1,
    activationState: int = -1,
    jointDamping: float = -1,
    anisotropicFriction: Vector | None = None,
    maxJointVelocity: float = -1,
    collisionMargin: float = -1,
    jointLowerLimit: float = 1,
    jointUpperLimit: float = -1,
    jointLimitForce: float = -1,
    sleepThreshold: float = -1,
    physicsClientId: int = 0,
) -> None:
    """Changes parameters of a link, of its joint, or of the whole body. Negative numbers change nothing.

    Carom keeps a trap of PyBullet: damping, activation state, maximum velocity and collision margin belong to
    the body. If one of them is the last of the arguments given, in the order below, all others in the same
    call go to the base as well, with a warning. Use one call for the body and another for the link. A body or
    link that does not exist is no error; what belongs to the body is changed then as well.

    The order: jointLimitForce, joint limits, mass, anisotropicFriction, localInertiaDiagonal,
    lateralFriction, spinningFriction, rollingFriction, linearDamping*, angularDamping*, jointDamping,
    restitution, contactStiffness, frictionAnchor, ccdSweptSphereRadius, activationState*,
    contactProcessingThreshold, maxJointVelocity*, collisionMargin* (* for the base).

    Args:
        bodyUniqueId: The body.
        linkIndex: The link, from 0; -1 for the base.
        mass: [kg]; sets the inertia to that of the collision shapes. 0 fixes the base.
        lateralFriction: Coulomb coefficient.
        spinningFriction: Torque about the contact normal per normal force [m].
        rollingFriction: Torque about the tangents per normal force [m].
        restitution: Coefficient of restitution.
        linearDamping: Of the whole body [1/s]; default 0.04.
        angularDamping: Of the whole body [1/s]; default 0.04.
        contactStiffness: Stiffness of contacts [N/m]; needs `contactDamping` as well.
        contactDamping: Damping of contacts [N s/m]; needs `contactStiffness` as well.
        frictionAnchor: 1: friction pulls a contact point back to where it began to stick.
        localInertiaDiagonal: Principal moments of inertia [kg m²].
        ccdSweptSphereRadius: Of continuous collision detection [m].
        contactProcessingThreshold: Distance beyond which contacts are not solved [m].
        activationState: `ACTIVATION_STATE_*`, added up. A body with `ENABLE_SLEEPING` falls asleep if it and
            all bodies near it hardly move for 2 s, until one of them moves: forces, motors and gravity do not
            act on it, and velocities set for it are lost.
        jointDamping: [N m s/rad or N s/m].
        anisotropicFriction: Factor on friction along the axes of the link.
        maxJointVelocity: Maximum velocity of every coordinate of the body [rad/s, m/s]; default 100.
        collisionMargin: Of the base's shapes [m].
        jointLowerLimit: [rad or m]; limits are changed if it is not greater than the upper one.
        jointUpperLimit: [rad or m].
        jointLimitForce: Maximum force of the limits [N m or N].
        sleepThreshold: Sum of the body's squared velocities below which it may sleep; default 0.05.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, only one of stiffness and damping is given, or an argument is not
            finite or not three numbers.

    Examples:
        >>> p.changeDynamics(cube, -1, mass=0.2, lateralFriction=0.9)
        >>> p.getDynamicsInfo(cube, -1)[:2]
        (0.2, 0.9)
    """
    given = locals()
    client = client_of(physicsClientId)
    named_link = integer(linkIndex, "linkIndex")
    changes = _Changes(named_link)
    # In PyBullet's order, see the docstring.
    if jointLimitForce is not _UNCHANGED:
        changes.take("joint_limit_force", real(jointLimitForce, "jointLimitForce"))
    if sleepThreshold is not _UNCHANGED:
        changes.take("sleep_threshold", real(sleepThreshold, "sleepThreshold"))
    if jointLowerLimit is not _NO_LIMIT or jointUpperLimit is not _UNCHANGED:
        lower = real(jointLowerLimit, "jointLowerLimit")
        changes.take_limits(lower, real(jointUpperLimit, "jointUpperLimit"))
    if anisotropicFriction is not None:
        changes.take_vector("anisotropic_friction", anisotropicFriction, "anisotropicFriction")
    if localInertiaDiagonal is not None:
        changes.take_vector("inertia", localInertiaDiagonal, "localInertiaDiagonal")
    for name, (parameter, convert) in _NUMBERS.items():
        if given[name] is not _UNCHANGED:
            changes.take(parameter, convert(given[name], name))

    if (contactStiffness >= 0.0) != (contactDamping >= 0.0):
        fail("Both contactStiffness and contactDamping needs to be set together.")

    found = link_or_warning(client, bodyUniqueId, changes.link, "changeDynamics")
    if found is None:
        known = client.body(bodyUniqueId)
        changes.keep_those_of_body()
        if known is None or not changes.values:
            return
        found = known, BASE
    body, link = found
    if link != named_link and changes.misdirected:
        logger.warning(
            "changeDynamics: %s go to the base, not to link %d, because the call also changes the whole "
            "body. Make two calls.",
            ", ".join(changes.misdirected),
            named_link,
        )
    with client.call_lock:
        # Before the change, so that an interrupt between the two leaves no outdated data.
        if not _LIMITS.isdisjoint(changes.values):
            client.bodies.forget(body.id)
        elif not _INERTIA.isdisjoint(changes.values):
            client.bodies.forget_inertia(body.id)
        if "mass" in changes.values and "inertia" not in changes.values:
            from carom.scene.dynamics.inertia import shape_inertia

            changes.values["inertia"] = shape_inertia(body, link, changes.values["mass"])
        if "collision_margin" in changes.values:
            from carom.scene.dynamics.inertia import has_margin

            if has_margin(body, link):
                # Bounds and moments depend on it.
                client.bodies.forget(body.id)
            else:
                del changes.values["collision_margin"]
        body.change_dynamics(link, **changes.values)
        # Let the native library handle the next change.
        access = client.bodies[body.id]
        if "mass" in changes.values:
            access.weighed(link)
        client.world.prepare_poses()


@exported
def enableJointForceTorqueSensor(
    bodyUniqueId: int, jointIndex: int, enableSensor: int = 1, physicsClientId: int = 0
) -> None:
    """Switches the force-torque sensor of a joint on or off; `getJointState` returns its values.

    Args:
        bodyUniqueId: The body.
        jointIndex: The joint, from 0.
        enableSensor: 1 to switch it on, 0 to switch it off.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or there is no such body or joint.

    Examples:
        >>> p.enableJointForceTorqueSensor(arm, 6)
        >>> _ = p.stepSimulation()
        >>> len(p.getJointState(arm, 6)[2])
        6
    """
    problem = "Error: invalid jointIndex."
    access = body_access(bodyUniqueId, physicsClientId, problem, "Error: invalid bodyUniqueId")
    index, enabled = integer(jointIndex, "jointIndex"), integer(enableSensor, "enableSensor") != 0
    if not has_joint(access.body, index):
        fail(problem, no_joint(access.body, index))
    client = client_of(physicsClientId)
    with client.call_lock:
        change = Change()
        access.note_sensor(change, index, enabled=enabled)
        change.commit()


def _refuse_size(name: str, value: float) -> NoReturn:
    fail(f"{name} is {value:g}; it may be at most {MAX_MAGNITUDE:g}, so that its products do not overflow.")


class _Changes:
    """The changes that one call of `changeDynamics` makes, and the link that they apply to.

    Attributes:
        link: The link that all changes apply to: the named link or the base, whichever the value taken last
            belongs to.
        values: New values by name.
        misdirected: Names of the values that belong to the named link, even if they go to the base.
    """

    __slots__ = ("_named_link", "link", "misdirected", "values")

    def __init__(self, link: int) -> None:
        self._named_link = link
        self.link = link
        self.values: dict[str, Any] = {}
        self.misdirected: list[str] = []

    def take(self, name: str, value: float) -> None:
        """Take a value that belongs to the named link or the whole body, unless it is negative."""
        if value > MAX_MAGNITUDE and not PARAMETERS[name].unbounded:
            _refuse_size(name, value)
        if value < 0:
            return
        self.values[name] = value
        if name in _OF_BODY:
            self.link = BASE
        else:
            self.link = self._named_link
            self.misdirected.append(name)

    def keep_those_of_body(self) -> None:
        """Drop the values of the named link, which does not exist; PyBullet changes the others."""
        self.values = {name: value for name, value in self.values.items() if name in _OF_BODY}
        self.link = BASE
        self.misdirected.clear()

    def take_limits(self, lower: float, upper: float) -> None:
        """Take the limits of the named link's joint, unless the lower limit is greater than the upper one."""
        if lower <= upper:
            self.values |= {"joint_lower_limit": lower, "joint_upper_limit": upper}
            self.link = self._named_link
            self.misdirected += "joint_lower_limit", "joint_upper_limit"

    def take_vector(self, name: str, value: Vector, argument: str) -> None:
        """Take three numbers that belong to the named link."""
        vector = vector3(value, f"{argument} needs 3 numbers.", argument)
        for number in vector:
            if abs(number) > MAX_MAGNITUDE:
                _refuse_size(name, number)
        self.values[name] = vector
        self.link = self._named_link
        self.misdirected.append(name)
