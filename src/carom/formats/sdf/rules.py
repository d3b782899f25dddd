"""What is lost with each element of SDF files that is left out."""

from __future__ import annotations

from collections.abc import Iterable

from carom.formats.reading.rules import Rule, Rules

_BUILT = "not built"
_OWN = "Carom's own value is used"
_LOOKS = "none for the dynamics"
_SOLVER = "none for what is simulated: it sets another solver"
_PICTURE = "the image is without it"


def _of(parents: str, children: str, consequence: str, reason: str) -> Iterable[Rule]:
    """A rule for each child of each parent."""
    return (
        Rule(f"{parent}{'' if child[0] == '@' else '/'}{child}", consequence, reason)
        for parent in parents.split()
        for child in children.split()
    )


SDF_RULES: Rules = Rules(
    "SDF",
    (
        Rule("*/plugin", "the plugin does not run", "plugins are programs of Gazebo"),
        Rule("plugin/*", _OWN, "the actuator of Carom has no such value"),
        Rule("*/sensor", "the sensor is missing", _BUILT),
        Rule("*/light", _LOOKS, "lights are set in the window"),
        *_of("include", "* @merge", "none", "the model is missing, or it says so itself"),
        Rule("sdf/actor", "the actor is missing", _BUILT),
        *_of("*", "@namespace namespace", "none", "there are no topics"),
        *_of("sdf world", "model include frame joint", "it is missing", "only the first world counts"),
        # The world.
        *_of("world physics state", "@name @world_name", "none", "a world has no name"),
        Rule("world/physics", _OWN, "another one counts"),
        *_of("physics", "@default @type", "none", "there is one solver"),
        *_of("physics", "real_time_factor real_time_update_rate", "none", "see World.real_time"),
        *_of("physics", "max_contacts", "contacts are as many as there are", _BUILT),
        *_of("world/physics physics", "ode bullet dart simbody", _SOLVER, "see World.parameters"),
        Rule("joint/physics", _OWN, "solver parameters are those of the world"),
        Rule("world/atmosphere", "there is no air", _BUILT),
        Rule("world/wind", "there is no wind", _BUILT),
        *_of("world", "scene gui", _LOOKS, "it describes the window of Gazebo"),
        *_of("world link", "audio audio_source audio_sink", _LOOKS, "there is no sound"),
        Rule("world/spherical_coordinates", "none: positions are metres from the origin", _BUILT),
        Rule("world/state", "models are where the file puts them, not where a run left them", _BUILT),
        Rule("world/joint", "models are not joined", _BUILT),
        *_of("world", "actor population road", "it is missing", _BUILT),
        # Models.
        Rule("model/frame", "none: nothing is placed relative to it", "frames are not kept"),
        Rule("model/gripper", "it does not grip", _BUILT),
        Rule("model/pose", "none: the <include> says where it is", "one pose counts"),
        *_of("model", "static @placement_frame @canonical_link", "none", "the model around it decides"),
        Rule("model/self_collide", "links collide as the model around it says", "it is merged into that"),
        Rule("model/allow_auto_disable", "none: sleep is a flag of loading", _BUILT),
        *_of("model include", "model_state", "joints begin at 0", _BUILT),
        *_of("model link", "enable_wind", "the wind does not move it", _BUILT),
        *_of("frame", "pose pose@relative_to pose@degrees pose@rotation_format", "none", "it is not named"),
        *_of("frame", "@attached_to", "none", "it is not named"),
        *_of("pose", "@relative_to @frame", "the pose is taken in the enclosing frame", _BUILT),
        *_of("pose", "@degrees @rotation_format", "none: there is no rotation", "the pose is empty"),
        *_of("joint/pose frame/pose", "@relative_to", "none", "nothing depends on it"),
        # Links.
        Rule("link/velocity_decay", "the air does not brake the link", "engines differ in what it means"),
        Rule("link/must_be_base_link", "none: roots of trees are bases", "joints decide it"),
        *_of("link", "projector battery particle_emitter", _LOOKS, _BUILT),
        Rule("inertial/fluid_added_mass", "no fluid moves with the link", _BUILT),
        *_of("inertial collision", "auto_inertia_params", _OWN, "meshes are measured exactly"),
        *_of("inertial", "inertia pose density", "none", "it is computed, or the mass is stated"),
        Rule("inertia/*", "none", "it is computed"),
        *_of("collision", "material", _LOOKS, "only visual shapes are seen"),
        *_of("collision visual", "laser_retro", "none", "there are no intensities of lasers"),
        Rule("collision/max_contacts", "contacts are as many as there are", _BUILT),
        Rule("collision/density", "none", "inertia is stated"),
        # Surfaces.
        Rule("collision/surface", _OWN, _BUILT),
        Rule("surface/soft_contact", "the surface is rigid", _BUILT),
        Rule("bounce/threshold", "slow contacts bounce as World.parameters says", "it is one for all"),
        *_of("friction", "ode bullet", "none, or only the other engine's values count", "one is used"),
        *_of("ode bullet", "fdir1 mu2 friction2", "friction is the same in all directions", _BUILT),
        *_of("ode", "slip slip1 slip2", "contacts do not slip", _BUILT),
        *_of("torsional", "ode surface_radius", "contacts do not slip", _BUILT),
        *_of("ode bullet", "soft_cfm soft_erp", "contacts are as kp and kd say", "one way counts"),
        *_of("ode", "max_vel min_depth", _OWN, "see World.parameters"),
        *_of("bullet", "split_impulse split_impulse_penetration_threshold", _OWN, "see World.parameters"),
        *_of("contact", "ode bullet", "none, or only the other engine's values count", "one is used"),
        *_of(
            "contact",
            "collide_without_contact collide_without_contact_bitmask collide_bitmask category_bitmask",
            "all links collide",
            "see World.set_collision_filter",
        ),
        *_of("contact", "poissons_ratio elastic_modulus", "contacts are as kp and kd say", "one way counts"),
        # Looks.
        Rule("material/*", _LOOKS, "a shape has a colour and a texture"),
        Rule("visual/cast_shadows", _LOOKS, "all shapes cast shadows"),
        *_of("visual", "transparency meta visibility_flags", _LOOKS, _BUILT),
        *_of("visual collision", "pose material surface", "none", "the shape is missing"),
        *_of("mesh", "submesh", "the whole mesh counts", _BUILT),
        *_of("mesh", "@optimization convex_decomposition", "it collides by its hull", "see World.load"),
        *_of("heightmap", "texture blend use_terrain_paging", _LOOKS, _BUILT),
        *_of("heightmap", "sampling", "one height for each pixel", _BUILT),
        *_of("geometry/image", "scale threshold height granularity uri", "none", "the shape is missing"),
        Rule("geometry/*", "only the first shape counts", "one is used"),
        # Joints.
        *_of("limit", "stiffness dissipation", "limits are rigid", _BUILT),
        Rule("axis/initial_position", "the joint begins at 0", "it is deprecated"),
        *_of("joint", "axis axis2", "the joint has no such axis", "its type decides"),
        *_of("joint", "gearbox_ratio gearbox_reference_body", "nothing is geared", "its type decides"),
        *_of("joint", "thread_pitch screw_thread_pitch", "none", "its type or the newer value decides"),
        # Sensors.
        *_of("sensor", "pose", "it is where its joint is", "sensors of joints are on links"),
        *_of("sensor", "*", "none, or the sensor is missing", "it is none of its type"),
        *_of("imu", "orientation_reference_frame", "orientation is in the world", _BUILT),
        Rule("*/noise", "the sensor has no such noise", _BUILT),
        Rule("noise/*", "the noise is Gaussian and does not drift", _BUILT),
        Rule("noise@type", "none", "noise is Gaussian"),
        *_of("altimeter", "vertical_position vertical_velocity", "it has no noise", _BUILT),
        *_of("navsat gps", "position_sensing velocity_sensing", "it has no noise", _BUILT),
        *_of("lidar ray", "visibility_mask", "it sees all", _BUILT),
        *_of("horizontal vertical", "resolution max_angle", "none", "one ray has no resolution"),
        *_of("range", "min resolution", "it sees from 0, without steps", _BUILT),
        *_of("contact", "topic", "none", "there are no topics"),
        *_of(
            "camera",
            "triggered trigger_topic camera_info_topic optical_frame_id save view_controller @name",
            "none",
            "it sees when it is asked",
        ),
        *_of("camera", "clip distortion lens noise visibility_mask", _PICTURE, "see carom.camera.Camera"),
        *_of("camera", "depth_camera segmentation_type box_type", "none", "cameras see depth and links"),
        *_of("image", "format anti_aliasing", "none", "images have one format"),
    ),
)
