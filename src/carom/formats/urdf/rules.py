"""What is lost with each element of URDF files that is left out."""

from __future__ import annotations

from carom.formats.reading.rules import Rule, Rules

_NO_ACTUATORS = "only those of simple transmissions are made; command joints by their motors"
_SIMULATOR = "settings of another simulator"

URDF_RULES: Rules = Rules(
    "URDF",
    (
        Rule("transmission/*", "none for the dynamics", "it is for the programs of the real robot"),
        Rule("transmission/type", "none: it is a simple one", "another one counts"),
        Rule("actuator/*", "none for the dynamics", "it is for the programs of the real robot"),
        Rule("transmission/joint/*", "none for the dynamics", "it is for the programs of the real robot"),
        Rule("transmission@*", "none", "its actuator has a name"),
        Rule("transmission/joint@*", "none for the dynamics", "it is for the programs of the real robot"),
        Rule("transmission/actuator@*", "none for the dynamics", "it is for the programs of the real robot"),
        Rule("robot/gazebo", "its sensors, plugins and contact parameters are missing", _SIMULATOR),
        Rule("robot/ros2_control", "its controllers and initial values are missing", _NO_ACTUATORS),
        Rule("robot/sensor", "the sensor is missing", "sensors of files are not made yet"),
        Rule("robot/link/sensor", "the sensor is missing", "sensors of files are not made yet"),
        Rule(
            "robot/group",
            "none for the dynamics",
            "groups belong to motion planning; see srdf= of World.load",
        ),
        Rule(
            "robot/disable_collisions",
            "these links collide",
            "it belongs to an SRDF file; see srdf= of World.load",
        ),
        Rule("robot/mujoco", "MuJoCo's options are not used", _SIMULATOR),
        Rule("mujoco/*", "MuJoCo's options are not used", _SIMULATOR),
        Rule("compiler@balanceinertia", "inertia is taken as it is", "it is not changed silently"),
        Rule("compiler@discardvisual", "none: visuals are kept", "the dynamics don't depend on it"),
        Rule(
            "compiler@fusestatic", "none: links on fixed joints are kept", "the dynamics don't depend on it"
        ),
        Rule(
            "joint/safety_controller",
            "none for the dynamics",
            "it is for the controllers of the real robot, which stop before limits",
            even_if_taken=True,
        ),
        Rule("joint/calibration", "none for the dynamics", "it describes a sensor of the real robot"),
        Rule("joint/axis@xyz", "none: it is a fixed joint", "only other joints have an axis"),
        Rule("joint/dynamics@spring_stiffness", "the joint has no spring", "springs are not read yet"),
        Rule("joint/dynamics@spring_reference", "the joint has no spring", "springs are not read yet"),
        Rule("joint/dynamics@K", "the joint has no spring", "springs are not read yet"),
        Rule("joint/dynamics@armature", "no reflected inertia of the rotor", "armature is not read yet"),
        Rule("collision/surface", "Carom's own contact parameters are used", "it belongs to SDF"),
        Rule("collision/material", "none: a collision shape is not seen", "materials are of visuals"),
        Rule("link/surface", "Carom's own contact parameters are used", "it belongs to SDF"),
        Rule("link/gravity", "gravity acts on the link", "not built"),
        Rule("link/kinematic", "the link moves as others do", "not built"),
        Rule("joint/limit@acceleration", "accelerations are not limited", "not built"),
        Rule("joint/limit@jerk", "jerks are not limited", "not built"),
        Rule("joint/limit@deceleration", "decelerations are not limited", "not built"),
        Rule("joint/actuator", "joints are commanded directly", _NO_ACTUATORS),
        Rule("joint/drake:controller_gains", "no controller is made", _NO_ACTUATORS),
        Rule("robot/drake:collision_filter_group", "these links collide", "not built"),
        Rule("robot/drake:joint", "this joint is missing", "not built"),
        Rule("robot/drake:bushing", "this spring is missing", "not built"),
        Rule("robot/drake:ball_constraint", "this constraint is missing", "not built"),
        Rule("collision/drake:proximity_properties", "Carom's own contact parameters are used", "not built"),
        Rule("geometry/verbose", "none", "it is a setting of a log"),
        Rule("link/self_collision_checking", "links collide as the flags of loading say", "not built"),
        Rule("link/collision_checking", "links collide as the flags of loading say", "not built"),
        Rule("link/self_filter", "links collide as the flags of loading say", "not built"),
        Rule("link/origin", "the link's frame is that of its joint", "its joint has the frame"),
        Rule("contact/contact_cfm", "the contact is rigid, or has its stiffness", "not built"),
        Rule("contact/contact_erp", "penetrations are corrected as in all contacts", "not built"),
        Rule("deformable/inertial/inertia", "none: a soft body has no tensor", "its nodes have masses"),
        Rule("deformable/inertial/origin", "none: a soft body has no tensor", "its nodes have masses"),
        Rule("robot/link", "the link is missing", "a robot that is a soft body has no links"),
        Rule("robot/joint", "the joint is missing", "a robot that is a soft body has no joints"),
        Rule("geometry@name", "none", "names of geometry are not used"),
        Rule("collision/verbose", "none", "it is a setting of a log"),
        Rule("link@type", "none", "not in use"),
        Rule("link@concave", "the shape is convex", "write it at <collision>"),
    ),
)
