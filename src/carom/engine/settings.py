"""The parameters of the engine as kernels need them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from operator import attrgetter
from typing import Any

from carom.description.pose import Vector3
from carom.engine.contact_arrays import ContactArrays
from carom.engine.parameters import CONVERGED, OF_STEPS, EngineParameters
from carom.layouts.codes import FrictionBound
from carom.layouts.model import EVERY_SHAPE, Settings
from carom.model.builder import WorldArrays
from carom.native.change import Change

# Parameters that are in arrays of the model, which launches read.
_IN_ARRAYS = {"gravity", "fluid_density", "fluid_viscosity", "wind"}
# Comparing the parameters takes a fifth of the time of what is derived from them.
_PARAMETERS = attrgetter(*[field.name for field in fields(EngineParameters) if field.name not in _IN_ARRAYS])
# Fields of `Model` in which the parameters of the fluid are.
_FLUID = ("fluid_density", "fluid_viscosity", "fluid_wind")


class EngineSettings:
    """The `Settings` of kernels: the parameters of worlds, and the numbers of rows in use.

    Attributes:
        struct: The argument of kernels: always the same object, whose fields change.
    """

    def __init__(self) -> None:
        self.struct: Any = Settings()
        self._written: dict[str, Any] = {}
        # The parameters and numbers that have been written.
        self._given: tuple[Any, ...] = ()
        # Whether parameters have changed since.
        self._is_outdated = False
        # Those of them that are numbers of constraints.
        self._constraint_counts = (0, 0)
        self._gravity = (0.0, 0.0, 0.0)
        self._fluid = (0.0, 0.0, (0.0, 0.0, 0.0))

    def note_change(self, change: Change) -> None:
        """Update the struct before it is used again: parameters change."""
        change.set(self, "_is_outdated", True)

    def note_gravity(self, change: Change, arrays: WorldArrays, gravity: Vector3) -> None:
        """Set gravity [m/s²] with a change: kernels read it in an array, and need no other settings."""
        rows = arrays.model.numpy["gravity_vector"][:, 0]
        change.write_numbers(rows, gravity * len(rows))
        change.set(self, "_gravity", gravity)

    def has_counts(self, arrays: WorldArrays, contact_arrays: ContactArrays) -> bool:
        """Whether the struct has the present numbers of constraints, and parameters."""
        counts = arrays.used["constraint"], contact_arrays.user_count
        return bool(self._given) and not self._is_outdated and counts == self._constraint_counts

    def update(
        self,
        parameters: EngineParameters,
        arrays: WorldArrays,
        contact_arrays: ContactArrays,
        tell: Callable[[], None],
    ) -> None:
        """Update the struct, and gravity and fluid of all worlds; `tell` is called if the struct has changed.

        If this is interrupted before `tell` has returned, it is called the next time.
        """
        model = arrays.model
        if parameters.gravity != self._gravity:
            model.numpy["gravity_vector"][:, 0] = parameters.gravity
            model.written("gravity_vector")
            self._gravity = parameters.gravity
        fluid = parameters.fluid_density, parameters.fluid_viscosity, parameters.wind
        if fluid != self._fluid:
            for name, value in zip(_FLUID, fluid, strict=True):
                model.numpy[name][:, 0] = value
                model.written(name)
            self._fluid = fluid
        shapes, used = contact_arrays.shapes, arrays.used
        of_constraints = used["constraint"], contact_arrays.user_count
        of_shapes = (shapes.shape_count, shapes.filter_count, shapes.filters.has_contacts, shapes.looks_ahead)
        given = (*_PARAMETERS(parameters), used["tree"], used["link"], *of_constraints, *of_shapes)
        if given == self._given:
            self._is_outdated = False
            return
        self._given = ()
        for name, value in _values(parameters, arrays, contact_arrays).items():
            # Writing a field of a struct takes a hundred times as long as comparing values.
            if self._written.get(name) != value:
                setattr(self.struct, name, value)
                self._written[name] = value
        tell()
        self._given, self._constraint_counts, self._is_outdated = given, of_constraints, False


def _values(
    parameters: EngineParameters, arrays: WorldArrays, contact_arrays: ContactArrays
) -> dict[str, Any]:
    substep_time = parameters.substep_time
    return {
        "time_step": substep_time,
        "duration": parameters.time_step,
        "iterations": parameters.solver_iterations,
        "inner_iterations": parameters.noncontact_inner_iterations,
        "residual_threshold": parameters.solver_residual_threshold,
        "joint_erp": parameters.erp,
        "split_impulse": int(parameters.split_impulse),
        "split_threshold": parameters.split_impulse_penetration_threshold,
        "feedback_in_world": parameters.joint_feedback_mode & 1,
        "feedback_in_joint": parameters.joint_feedback_mode >> 1 & 1,
        "order_by_links": int(parameters.deterministic_overlapping_pairs),
        "minimum_island_size": parameters.minimum_island_size,
        "tree_count": arrays.used["tree"],
        "link_count": arrays.used["link"],
        "user_count": contact_arrays.user_count,
        "constraint_count": arrays.used["constraint"],
        "contact_erp": parameters.contact_erp,
        "friction_erp": parameters.friction_erp,
        "contact_softness": parameters.global_cfm / substep_time,
        "contact_slop": parameters.contact_slop,
        "contact_warm_starting": parameters.contact_warm_starting,
        "restitution_threshold": parameters.restitution_velocity_threshold,
        "cone_friction": _friction_bound(parameters),
        "shape_count": contact_arrays.shapes.shape_count,
        "filter_count": contact_arrays.shapes.filter_count,
        "has_pair_contacts": int(contact_arrays.shapes.filters.has_contacts),
        "looks_ahead": (
            EVERY_SHAPE if parameters.contact in CONVERGED else int(contact_arrays.shapes.looks_ahead)
        ),
        "near": 2.0 * parameters.contact_breaking_threshold,
        "explicit_forces": int(parameters.integrator not in OF_STEPS),
        "filter_both": int(parameters.collision_filter_mode == 0),
    }


def _friction_bound(parameters: EngineParameters) -> int:
    if parameters.isotropic_friction:
        return int(FrictionBound.ISOTROPIC)
    return int(FrictionBound.CONE if parameters.cone_friction else FrictionBound.PYRAMID)
