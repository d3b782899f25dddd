"""One of many worlds as a `World`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from carom.engine.engine import Engine
from carom.layouts.codes import ABSENT, ConstraintKind
from carom.layouts.dynamics_parameters import (
    LINK,
    OF_BODY,
    PARAMETERS,
    POSITION,
    SHAPE,
    SURFACE,
    VELOCITY,
)
from carom.model.actuator_rows import read_actuator, write_actuator
from carom.model.body_spec import BASE
from carom.model.link_dynamics import LinkDynamics
from carom.native.tables import ArrayTable
from carom.scene.body import Body
from carom.scene.common.shape import MOTIONS
from carom.scene.dynamics.places import places, view
from carom.world.face.sizing import resize
from carom.world.world import World
from carom.worlds.parts.sizes import of_core

# Parameters that links of one world have; limits and friction belong to constraints.
_OF_LINKS = [
    name for name, row in PARAMETERS.items() if row.varies and row.owner in (SHAPE, LINK, VELOCITY, POSITION)
]


def lone_world(scene: World, engine: Engine, number: int, time: float, unspent_time: float) -> World:
    """A copy of a scene with the state and the parameters of one of the worlds of an engine."""
    world = scene.copy()
    world.time, world.unspent_time = float(time), float(unspent_time)
    contacts = engine.contact_arrays.contacts
    world.contact_arrays.contacts.reserve(contacts.capacity)
    _copy_row(engine.arrays.state, world.arrays.state, number)
    _copy_row(contacts, world.contact_arrays.contacts, number)
    _take_parameters(world, engine, number)
    world.scene_changed()
    return world


def refill(world: World, engine: Engine, number: int, *, parameters: bool = True) -> None:
    """Give a `lone_world` the state and, if wanted, the parameters of another world of the engine."""
    contacts = engine.contact_arrays.contacts
    if world.contact_arrays.contacts.reserve(contacts.capacity):
        world.scene_changed()
    _copy_row(engine.arrays.state, world.arrays.state, number)
    _copy_row(contacts, world.contact_arrays.contacts, number)
    if parameters:
        _take_parameters(world, engine, number)
        world.scene_changed()


def copy_coordinates(engine: Engine, number: int, world: World) -> None:
    """Give a world the coordinates of one world of an engine with the same bodies, and who is present."""
    own = world.arrays.state.numpy
    for name in ("position", "node_position"):
        positions = engine.arrays.state.numpy[name][number]
        own[name][0, : len(positions)] = positions
    for body in world.bodies.values():
        is_there = bool(engine.arrays.state.numpy["tree_activity"][number, body.rows.tree] != ABSENT)
        if is_there != body.present:
            body.present = is_there


def _copy_row(source: ArrayTable, target: ArrayTable, number: int) -> None:
    for name, array in source.numpy.items():
        target.numpy[name][0, : array.shape[1]] = array[number]


def _take_parameters(world: World, engine: Engine, number: int) -> None:
    """Set the parameters of a world that can differ between worlds to those of one of an engine's worlds."""
    model = engine.arrays.model
    x, y, z = _row(model, "gravity_vector", number)[0].tolist()
    world.parameters.gravity = (x, y, z)
    world.parameters.fluid_density = float(_row(model, "fluid_density", number)[0])
    world.parameters.fluid_viscosity = float(_row(model, "fluid_viscosity", number)[0])
    x, y, z = _row(model, "fluid_wind", number)[0].tolist()
    world.parameters.wind = (x, y, z)
    _take_sizes(world, engine, number)
    for body in world.bodies.values():
        tree = body.rows.tree
        damping = {name: float(_row(model, field, number)[tree]) for name, field in OF_BODY.items()}
        body.change_dynamics(BASE, **damping)
        for link in range(BASE, body.joint_count):
            row, dynamics = body.first_link + 1 + link, body.dynamics(link)
            for name in _OF_LINKS:
                _take_parameter(engine, body, link, dynamics, name, number)
            _take_own_surfaces(engine, row, len(body.link_spec(link).collisions), dynamics, number)
            body.set_dynamics(link, dynamics)
    _take_limits(world, engine, number)
    _take_actuators(world, engine, number)
    for user, row in world.user_constraints.rows.items():
        constraint = world.user_constraints.get(user)
        if constraint is not None:
            constraint.enabled = bool(_row(engine.contact_arrays.users, "user_enabled", number)[row])


def _take_sizes(world: World, engine: Engine, number: int) -> None:
    """Give shapes the sizes that they have in a world; its contacts are those of shapes of these sizes."""
    shapes = world.contact_arrays.shapes
    sizes = _row(engine.contact_arrays.shapes.table, "shape_size", number)
    present = _row(shapes.table, "shape_size", 0)
    if (sizes == present[: len(sizes)]).all():
        return
    for body in world.bodies.values():
        for link in range(BASE, body.joint_count):
            geometries = [it.geometry for it in body.link_spec(link).collisions]
            others = [*geometries]
            for place, row in shapes.rows_of_collisions(body.first_link + 1 + link):
                if (sizes[row] != present[row]).any():
                    others[place] = of_core(geometries[place], sizes[row].tolist())
            if others != geometries:
                resize(body, link, others, keep_contacts=True)


def _take_parameter(
    engine: Engine, body: Body, link: int, dynamics: LinkDynamics, name: str, number: int
) -> None:
    """Give the dynamics of a link a parameter of a world, if the link has it."""
    kept = places(engine, body, link, name)
    owner = PARAMETERS[name].owner
    if not kept or (owner == LINK and link == BASE and body.fixed_base):
        return
    array = view(engine, kept[0])
    values = array[number if len(array) > 1 else 0].tolist()
    if owner == POSITION or name == "inertia":
        setattr(dynamics, name, tuple(values))
    else:
        # All shapes and all velocity coordinates of a joint have the same.
        setattr(dynamics, name, values[0] if isinstance(values, list) else values)


def _take_own_surfaces(
    engine: Engine, link_row: int, count: int, dynamics: LinkDynamics, number: int
) -> None:
    """Give the `count` shapes of a link the surfaces that they have in a world, where these are their own."""
    shapes = engine.contact_arrays.shapes
    found = list(dynamics.surfaces) or [None] * count
    for place, row in shapes.rows_of_collisions(link_row):
        values: dict[str, Any] = {
            name: float(_row(shapes.table, field, number)[row])
            for name, field in SURFACE.items()
            if PARAMETERS[name].of_one
        }
        for name in MOTIONS:
            x, y, z = _row(shapes.table, PARAMETERS[name].field, number)[row].tolist()
            values[name] = (x, y, z)
        values["friction_dimensions"] = int(_row(shapes.table, "shape_friction_dimensions", number)[row])
        present = dynamics.surface_of(place)
        if any(getattr(present, name) != value for name, value in values.items()):
            found[place] = replace(present, **values)
    if any(own is not None for own in found):
        dynamics.surfaces = tuple(found)


def _take_actuators(world: World, engine: Engine, number: int) -> None:
    model = engine.arrays.model.numpy
    for body in world.bodies.values():
        rows = range(body.rows.first["actuator"], body.rows.first["actuator"] + body.rows.count["actuator"])
        if rows:
            specs = zip(rows, body.spec.actuators, strict=True)
            taken = tuple(read_actuator(model, row, number, spec) for row, spec in specs)
            body.spec = replace(body.spec, actuators=taken)
            for row, spec in zip(rows, taken, strict=True):
                write_actuator(world.arrays.model.numpy, row, spec)


def _take_limits(world: World, engine: Engine, number: int) -> None:
    model = engine.arrays.model
    kinds, links = model.numpy["constraint_kind"], model.numpy["constraint_link"]
    lower, upper = _row(model, "constraint_lower", number), _row(model, "constraint_upper", number)
    of_joints = (ConstraintKind.LIMIT, ConstraintKind.FRICTION)
    rows = {
        (int(kinds[row]), int(links[row])): row
        for row in range(engine.arrays.used["constraint"])
        if kinds[row] in of_joints
    }
    for constraint in world.joint_constraints.all:
        if constraint.kind not in of_joints:
            continue
        row = rows[constraint.kind, constraint.body.first_link + 1 + constraint.joint]
        constraint.lower, constraint.upper = float(lower[row]), float(upper[row])
        if constraint.kind == ConstraintKind.FRICTION:
            continue
        dynamics = constraint.body.dynamics(constraint.joint)
        dynamics.joint_lower_limit, dynamics.joint_upper_limit = constraint.lower, constraint.upper


def _row(table: ArrayTable, field: str, number: int) -> np.ndarray:
    """The values of a field in a world; if the worlds do not differ, they share one row."""
    array = table.numpy[field]
    return array[number if len(array) > 1 else 0]
