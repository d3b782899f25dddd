"""Changes of a world are prepared beside it: at every line it is as before, or as after."""

from __future__ import annotations

import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import FrameType
from typing import Any

import numpy as np
import pytest
from tests.interrupts.faults import Fault, enters_or_leaves_a_section
from tests.rings import few

import carom
from carom import JointLimitForce, Motor, World
from carom.description.keyframe import BodyKeyframe
from carom.layouts.codes import UserConstraintKind
from carom.native import uninterrupted
from carom.native.tables import ArrayTable
from carom.render.appearance import appearance_of
from carom.scene.keyframes.keyframe import Keyframe
from carom.scene.soft_body import SoftBody

_OURS = str(Path(carom.__path__[0]))
# Of the lines of a call, about so many are tried, the same ones each time.
_TRIED = 60
_FILES = ("plane.urdf", "r2d2.urdf", "cube_small.urdf", "rrbot.urdf")


def made() -> World:
    """A world with bodies that touch, a constraint and a rule; a number is free."""
    world = World()
    for place, file in enumerate(_FILES):
        world.load_urdf(file, (0.3 * place, 0.0, 0.02), as_pybullet=True)
    world.remove(world.load_urdf("cube_small.urdf", (5.0, 0.0, 1.0)).id)
    world.gravity = (0.0, 0.0, -9.81)
    _tie(world)
    world.contact_arrays.shapes.filters.set(1, 20, enabled=False)
    world.step(3)
    return world


def _tie(world: World) -> Any:
    places = world.bodies[2], -1, world.bodies[1], 3
    return world.constrain_links(UserConstraintKind.FIXED, *places, axis=(0.0, 0.0, 1.0))


def _file(world: World, folder: Path) -> Callable[[], Any]:
    appearance_of(world).change(world.bodies[1], -1, rgba=(1.0, 0.0, 0.0, 1.0))
    world.save(folder / "saved")
    return lambda: world.load(folder / "saved")


def _mjcf(world: World, folder: Path) -> Callable[[], Any]:
    path = folder / "model.xml"
    path.write_text(
        """<mujoco><worldbody>
        <body name="a" pos="0 0 1"><joint name="i"/><geom name="g" size="0.1"/>
        <body name="b" pos="0 0 .3"><joint name="k" axis="1 0 0"/><geom name="h" size="0.1"/>
        <site name="tip" pos="0 0 .1"/></body></body>
        </worldbody><contact><exclude body1="a" body2="b"/></contact>
        <equality><joint joint1="i" joint2="k"/></equality>
        <tendon><fixed name="t"><joint joint="i" coef="1"/></fixed></tendon>
        <sensor><jointpos joint="i" name="s"/></sensor>
        <keyframe><key name="up" qpos="0.1 0.2"/></keyframe></mujoco>"""
    )
    return lambda: world.load(path)


def _restore(world: World, _: Path) -> Callable[[], Any]:
    state = world.snapshot()
    world.step(3)
    return lambda: world.restore(state, update_poses=True)


def _anchor(world: World, _: Path) -> Callable[[], Any]:
    cloth = world.load_cloth(size=(0.1, 0.1), cells=(1, 1), position=(0.0, 5.0, 1.0))
    cloth.set_node_velocities(np.ones((4, 3)))
    return lambda: cloth.anchor(1)


def _keyframe(world: World, _: Path) -> Callable[[], Any]:
    body = world.bodies[3]
    body.add_keyframe(BodyKeyframe("there", positions=(0.3, 0.4), time=2.0))
    return Keyframe("there", [body]).reset


def _coupling(world: World, folder: Path) -> Callable[[], Any]:
    coupling = next(iter(_mjcf(world, folder)().constraints.values()))
    return lambda: setattr(coupling, "enabled", False)


def _tendon(world: World, folder: Path) -> Callable[[], Any]:
    tendon = _mjcf(world, folder)().tendons["t"]
    return lambda: setattr(tendon, "stiffness", 3.0)


def _cloth(world: World, _: Path) -> SoftBody:
    cloth = world.load_cloth(size=(0.1, 0.1), cells=(1, 1), position=(0.0, 5.0, 1.0))
    cloth.set_node_velocities(np.ones((4, 3)))
    return cloth


def _nodes(world: World, folder: Path) -> Callable[[], Any]:
    cloth = _cloth(world, folder)
    return lambda: cloth.set_nodes(cloth.nodes + 0.1)


def _place_cloth(world: World, folder: Path) -> Callable[[], Any]:
    cloth = _cloth(world, folder)
    return lambda: cloth.set_inertial_pose((0.0, 0.0, 3.0), (0.0, 0.6, 0.0, 0.8))


def _spin_cloth(world: World, folder: Path) -> Callable[[], Any]:
    cloth = _cloth(world, folder)
    return lambda: cloth.set_base_velocity((0.0, 0.0, 3.0), (0.0, 0.6, 0.0))


def _force(world: World, _: Path) -> Callable[[], Any]:
    link = world.bodies[2].links.base
    # Poses of links are brought up to date.
    assert link.pose
    return lambda: link.apply_force((1.0, 2.0, 3.0), (0.1, 0.2, 0.3))


def _colour(world: World, _: Path) -> Callable[[], Any]:
    looks, body = appearance_of(world), world.bodies[1]
    looks.shapes(body, -1)
    return lambda: looks.change(body, -1, rgba=(1.0, 0.0, 0.0, 1.0), specular=(0.1, 0.2, 0.3))


_RED = np.full((2, 2, 3), (255, 0, 0), dtype=np.uint8)


def _texture(world: World, _: Path) -> Callable[[], Any]:
    return lambda: appearance_of(world).add_texture(_RED, list(world.bodies.values()))


def _other_texture(world: World, _: Path) -> Callable[[], Any]:
    textures = appearance_of(world).textures
    number = textures.add(_RED)
    return lambda: textures.replace(number, _RED // 2)


Change = Callable[[World, Path], Callable[[], Any]]

CHANGES: dict[str, Change] = {
    "load": lambda world, _: lambda: world.load_urdf("rrbot.urdf", (0.0, 2.0, 0.0), as_pybullet=True),
    "load another": lambda world, _: lambda: world.load_urdf("sphere_small.urdf", (0.0, 2.0, 0.0)),
    "load a model": _mjcf,
    "load a world": _file,
    "remove": lambda world, _: lambda: world.remove(1),
    "remove the last": lambda world, _: lambda: world.remove(3),
    "tie": lambda world, _: lambda: _tie(world),
    "untie": lambda world, _: lambda: world.remove_constraint(world.user_constraints.all[0]),
    "restore": _restore,
    "reset": lambda world, _: world.reset,
    "change dynamics": lambda world, _: (
        lambda: world.bodies[3].change_dynamics(
            0,
            mass=2.0,
            lateral_friction=0.3,
            joint_lower_limit=-1.0,
            joint_upper_limit=1.0,
            joint_damping=0.2,
        )
    ),
    "fix a base": lambda world, _: lambda: world.bodies[2].change_dynamics(-1, mass=0.0),
    "free a base": lambda world, _: lambda: world.set_base_freedom(world.bodies[3], free=True),
    "set dynamics": lambda world, _: (
        lambda: world.bodies[3].set_dynamics(
            0, replace(world.bodies[3].dynamics(0), mass=2.0, lateral_friction=0.3, collision_margin=0.02)
        )
    ),
    "set parameters": lambda world, _: (
        lambda: world.change_parameters(gravity=(0.0, 0.0, -1.0), substeps=2, contact_breaking_threshold=0.05)
    ),
    "set gravity": lambda world, _: lambda: setattr(world, "gravity", (0.0, 0.0, -1.0)),
    "add an actuator": lambda world, _: (
        lambda: world.bodies[1].add_actuator("motor", Motor(joint=world.bodies[1].joints.movable[-1].name))
    ),
    "add a site": lambda world, _: lambda: world.bodies[1].add_site("imu"),
    "add a sensor": lambda world, _: (
        lambda: world.bodies[1].add_sensor(
            "limit", JointLimitForce(world.bodies[1].joints.movable[0].name, delay=0.01)
        )
    ),
    "switch a sensor on": lambda world, _: world.bodies[3].joints.movable[0].enable_sensor,
    "anchor": _anchor,
    "reset to a keyframe": _keyframe,
    "reset a joint": lambda world, _: lambda: world.bodies[3].joints.movable[0].reset(0.3, 0.4),
    "reset all joints": lambda world, _: lambda: world.bodies[3].joints.reset([0.3, 0.4], 0.5),
    "place a base": lambda world, _: (
        lambda: world.bodies[1].set_inertial_pose((0.0, 0.0, 1.0), (0.0, 0.6, 0.0, 0.8))
    ),
    "aim a motor": lambda world, _: (
        lambda: world.bodies[3].joints.movable[0].set_position_target(0.3, velocity=0.2, max_force=3.0)
    ),
    "disable a motor": lambda world, _: world.bodies[3].joints.movable[0].free,
    "apply a force": _force,
    "colour": _colour,
    "load a texture": _texture,
    "change a texture": _other_texture,
    "switch a coupling off": _coupling,
    "stiffen a tendon": _tendon,
    "move nodes": _nodes,
    "place a cloth": _place_cloth,
    "spin a cloth": _spin_cloth,
    "absent": lambda world, _: lambda: setattr(world.bodies[2], "present", False),
}


def seen(world: World) -> tuple[Any, ...]:
    """All there is, to the last bit."""
    contacts = world.contact_arrays
    tables = (
        (world.arrays.model, world.arrays.used),
        (world.arrays.state, world.arrays.used),
        (contacts.shapes.table, {**contacts.shapes.used, "filter": contacts.shapes.filter_count}),
        (
            contacts.contacts,
            {"count": 1, "contact": contacts.contact_count, "overlap": contacts.overlap_count},
        ),
    )
    return (
        summary(world),
        [dict(body.rows.count) for body in world.bodies.values()],
        [body.all_dynamics and [repr(it) for it in body.all_dynamics] for body in world.bodies.values()],
        [(it.kind, it.joint, it.lower, it.upper, it.max_impulse) for it in world.joint_constraints.all],
        contacts.shapes.filters.all,
        [(it.id, it.value) for body in world.bodies for it in world.user_data.of_body(body.id)],
        [_rows(table, used) for table, used in tables],
    )


def _rows(table: ArrayTable, used: dict[str, int]) -> dict[str, bytes]:
    # Rows of constraints, and the order of sorting, are brought up to date before a step.
    return {
        name: (array[0] if table.is_per_world(name) else array)[: used[axis]].tobytes()
        for name, array in table.numpy.items()
        if (axis := name.partition("_")[0]) in used and axis not in ("constraint", "row")
    }


def summary(world: World) -> tuple[Any, ...]:
    """What can be compared at every line."""
    bodies = list(world.bodies.values())
    return (
        list(world.bodies.keys()),
        list(world.listing),
        [(body.first_link, dict(body.rows.first), body.position_index, body.fixed_base) for body in bodies],
        (world.free_ids, world.next_id, world.links_loaded, world.user_constraints.next_id, world.time),
        {axis: count for axis, count in world.arrays.used.items() if axis not in ("constraint", "row")},
        dict(world.contact_arrays.shapes.used),
        sorted(world.contact_arrays.shapes._bodies),
        [(it.body.id, it.joint, it.kind) for it in world.joint_constraints.all],
        world.joint_constraints.tags.links,
        list(world.user_constraints.rows),
        world.contact_arrays.contact_count,
        world.position[: world.arrays.used["position"]].tobytes(),
        world.link_pose[: world.arrays.used["link"]].tobytes(),
        [[(it.mass, it.lateral_friction) for it in body.all_dynamics] for body in bodies],
        [(body.spec.actuators, body.spec.sites, body.spec.sensors, body.spec.keyframes) for body in bodies],
        repr(world.parameters),
        world.arrays.model.numpy["link_sensor"][: world.arrays.used["link"]].tobytes(),
        sorted(world.contact_arrays.soft.anchors),
        len(world.observers),
        [
            rows[: world.arrays.used["dof"]].tobytes()
            for rows in (world.motor, world.pd, world.link_force[: world.arrays.used["link"]])
        ],
        [(it.enabled, it.spring, it.range) for it in world.user_constraints.all],
        [_rows_of_nodes(world, name) for name in ("node_position", "node_velocity")],
        [repr(appearance_of(world)._looks.get(body)) for body in bodies],
        _textures(world),
    )


def _textures(world: World) -> tuple[Any, ...]:
    textures = appearance_of(world).textures
    images = [(number, image.tobytes()) for number, image in textures._images.items()]
    return textures.changes, textures._next, textures._next_hidden, images


def _rows_of_nodes(world: World, name: str) -> bytes:
    return world.arrays.state.numpy[name][0, : world.arrays.used["node"]].tobytes()


def at_lines(call: Callable[[], Any], at_line: Callable[[], None], *, again: bool = True) -> None:
    """Make a call, and another one at each line of ours: each time it is reached, or only the first time."""
    state = uninterrupted._State
    been: set[tuple[str, int]] = set()

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        file = frame.f_code.co_filename
        if not file.startswith(_OURS) or file == uninterrupted.__file__:
            return None
        if event == "line" and not enters_or_leaves_a_section(file, frame.f_lineno):
            place = file, frame.f_lineno
            if again or place not in been:
                been.add(place)
                at_line()
        return trace

    before, state.keeps_tracing = sys.gettrace(), True
    sys.settrace(trace)
    try:
        call()
    finally:
        sys.settrace(before)
        state.keeps_tracing = False


@pytest.mark.parametrize("name", few(CHANGES, 6))
def test_whoever_looks_at_any_line_sees_before_or_after(name: str, tmp_path: Path) -> None:
    # Modules and files are known the second time.
    world = made()
    call = CHANGES[name](world, tmp_path)
    # Textures are counted from the first look on.
    summary(world)
    call()
    after = summary(world)
    world = made()
    call = CHANGES[name](world, tmp_path)
    before = summary(world)
    assert before != after
    found: list[tuple[Any, ...]] = []

    def look() -> None:
        now = summary(world)
        if not found or found[-1] != now:
            found.append(now)

    at_lines(call, look)
    look()
    assert len(found) == 2
    assert found == [before, after]


@pytest.mark.parametrize("name", few(CHANGES, 8))
def test_an_exception_at_any_line_leaves_everything_as_it_was(name: str, tmp_path: Path) -> None:
    world = made()
    call = CHANGES[name](world, tmp_path)
    # Textures are counted from the first look on.
    seen(world)
    call()
    after = seen(world)
    world = made()
    call = CHANGES[name](world, tmp_path)
    before = seen(world)

    def blow() -> None:
        nonlocal left
        left -= 1
        if left == 0:
            raise Fault

    counted = 0

    def count() -> None:
        nonlocal counted
        counted += 1

    at_lines(CHANGES[name](made(), tmp_path), count)
    not_made = 0
    # Every line of short calls.
    for place in range(1, counted + 1, 1 + counted // _TRIED):
        left = place
        try:
            at_lines(call, blow)
        except Fault:
            now = seen(world)
            if now == before:
                not_made += 1
                continue
            # After the change has been made.
            assert now == after
        else:
            assert seen(world) == after
        break
    assert not_made
