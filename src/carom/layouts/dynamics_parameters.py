"""Parameters of links, joints and bodies that can be changed during a simulation: one row for each.

All that reads or changes them takes names, fields and bounds from here: `changeDynamics` in Python and in
C++, `Body.change_dynamics`, `BodyBatch.change_dynamics`, shapes, and copies of worlds.
"""

from typing import Any, NamedTuple

# What has a parameter: all shapes of a link, the link; each velocity or position coordinate of its joint, the
# limit or the friction of the joint; the whole body.
SHAPE, LINK, VELOCITY, POSITION = "shape", "link", "velocity", "position"
LIMIT, FRICTION, BODY = "limit", "friction", "body"


class Parameter(NamedTuple):
    """A parameter.

    Attributes:
        name: Its name in `LinkDynamics`, and as an argument of `change_dynamics`.
        owner: What has it, one of the words above: which rows of the field.
        field: The field of `Shapes`, or else of `Model`, that keeps a number for each; empty if it is kept
            elsewhere, or if the field depends on the body.
        argument: The argument of `changeDynamics`; empty if it has none.
        kind: A real number, an integer or 3 numbers, by the letters of `quick.calls`.
        varies: It may differ between worlds.
        of_one: A shape of a link may have another than the link.
        is_quick: The native library changes it without Python.
        not_negative: It must not be negative in the modern interface; `changeDynamics` skips such numbers.
        unbounded: It may be infinite, and then bounds nothing.
    """

    name: str
    owner: str
    field: str = ""
    argument: str = ""
    kind: str = "r"
    varies: bool = False
    of_one: bool = False
    is_quick: bool = False
    not_negative: bool = False
    unbounded: bool = False


_VARIES: dict[str, Any] = {"varies": True}
_SURFACE: dict[str, Any] = {"of_one": True, "varies": True, "is_quick": True}
_BOUNDS: dict[str, Any] = {"unbounded": True}
_OF_BODY: dict[str, Any] = {"varies": True, "is_quick": True, "not_negative": True}
_OF_FILES: dict[str, Any] = {"of_one": True}
# In the order of the arguments of `changeDynamics`; behind them those that it lacks.
_ROWS = (
    Parameter("mass", LINK, "link_mass", "mass", not_negative=True, **_VARIES),
    Parameter("lateral_friction", SHAPE, "shape_lateral_friction", "lateralFriction", **_SURFACE),
    Parameter("spinning_friction", SHAPE, "shape_spinning_friction", "spinningFriction", **_SURFACE),
    Parameter("rolling_friction", SHAPE, "shape_rolling_friction", "rollingFriction", **_SURFACE),
    Parameter("restitution", SHAPE, "shape_restitution", "restitution", not_negative=True, **_SURFACE),
    Parameter("linear_damping", BODY, "tree_linear_damping", "linearDamping", **_OF_BODY),
    Parameter("angular_damping", BODY, "tree_angular_damping", "angularDamping", **_OF_BODY),
    Parameter("contact_stiffness", SHAPE, "shape_stiffness", "contactStiffness", **_SURFACE),
    Parameter("contact_damping", SHAPE, "shape_contact_damping", "contactDamping", **_SURFACE),
    Parameter("friction_anchor", SHAPE, "shape_friction_anchor", "frictionAnchor", "i"),
    Parameter("inertia", LINK, "link_inertia", "localInertiaDiagonal", "3", not_negative=True, **_VARIES),
    Parameter("ccd_swept_sphere_radius", SHAPE, "shape_ccd_radius", "ccdSweptSphereRadius"),
    Parameter(
        *("contact_processing_threshold", SHAPE, "shape_processing_threshold", "contactProcessingThreshold"),
        is_quick=True,
        **_VARIES,
        **_BOUNDS,
    ),
    Parameter("activation_state", BODY, "", "activationState", "i"),
    Parameter("joint_damping", VELOCITY, "", "jointDamping", not_negative=True, **_VARIES),
    Parameter("anisotropic_friction", SHAPE, "shape_anisotropy", "anisotropicFriction", "3"),
    Parameter("max_joint_velocity", BODY, "tree_max_velocity", "maxJointVelocity", **_BOUNDS, **_OF_BODY),
    Parameter("collision_margin", SHAPE, "shape_margin", "collisionMargin"),
    Parameter("joint_lower_limit", LIMIT, "constraint_lower", "jointLowerLimit", **_BOUNDS, **_VARIES),
    Parameter("joint_upper_limit", LIMIT, "constraint_upper", "jointUpperLimit", **_BOUNDS, **_VARIES),
    Parameter("joint_limit_force", LIMIT, "", "jointLimitForce", **_BOUNDS),
    Parameter("sleep_threshold", BODY, "tree_sleep_threshold", "sleepThreshold", **_BOUNDS),
    Parameter("joint_armature", VELOCITY, "dof_armature", not_negative=True, **_VARIES),
    Parameter("joint_stiffness", VELOCITY, "dof_stiffness", not_negative=True, **_VARIES),
    Parameter("joint_spring_reference", POSITION, "position_spring", **_VARIES),
    Parameter("joint_friction", FRICTION, "constraint_upper", not_negative=True, **_VARIES),
    Parameter("friction_rank", SHAPE, "shape_friction_rank", **_OF_FILES),
    Parameter("friction_dimensions", SHAPE, "shape_friction_dimensions", **_OF_FILES),
    Parameter("contact_reference", SHAPE, "shape_reference", **_OF_FILES),
    Parameter("contact_impedance", SHAPE, "shape_impedance", **_OF_FILES),
    Parameter("contact_mixing", SHAPE, "shape_mixing", **_OF_FILES),
    Parameter("surface_velocity", SHAPE, "shape_surface_velocity", kind="3", **_OF_FILES),
    Parameter("surface_spin", SHAPE, "shape_surface_spin", kind="3", **_OF_FILES),
)

PARAMETERS = {row.name: row for row in _ROWS}
"""All parameters by name."""
CHANGE_DYNAMICS = {
    **{"bodyUniqueId": "b", "linkIndex": "i"},
    **{row.argument: row.kind for row in _ROWS if row.argument},
    "physicsClientId": "c",
}
"""The arguments of `changeDynamics`, with their kinds."""


def _fields(*owners: str, is_quick: bool = False) -> dict[str, str]:
    chosen = (row for row in _ROWS if row.owner in owners and row.is_quick >= is_quick)
    return {row.name: row.field for row in chosen}


SURFACE_FIELDS = _fields(SHAPE)
"""The field of `Shapes` in which each attribute of a link's surface is kept."""
SURFACE = _fields(SHAPE, is_quick=True)
"""Those that the native library changes without Python."""
OF_BODY = _fields(BODY, is_quick=True)
"""Parameters of bodies that it changes likewise, with the corresponding fields of `Model`."""
OF_SHAPES = tuple(row.name for row in _ROWS if row.of_one)
"""The parameters of a link that a shape of it can have differently."""
JOINT_TERMS = _fields(VELOCITY, POSITION)
"""Damping, armature and spring of joints, with fields of `Model`; that of damping depends on the body."""
LIMITS = {name: field for name, field in _fields(LIMIT).items() if field}
"""Limits of joints, likewise."""
