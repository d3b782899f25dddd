"""Names of public classes that other packages of Carom use, and users are not told of.

The reference pages don't list them, `dir()` leaves them out, and they may change in any release. A new name
that is not meant for users has an underscore in front, or has to be named here.
"""

from __future__ import annotations

INTERNAL: dict[str, frozenset[str]] = {
    "Body": frozenset(
        (
            "all_dynamics",
            "coordinates",
            "derived",
            "encoded_names",
            "first_link",
            "first_position",
            "first_velocity",
            "follow",
            "forget_handles",
            "has_sensor",
            "joint_types",
            "link_inertial_frame",
            "link_number",
            "link_spec",
            "links_before",
            "measure_limit",
            "measure_load",
            "measured_joints",
            "note_joint_states",
            "note_reset",
            "note_sensor",
            "position_count",
            "position_index",
            "relocate",
            "rows",
            "set_base_velocity",
            "set_dynamics",
            "set_inertial_pose",
            "set_joint_state",
            "set_joint_states",
            "set_sensor",
            "update_link_poses",
            "update_link_velocities",
            "velocity_count",
            "velocity_index",
        )
    ),
    "Camera": frozenset(
        (
            "pose_where",
            "views",
        )
    ),
    "ContactSummary": frozenset(("include",)),
    "Description": frozenset(
        (
            "put",
            "root",
            "search",
        )
    ),
    "EngineParameters": frozenset(("substeps_due",)),
    "Keyframe": frozenset(("of",)),
    "DerivativeBatch": frozenset(("name",)),
    "NamedVector": frozenset(("of",)),
    "Log": frozenset(
        (
            "after_step",
            "before_step",
        )
    ),
    "Queries": frozenset(
        (
            "contact_columns",
            "contacts",
            "nearest_shapes",
            "ray_tuple",
            "ray_tuples",
            "soft_contacts",
        )
    ),
    "Viewer": frozenset(
        (
            "draw_now",
            "has_turn",
            "wait_for_turn",
        )
    ),
    "World": frozenset(
        (
            "add_constraint",
            "analytics",
            "arrays",
            "call_lock",
            "change_constraint",
            "change_constraints",
            "change_scene",
            "constraints",
            "constraints_changed",
            "contact_arrays",
            "engine",
            "free_ids",
            "grow",
            "joint_reaction_memory",
            "joint_torque_memory",
            "kept_linearization",
            "law_of_contacts",
            "let_go",
            "link_columns",
            "link_force_memory",
            "link_places",
            "link_pose_memory",
            "link_velocity_memory",
            "links_loaded",
            "listing",
            "load_all",
            "motor",
            "motor_impulse_memory",
            "motor_memory",
            "next_id",
            "note_constraint",
            "note_link_poses",
            "note_link_velocities",
            "note_no_constraint",
            "note_parameters",
            "note_soft_poses",
            "note_time",
            "parameters_set",
            "pause_step",
            "pd",
            "pd_memory",
            "position_memory",
            "prepare",
            "prepare_poses",
            "present_poses",
            "quick",
            "refuse_if_left",
            "refuse_in_step",
            "resume_step",
            "scene_changed",
            "scene_version",
            "set_base_freedom",
            "settle_loads",
            "take_arrays",
            "unspent_time",
            "unwatch_substeps",
            "update_link_poses",
            "update_link_velocities",
            "update_soft_poses",
            "user_constraints",
            "velocity_memory",
            "view",
            "was_left",
            "watch_substeps",
        )
    ),
    "Worlds": frozenset(("call_lock", "glimpses", "observers")),
}
