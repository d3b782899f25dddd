"""Names that other simulators have for what Carom has under another one, for messages of errors."""

from __future__ import annotations

FOREIGN: dict[str, dict[str, str]] = {
    "World": {
        # MuJoCo
        "timestep": "time_step",
        "opt": "time_step, gravity, contact, integrator and parameters",
        "qpos": "state.position, or joints.positions of a body",
        "qvel": "state.velocity, or joints.velocities of a body",
        "ctrl": "controls",
        "act": "actuators.activations of a body",
        "sensordata": "sensors",
        "xpos": "links[...].pose.position of a body",
        "xquat": "links[...].pose.orientation of a body",
        "ncon": "len(contacts())",
        "contact_list": "contacts()",
        "forward": "not needed: what is asked for is computed for the present state",
        "render": "image(camera), or view()",
        # PyBullet
        "stepSimulation": "step",
        "step_simulation": "step",
        "setGravity": "gravity",
        "set_gravity": "gravity",
        "loadURDF": "load",
        "load_robot": "load",
        "resetSimulation": "clear",
        "reset_simulation": "clear",
        "getContactPoints": "contacts",
        "getClosestPoints": "nearest",
        "rayTest": "ray",
        "ray_test": "ray",
        "cast_ray": "ray",
        "raycast": "ray",
        "saveState": "snapshot",
        "restoreState": "restore",
        "save_state": "snapshot",
        "restore_state": "restore",
        "createConstraint": "constrain",
        "tie": "constrain",
        "removeBody": "remove",
        # Genesis, Isaac, Gymnasium
        "add_entity": "load, or add_box, add_sphere, add_plane and so on",
        "add_ground_plane": "add_plane",
        "build": "not needed",
        "dt": "time_step",
        "entities": "bodies",
        "robots": "bodies",
        "simulate": "step",
        "close": "not needed: `with World() as world:` frees it at the end of the block",
        "num_envs": "count of carom.Worlds(world, count)",
    },
    "Body": {
        "qpos": "joints.positions",
        "qvel": "joints.velocities",
        "position": "pose.position",
        "orientation": "pose.orientation",
        "quaternion": "pose.quaternion",
        "rotation": "pose.rotation",
        "linear_velocity": "velocity.linear",
        "angular_velocity": "velocity.angular",
        "joint_positions": "joints.positions",
        "joint_velocities": "joints.velocities",
        "joint_names": "joints.names",
        "link_names": "links.names",
        "get_pos": "pose.position",
        "set_pos": "set_pose",
        "get_qpos": "joints.positions",
        "set_qpos": "joints.reset",
        "set_dofs_kp": "joints.servo(targets, kp=, kd=)",
        "set_dofs_position": "joints.reset",
        "control_dofs_position": "joints.servo(targets, kp=, kd=)",
        "control_dofs_velocity": "joints.velocity_servo(targets, kd=)",
        "control_dofs_force": "joints.torques",
        "set_joint_positions": "joints.positions",
        "set_position": "set_pose",
        "set_base_pose": "set_pose",
        "base_pose": "pose",
        "base_velocity": "velocity",
        "ik": "inverse_kinematics",
        "fk": "forward_kinematics",
        "calculate_inverse_kinematics": "inverse_kinematics",
        "calculateInverseKinematics": "inverse_kinematics",
        "getJointStates": "joints.positions and joints.velocities",
        "num_joints": "joint_count",
        "is_asleep": "asleep",
        "center_of_mass": "com",
    },
    "Joint": {
        "qpos": "position",
        "qvel": "velocity",
        "angle": "position",
        "effort": "torque",
        "force": "torque",
        "set_position": "position, or servo(target, kp=, kd=)",
        "set_target": "servo(target, kp=, kd=)",
        "disable_motor": "free()",
        "lower": "limits[0]",
        "upper": "limits[1]",
        "frictionloss": "friction_loss",
        "max_force": "effort_limit",
    },
    "Joints": {
        "qpos": "positions",
        "qvel": "velocities",
        "position": "positions",
        "velocity": "velocities",
        "torque": "torques",
        "angles": "positions",
        "efforts": "torques",
        "set_positions": "positions, or servo(targets, kp=, kd=)",
        "set_targets": "servo(targets, kp=, kd=)",
        "disable_motors": "free()",
    },
    "Scene": dict.fromkeys(
        (
            *("base", "bounds", "com", "forward_kinematics", "inverse_dynamics", "inverse_kinematics"),
            *("jacobian", "joints", "links", "mass", "mass_matrix", "name", "pose", "set_pose", "shapes"),
            "velocity",
        ),
        "that is of a body: take one by its name or place, world.load(file)['panda'] or [0], or load a URDF "
        "file by load_urdf, which returns its body",
    ),
    "Link": {
        "position": "pose.position",
        "orientation": "pose.orientation",
        "xpos": "pose.position",
        "xquat": "pose.orientation",
        "world_pose": "pose",
        "center_of_mass": "com",
        "apply_external_force": "apply_force",
    },
}
SET_BY: dict[str, dict[str, str]] = {
    "Body": {
        "mass": "body.change_dynamics(link, mass=kilograms), for each of its links",
        "com": "body.pose, which moves all of it",
        "bounds": "body.pose, which moves it",
    },
    "Link": {
        "mass": "body.change_dynamics(link, mass=kilograms)",
        "inertia": "body.change_dynamics(link, inertia=(x, y, z))",
        "pose": "body.pose of the base, and body.joints.positions of the others",
        "velocity": "body.velocity of the base, and body.joints.velocities of the others",
    },
    "Joint": {
        "limits": "body.change_dynamics(joint.index, joint_lower_limit=lower, joint_upper_limit=upper)",
        "effort_limit": "max_force= of servo and the others",
        "motor_torque": "torque",
    },
    "Joints": {
        "limits": "body.change_dynamics(index, joint_lower_limit=lower, joint_upper_limit=upper), one by one",
        "effort_limits": "max_forces= of servo and the others",
        "motor_torques": "torques",
    },
    "BodyShape": {"size": "adding a body with the other size"},
    "BodyActuator": {"force": "control", "length": "the position of its joint"},
    "Worlds": dict.fromkeys(
        ("contact", "integrator", "solver", "substeps"), "the same of the world, before Worlds(world, count)"
    ),
    "TendonBatch": dict.fromkeys(
        ("armature", "damping", "friction", "range", "spring_range", "stiffness"),
        "the same of the tendon in the world, before Worlds(world, count)",
    ),
}
"""What sets properties that can only be read, by class and name."""
for _many, _one in (
    ("Worlds", "World"),
    ("BodyBatch", "Body"),
    ("JointBatch", "Joint"),
    ("JointGroup", "Joints"),
    ("JointGroupBatch", "Joints"),
    ("LinkBatch", "Link"),
):
    FOREIGN[_many] = FOREIGN[_one]
    SET_BY.setdefault(_many, SET_BY.get(_one, {}))
SET_BY["ActuatorBatch"] = SET_BY["BodyActuator"]
FOREIGN["Worlds"] = FOREIGN["Worlds"] | {
    "times": "time",
    "reset_to": "reset",
    "num_envs": "count",
    "close": "not needed",
    "ray": "rays",
    "image": "images",
    **{name: f"extract(number).{name}" for name in ("overlapping", "save", "log", "record")},
    **dict.fromkeys(
        ("load", "load_urdf", "add_box", "add_sphere", "add_plane", "remove", "constrain"),
        "of the world, before Worlds(world, count)",
    ),
}


def attribute_error(it: object, name: str) -> AttributeError:
    """The error of an attribute that something does not have, with the one that was probably meant."""
    said = f"{type(it).__name__} has no attribute {name!r}"
    meant = foreign(it, name)
    if meant is not None:
        return AttributeError(f"{said}; here: {meant}")
    near = similar(it, name)
    return AttributeError(said if near is None else f"{said}; did you mean {near!r}?")


def foreign(it: object, name: str) -> str | None:
    """What is here under another name, if others have it under this one."""
    found = (FOREIGN.get(base.__name__, {}).get(name) for base in type(it).__mro__)
    return next((meant for meant in found if meant is not None), None)


def similar(it: object, name: str) -> str | None:
    """The attribute for users whose name is most alike, if any is."""
    if name[0] == "_":
        return None
    from difflib import get_close_matches

    from carom.internal_names import INTERNAL

    kind = type(it)
    hidden = {known for base in kind.__mro__ for known in INTERNAL.get(base.__name__, ())}
    own = getattr(it, "__dict__", {})
    there = [known for known in {*dir(kind), *own} - hidden if known[0] != "_"]
    near = get_close_matches(name, sorted(there), 1)
    return near[0] if near else None
