"""What is lost with each element of SDF files that is left out."""

from __future__ import annotations

from carom.formats.reading.rules import Rule, Rules

_BUILT = "not built"
_OWN = "Carom's own value is used"
_LOOKS = "none for the dynamics"

SDF_RULES: Rules = Rules(
    "SDF",
    (
        Rule("*/plugin", "the plugin does not run", "plugins are programs of Gazebo"),
        Rule("*/sensor", "the sensor is missing", "sensors of files are not made yet"),
        Rule("*/light", _LOOKS, "lights are set in the window"),
        Rule("sdf/world@name", "none", "a world has no name"),
        Rule("collision/material", _LOOKS, "only visual shapes are seen"),
        Rule("world/physics", _OWN, "options of files are not set yet; see World.parameters"),
        Rule("world/gravity", _OWN, "options of files are not set yet; see World.gravity"),
        Rule("world/magnetic_field", "there is no magnetic field", _BUILT),
        Rule("world/atmosphere", "there is no air", _BUILT),
        Rule("world/wind", "there is no wind", _BUILT),
        Rule("world/scene", _LOOKS, "it describes the window of Gazebo"),
        Rule("world/gui", _LOOKS, "it describes the window of Gazebo"),
        Rule("world/audio", _LOOKS, "there is no sound"),
        Rule("world/spherical_coordinates", "none: positions are metres from the origin", _BUILT),
        Rule("world/state", "models are where the file puts them, not where a run left them", _BUILT),
        Rule("world/joint", "models are not joined", _BUILT),
        Rule("model/frame", "none: no link is placed relative to it", "frames are not kept"),
        Rule("model/gripper", "it does not grip", _BUILT),
        Rule("model/self_collide", "links collide as the flags of loading say", _BUILT),
        Rule("model/allow_auto_disable", "none: sleep is a flag of loading", _BUILT),
        Rule("model/enable_wind", "there is no wind", _BUILT),
        Rule("link/pose@relative_to", "none", "no frame is named"),
        Rule("frame/pose", "none: no link is placed relative to it", "frames are not kept"),
        Rule("frame/pose@relative_to", "none", "no frame is named"),
        Rule("pose@relative_to", "the pose is taken in the enclosing frame", _BUILT, True),
        Rule("pose@frame", "the pose is taken in the enclosing frame", _BUILT),
        Rule("link/gravity", "gravity acts on the link", _BUILT),
        Rule("link/velocity_decay", "the link is damped as others are", _BUILT),
        Rule("link/self_collide", "links collide as the flags of loading say", _BUILT),
        Rule("link/kinematic", "the link moves as others do", _BUILT),
        Rule("link/enable_wind", "there is no wind", _BUILT),
        Rule("collision/surface", "Carom's own contact parameters are used", _BUILT),
        Rule("collision/laser_retro", "none", "there are no lasers"),
        Rule("collision/max_contacts", "contacts are as many as there are", _BUILT),
        Rule("material/*", _LOOKS, "a shape has a colour and a texture"),
        Rule("visual/cast_shadows", _LOOKS, "all shapes cast shadows"),
        Rule("visual/transparency", _LOOKS, _BUILT),
        Rule("visual/meta", _LOOKS, _BUILT),
        Rule("visual/laser_retro", "none", "there are no lasers"),
        Rule("axis/dynamics", "the joint has no damping and friction", _BUILT),
        Rule("limit/stiffness", "limits are rigid", _BUILT),
        Rule("limit/dissipation", "limits are rigid", _BUILT),
        Rule("axis/initial_position", "the joint begins at 0", "it is deprecated"),
        Rule("joint/physics", _OWN, "solver parameters are those of the world"),
        Rule("joint/axis2", "the joint has one axis", _BUILT),
    ),
)
