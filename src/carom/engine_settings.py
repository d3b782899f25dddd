"""The engine's parameters as kernels take them."""

from __future__ import annotations

from typing import Any

from carom.model.builder import WorldArrays
from carom.model.structs import Settings
from carom.physics.parameters import EngineParameters
from carom.touch_arrays import TouchArrays


def engine_settings(parameters: EngineParameters, arrays: WorldArrays, touch: TouchArrays) -> Any:
    """`Settings` of a world: its parameters, and how much of its arrays is in use."""
    settings: Any = Settings()
    settings.time_step = parameters.substep_time
    settings.gravity = parameters.gravity
    settings.iterations = parameters.solver_iterations
    settings.inner_iterations = parameters.noncontact_inner_iterations
    settings.residual_threshold = parameters.solver_residual_threshold
    settings.joint_erp = parameters.erp
    settings.split_impulse = int(parameters.split_impulse)
    settings.split_threshold = parameters.split_impulse_penetration_threshold
    settings.feedback_in_world = parameters.joint_feedback_mode & 1
    settings.feedback_in_joint = parameters.joint_feedback_mode >> 1 & 1
    settings.tree_count = arrays.used["tree"]
    settings.user_count = touch.user_count
    settings.constraint_count = arrays.used["constraint"]
    settings.contact_erp = parameters.contact_erp
    settings.friction_erp = parameters.friction_erp
    settings.contact_softness = parameters.global_cfm / parameters.substep_time
    settings.contact_slop = parameters.contact_slop
    settings.contact_warm_starting = parameters.contact_warm_starting
    settings.restitution_threshold = parameters.restitution_velocity_threshold
    settings.cone_friction = int(parameters.cone_friction)
    settings.shape_count = touch.shapes.shape_count
    settings.filter_count = touch.shapes.filter_count
    settings.filter_both = int(parameters.collision_filter_mode == 0)
    return settings
