"""What Carom makes of MJCF files beside the answers of `ask_mujoco.py`.

    python ask_carom.py ANSWERS ERRORS [--whole]

A line of ERRORS has the errors of one file, by question, as JSON. Contacts, limits, dry friction and equality
constraints are off, unless the whole file is asked about: then only the rollout with everything is compared.
Files that are in ERRORS already are left out, so it can be run again after a crash.
"""

from __future__ import annotations

import argparse
import json
import logging
import re
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

from carom import World, algorithms
from carom.description.keyframe import BodyKeyframe
from carom.description.pose import Pose
from carom.description.transform import compose, inverse, rotation_matrix
from carom.formats.mjcf.compiled import option
from carom.formats.mjcf.compiled.actuation.hanging import SLIDES, TURN
from carom.scene.body import Body
from carom.scene.joint import Joint
from carom.scene.soft_body import SoftBody
from carom.world.scene import Scene

FREE, BALL = 0, 1
COUNTS = {FREE: (7, 6), BALL: (4, 3)}
_ORIGIN = (0.0, 0.0, 0.0)
LEAST = {"poses": 1e-3, "matrix": 1e-9, "bias": 1e-3, "acceleration": 1e-2, "forces": 1e-3, "sensors": 1e-3}
"""Greatest values of a file less than these count as these: errors are relative to the greatest value."""
STEP = 1e-8
ROUNDINGS = 4.0
"""How many roundings of velocities MuJoCo's accelerations have, over `STEP`."""
LONGER, SUSPECT = 100.0, 1e-7
"""How much longer steps are by which accelerations are asked again whose error is greater than this."""
OFF = ("contact", "limit", "frictionloss", "equality")
# Sensors that tell what constraints do, or of which MuJoCo 4.0 gives nothing to compare with.
NOT_COMPARED = ("touch", "contact", "tactile")
QUATERNIONS = ("ballquat", "framequat")
"""Sensors of quaternions, of which MuJoCo has the scalar first."""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("answers", type=Path)
    parser.add_argument("errors", type=Path)
    parser.add_argument("--whole", action="store_true")
    parser.add_argument(
        "--contact", default="compliant", help="the law of contacts of rollouts (%(default)s)"
    )
    arguments = parser.parse_args()
    logging.disable(logging.WARNING)
    if not arguments.whole:
        option.DEFAULTS |= {f"flag.{name}": False for name in OFF}
    done = arguments.errors.read_text().splitlines() if arguments.errors.exists() else []
    known = {json.loads(line)["file"] for line in done}
    for line in arguments.answers.read_text().splitlines():
        answer = json.loads(line)
        if answer["file"] in known or "error" in answer:
            continue
        begin = time.process_time()
        with arguments.errors.open("a") as out:
            place = out.tell()
            out.write(json.dumps({"file": answer["file"], "crash": "Carom crashed"}) + "\n")
        try:
            found = compared(answer, whole=arguments.whole, law=arguments.contact)
        except Exception as error:
            found = {
                "crash": f"{type(error).__name__}: {str(error).splitlines()[0] if str(error) else ''}"[:300]
            }
        found |= {"file": answer["file"], "seconds": time.process_time() - begin}
        with arguments.errors.open("r+") as out:
            out.truncate(place)
            out.seek(place)
            out.write(json.dumps(found) + "\n")


def compared(answer: dict[str, Any], *, whole: bool, law: str = "compliant") -> dict[str, Any]:
    """The errors of a file by question, and what Carom says that it leaves out."""
    with World(contact=law) as world:
        begin = time.process_time()
        scene = world.load(answer["file"])
        found: dict[str, Any] = {"load_seconds": time.process_time() - begin}
        found["ignored"] = sorted(
            {f"{it.element}: {it.consequence}: {it.reason}" for it in scene.ignored.that_matter}
        )
        scene.apply_options()
        model = Model(scene, answer)
        if whole:
            if "rollout" in answer and model.is_equal:
                found["rollout"] = rolled_out(model, answer, "rollout", law)
            return found
        found["structure"] = float(not (model.is_equal or model.has_all_nodes))
        found["total mass"] = relative([total_mass(scene, answer) - answer["total"]], [answer["total"]], 1e-9)
        found["masses"] = relative(*masses(model, answer), 1e-9)
        found["reference"] = relative(*model.poses(answer["poses"]), LEAST["poses"])
        if "states" not in answer or not model.is_equal:
            return found
        for number, state in enumerate(answer["states"]):
            for name, error in in_state(model, state, number).items():
                found[name] = max(found.get(name, 0.0), error)
        found["rollout alone"] = rolled_out(model, answer, "alone", law)
    return found


class Model:
    """A scene beside MuJoCo's model: bodies by name, joints in the order of the file."""

    def __init__(self, scene: Scene, answer: dict[str, Any]) -> None:
        self.scene = scene
        self.links = {link.name: link for body in reversed(scene.bodies) for link in body.links}
        kinds = {name: body for body, name in ((body, body.name) for body in scene.bodies)}
        stated = answer["joints"]
        found: list[tuple[Body, Joint | None]] = []
        for body in scene.bodies:
            if not body.fixed_base:
                found.append((body, None))
            # Of a free body that hangs from the world the ball stands for its free joint.
            found += [(body, it) for it in body.joints.movable if not it.name.endswith(SLIDES)]
        self.joints = in_order_of(found, stated, answer["bodies"])
        named = [name for name in answer["bodies"] if name]
        self.is_equal = (
            len(stated) == len(self.joints)
            and all(name in self.links for name in named)
            and all(
                (kind == FREE) == is_free(joint)
                for (_, kind), (_, joint) in zip(stated, self.joints, strict=True)
            )
            and all(
                joint is None or is_free(joint) or not name or joint.name == name
                for (name, _), (_, joint) in zip(stated, self.joints, strict=True)
            )
            and len(kinds) == len(scene.bodies)
        )
        # Nodes of flexes are bodies with three sliders in MuJoCo, which states are not asked of here.
        nodes = {
            f"{body.name}_{node}"
            for body in scene.bodies
            if isinstance(body, SoftBody)
            for node in free_nodes(body, answer)
        }
        self.has_all_nodes = (
            bool(nodes)
            and len(stated) == len(self.joints) + 3 * len(nodes)
            and all(name in self.links or name in nodes for name in named)
            and nodes <= set(named)
        )
        self.answer = answer
        # Reference poses of free bodies that hang from the world, by the names of their balls.
        self.rests = {
            joint.name: self.links[joint.name.removesuffix(TURN)].pose
            for _, joint in self.joints
            if joint is not None and is_free(joint)
        }
        # Names of actuators as Carom has them, which makes some up.
        self.actuators = [name for name, _ in answer["actuators"]]
        if len(scene.actuators) == len(self.actuators):
            self.actuators = list(scene.actuators)

    def set(self, name: str, qpos: list[float], qvel: list[float], ctrl: list[float]) -> None:
        """Put the scene into a state as MuJoCo states it."""
        parts: dict[str, dict[str, Any]] = {
            body.name: {"positions": {}, "velocities": {}} for body in self.scene.bodies
        }
        q = v = 0
        for (_, kind), (body, joint) in zip(self.answer["joints"], self.joints, strict=True):
            positions, velocities = COUNTS.get(kind, (1, 1))
            own, rates = qpos[q : q + positions], qvel[v : v + velocities]
            q, v = q + positions, v + velocities
            part = parts[body.name]
            if kind == FREE and joint is not None:
                rest = self.rests[joint.name]
                turn = Pose(_ORIGIN, (own[4], own[5], own[6], own[3]))
                x, y, z, w = rest.orientation
                pose = compose(inverse(Pose(_ORIGIN, (x, y, z, w))), turn)
                slides = [own[axis] - rest.position[axis] for axis in range(3)]
                for axis in range(3):
                    part["positions"][joint.index - 3 + axis] = slides[axis : axis + 1]
                    part["velocities"][joint.index - 3 + axis] = rates[axis : axis + 1]
                part["positions"][joint.index] = list(pose.orientation)
                part["velocities"][joint.index] = rates[3:]
            elif joint is None:
                pose = Pose((own[0], own[1], own[2]), (own[4], own[5], own[6], own[3]))
                turn = np.array(rotation_matrix(pose.orientation))
                part |= {"pose": pose, "linear_velocity": tuple(rates[:3])}
                part["angular_velocity"] = tuple((turn @ rates[3:]).tolist())
            else:
                part["positions"][joint.index] = [*own[1:], own[0]] if kind == BALL else own
                part["velocities"][joint.index] = rates
        controls = dict(zip(self.actuators, ctrl, strict=True))
        for body in self.scene.bodies:
            part = parts[body.name]
            values = tuple(controls.get(it.name, 0.0) for it in body.actuators)
            body.add_keyframe(
                BodyKeyframe(
                    name,
                    pose=part.get("pose"),
                    linear_velocity=part.get("linear_velocity"),
                    angular_velocity=part.get("angular_velocity"),
                    positions=by_index(part["positions"]),
                    velocities=by_index(part["velocities"]),
                    controls=values or None,
                )
            )
        self.scene.reset(name)

    def poses(self, answer: list[list[float]]) -> tuple[list[float], list[float]]:
        """Errors of poses of the bodies that have names, and MuJoCo's positions."""
        errors, sizes = [0.0], [0.0]
        for name, numbers in zip(self.answer["bodies"], answer, strict=True):
            if name in self.links:
                pose = self.links[name].pose
                errors += [a - b for a, b in zip(pose.position, numbers[:3], strict=True)]
                turn = np.reshape(rotation_matrix(tuple(pose.orientation)), 9)
                errors += (turn - numbers[3:]).tolist()
                sizes += numbers[:3]
        return errors, sizes


def is_free(joint: Joint | None) -> bool:
    """Whether a joint stands for a free one: it is None for a free base, or the ball of a hanging body."""
    return joint is None or joint.name.endswith(TURN)


def in_order_of(
    found: list[tuple[Body, Joint | None]], stated: list[list[Any]], bodies: list[str]
) -> list[tuple[Body, Joint | None]]:
    """Joints in the order of the file, as MuJoCo states them; robots of tied bodies come in another one."""
    places = {name: place for place, (name, _) in enumerate(stated) if name}
    free = iter([place for place, (_, kind) in enumerate(stated) if kind == FREE])
    numbers = {name: number for number, name in enumerate(bodies) if name}

    def of_body(each: tuple[Body, Joint | None]) -> int:
        body, joint = each
        name = body.name if joint is None else joint.name.removesuffix(TURN)
        # Names that are made up have the number of the body.
        return numbers[name] if name in numbers else number_in(name, "link")

    of_free = [
        (next(free, len(stated)), it) for it in sorted((it for it in found if is_free(it[1])), key=of_body)
    ]
    others = [
        (places.get(joint.name, number_in(joint.name, "joint")), (body, joint))
        for body, joint in found
        if joint is not None and not is_free(joint)
    ]
    return [it for _, it in sorted([*of_free, *others], key=lambda each: each[0])]


def number_in(name: str, before: str) -> int:
    """The number in a name that is made up, as `joint3_7`; that of the last place of other names."""
    found = re.match(rf"{before}(\d+)_", name)
    return int(found[1]) if found else sys.maxsize


def by_index(values: dict[int, list[float]]) -> tuple[float, ...]:
    """Numbers of joints in the order of their indices."""
    return tuple(number for index in sorted(values) for number in values[index])


def total_mass(scene: Scene, answer: dict[str, Any]) -> float:
    """Mass of all links that can move."""
    total = 0.0
    for body in scene.bodies:
        moving = {-1} if not body.fixed_base else set()
        for index, link in enumerate(body.spec.links):
            if link.parent in moving or body.velocity_count[index]:
                moving.add(index)
        if isinstance(body, SoftBody):
            total += float(body.soft_spec.masses[free_nodes(body, answer)].sum())
            continue
        total += sum(body.dynamics(link).mass for link in moving)
    return total


def free_nodes(body: SoftBody, answer: dict[str, Any]) -> list[int]:
    """Nodes that are bodies in MuJoCo, where neither the world nor a body has them as part of itself."""
    known = {*answer["bodies"]}
    return [node for node in range(len(body.nodes)) if f"{body.name}_{node}" in known]


def masses(model: Model, answer: dict[str, Any]) -> tuple[list[float], list[float]]:
    """Errors of masses of the bodies that have names and move, and MuJoCo's masses."""
    stated = zip(answer["bodies"], answer["masses"], answer["moves"], strict=True)
    known = [(model.links[name].mass, mass) for name, mass, moves in stated if moves and name in model.links]
    return [a - b for a, b in known] or [0.0], [mass for _, mass in known] or [1.0]


def relative(errors: Any, values: Any, least: float) -> float:
    """The greatest error over the greatest value."""
    greatest = float(np.abs(errors).max(initial=0.0)) / max(float(np.abs(values).max(initial=0.0)), least)
    return greatest if np.isfinite(greatest) else 1e9


def in_state(model: Model, state: dict[str, Any], number: int) -> dict[str, float]:
    """The errors of what follows from a state."""
    scene, found = model.scene, {}
    world = scene.world
    # In so short a step all changes of velocity are less than the residual at which solvers usually end.
    world.parameters.solver_residual_threshold = 0.0
    model.set(f"asked {number}", state["qpos"], state["qvel"], state["ctrl"])
    found["poses"] = relative(*model.poses(state["poses"]), LEAST["poses"])
    matrix, bias = dynamics_of(model, np.array(state["qvel"]))
    wanted = np.array(state["matrix"])
    found["mass matrix"] = relative(matrix - wanted, wanted, LEAST["matrix"])
    found["bias"] = relative(bias - state["bias"], state["bias"], LEAST["bias"])
    wanted = np.array(state["acceleration"])
    rates, found_forces = accelerated(model, number, STEP)
    fastest = max(1.0, *(abs(it) for it in state["qvel"]))
    rounding = ROUNDINGS * float(np.finfo(np.float64).eps) * fastest / STEP

    def off(found: np.ndarray) -> float:
        errors = np.maximum(np.abs(found - wanted) - rounding, 0.0)
        return relative(errors, wanted, LEAST["acceleration"])

    found["acceleration"] = off(rates)
    if found["acceleration"] > SUSPECT:
        # Velocities are rounded, and longer steps tell less of that, but more of what changes within them.
        others, _ = accelerated(model, number, LONGER * STEP)
        found["acceleration"] = min(off(others), found["acceleration"])
        accelerated(model, number, STEP)
    driven = list(zip(model.actuators, state["forces"], strict=True))
    driven = [(name, value) for name, value in driven if name in scene.actuators]
    if driven:
        values = np.array([value for _, value in driven])
        of_first, of_second = (np.array([each[name] for name, _ in driven]) for each in found_forces)
        # MuJoCo's answer of those that act early is after a step, and not extrapolated.
        early = [scene.actuators[name].spec.acts_early for name, _ in driven]
        forces = np.where(early, of_first, 2.0 * of_second - of_first)
        found["forces of actuators"] = relative(forces - values, values, LEAST["forces"])
    of_sensors: list[float] = []
    sensors = scene.sensors
    for name, at, size, _ in model.answer["sensors"]:
        if name in sensors and (kind := sensors[name].spec.kind.value) not in NOT_COMPARED:
            values = np.array(state["sensors"][at : at + size])
            found_values = np.ravel(sensors[name].read())
            if kind in QUATERNIONS:
                # One of opposite sign is the same orientation.
                values = np.roll(values, -1) * np.copysign(1.0, np.roll(values, -1) @ found_values)
            of_sensors.append(relative(found_values - values, values, 1.0))
    if of_sensors:
        found["sensors"] = max(of_sensors)
    scene.apply_options()
    return found


def accelerated(model: Model, number: int, longest: float) -> tuple[np.ndarray, list[dict[str, float]]]:
    """Accelerations in a state by steps that tend to 0, and forces of actuators in steps of two lengths.

    The scene is left after the shorter one.
    """
    scene, world = model.scene, model.scene.world
    rates: list[np.ndarray] = []
    forces: list[dict[str, float]] = []
    for step in (longest, 0.5 * longest):
        scene.reset(f"asked {number}")
        before = motions(model)
        world.parameters.time_step = step
        # That of MuJoCo's answer has implicit damping, as this one.
        world.parameters.integrator = "discrete"
        world.apply_parameters()
        world.step()
        rates.append(changes(before, motions(model), step))
        forces.append({name: float(actuator.force) for name, actuator in scene.actuators.items()})
    return 2.0 * rates[1] - rates[0], forces


def motions(model: Model) -> list[tuple[np.ndarray, ...]]:
    """Of each joint its velocities as MuJoCo has them in `qvel`.

    Of a free base it is what they follow from: velocity of the centre of mass, angular velocity, rotation,
    and the way from there to the origin of its frame, all in axes of the world.
    """
    found: list[tuple[np.ndarray, ...]] = []
    for body, joint in model.joints:
        if joint is not None:
            slides = [body.joints[joint.index - 3 + axis] for axis in range(3)] if is_free(joint) else []
            found.append((np.array([*(float(it.velocity) for it in slides), *np.ravel(joint.rates)]),))
            continue
        base = body.links[-1]
        lever = np.array(base.pose.position) - np.array(base.inertial_pose.position)
        turn = np.array(rotation_matrix(tuple(base.pose.orientation)))
        found.append((np.array(base.velocity.linear), np.array(base.velocity.angular), turn, lever))
    return found


def changes(before: list[tuple[np.ndarray, ...]], after: list[tuple[np.ndarray, ...]], step: float) -> Any:
    """Rates of change of `qvel` between two `motions`.

    Those of free bases are found from as few differences as can be, whose roundings are divided by the step.
    """
    parts: list[np.ndarray] = []
    for old, new in zip(before, after, strict=True):
        linear, *angular = ((b - a) / step for a, b in zip(old[:2], new[:2], strict=True))
        if angular:
            _, omega, turn, lever = old
            linear = linear + np.cross(angular[0], lever) + np.cross(omega, np.cross(omega, lever))
            angular = [turn.T @ angular[0]]
        parts += [linear, *angular]
    return np.concatenate(parts)


def dynamics_of(model: Model, rates: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The mass matrix and the bias forces of all bodies, for MuJoCo's velocities."""
    count = len(rates)
    matrix, bias = np.zeros((count, count)), np.zeros(count)
    places = rows_of(model)
    for body in dict.fromkeys(body for body, _ in model.joints):
        dofs = sum(joint.degrees_of_freedom for joint in body.joints.movable) + (0 if body.fixed_base else 6)
        rows = places[body.name]
        own = rates[rows]
        positions = body.joints.positions
        change, added = np.eye(dofs), np.zeros(dofs)
        order = np.arange(dofs)
        if not body.fixed_base:
            base = body.links[-1]
            pose = base.inertial_pose
            turn = np.array(rotation_matrix(tuple(base.pose.orientation)))
            inertial = np.array(rotation_matrix(tuple(pose.orientation)))
            lever = np.array(pose.position) - np.array(base.pose.position)
            # Carom's velocities are change @ MuJoCo's, and their derivatives also have what is added.
            change[:6, :6] = 0.0
            change[:3, 3:6] = inertial.T @ turn
            change[3:6, :3] = inertial.T
            cross = np.array([[0, lever[2], -lever[1]], [-lever[2], 0, lever[0]], [lever[1], -lever[0], 0]])
            change[3:6, 3:6] = inertial.T @ cross @ turn
            omega = turn @ own[3:6]
            added[3:6] = inertial.T @ np.cross(omega, np.cross(omega, lever))
            order[:6] = (3, 4, 5, 0, 1, 2)
            positions = [*pose.position, *pose.orientation, *positions]
        # What the armature of tendons adds has functions of its own.
        of_tendons = algorithms.tendon_inertia(body, positions)
        mass = algorithms.mass_matrix(body, body.joints.positions) + of_tendons
        matrix[np.ix_(rows, rows)] = change.T @ mass @ change
        forces = np.asarray(algorithms.inverse_dynamics(body, positions, change @ own, added))[order]
        steady, speed = added.copy(), change @ own
        if not body.fixed_base:
            # That function is for derivatives of components, the one before for those of vectors.
            steady[3:6] -= np.cross(speed[:3], speed[3:6])
        forces += algorithms.tendon_bias_forces(body, positions, speed) + of_tendons @ steady
        bias[rows] = change.T @ forces
    return matrix, bias


def rows_of(model: Model) -> dict[str, list[int]]:
    """Where the velocities of each body are among those of MuJoCo, in the body's own order."""
    found: dict[str, dict[int, list[int]]] = {}
    first = 0
    for (_, kind), (body, joint) in zip(model.answer["joints"], model.joints, strict=True):
        count = COUNTS.get(kind, (1, 1))[1]
        index = -1 if joint is None else joint.index
        found.setdefault(body.name, {})[index] = list(range(first, first + count))
        first += count
    return {name: [row for index in sorted(rows) for row in rows[index]] for name, rows in found.items()}


def rolled_out(model: Model, answer: dict[str, Any], name: str, law: str) -> float | None:
    """Greatest error of a position after a second, over the greatest one; None if MuJoCo has no answer.

    `law` is that of contacts, see `World.contact`.
    """
    if answer[name] is None:
        return None
    with World(contact=law) as world:
        scene = world.load(answer["file"])
        scene.apply_options()
        if keys := scene.keyframes:
            key = next(iter(keys))
            scene.reset(key)
            for actuator in scene.actuators.values():
                if actuator.spec.dynamics:
                    actuator.activation = 0.0
        world.step(round(1.0 / answer["timestep"]))
        errors, sizes = Model(scene, answer).poses(answer[name])
    places = [error for i, error in enumerate(errors[1:]) if i % 12 < 3]
    return relative(places, sizes, LEAST["poses"])


if __name__ == "__main__":
    main()
