"""One vocabulary for one world and for many: what a `World` and its parts have, `Worlds` and theirs have."""

from __future__ import annotations

import copy
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import pytest
from tests.face.scene import made

import carom
from carom import World, Worlds
from carom.internal_names import INTERNAL
from carom.suggestions import suggestion

# What makes sense of one world only: loading, building, looking at it, and the flat arrays of its state.
_OF_ONE = {
    "World": {
        *("load_urdf", "load_cloth", "load_rope", "load_soft_solid"),
        *("add_box", "add_capsule", "add_cylinder", "add_heightfield", "add_mesh", "add_plane", "add_sphere"),
        *("remove", "clear", "constrain", "copy", "record", "image", "inverse_dynamics"),
    },
    "Body": {
        *("add_actuator", "add_keyframe", "add_sensor", "add_site", "add_tendon", "reset", "world"),
    },
    "BodyTendon": {"remove"},
}
_BODY = {"body"}
# What makes sense of many only.
_OF_MANY = {
    "Worlds": {
        *("count", "device", "halted", "checkpoint", "resume", "extract", "images"),
        *("contact_forces", "contact_list", "links_in_contact", "sensor_seeds"),
    },
    # Soft bodies have nodes in one world, too.
    "BodyBatch": {"algorithms", "set_present", "nodes", "node_forces", "node_velocities"},
    "TendonBatch": {"enable"},
}

PARTS: dict[str, Callable[[Any], Any]] = {
    "body": lambda body: body,
    "joints": lambda body: body.joints,
    "joint": lambda body: body.joints["elbow"],
    "group": lambda body: body.joints[:1],
    "links": lambda body: body.links,
    "link group": lambda body: body.links[:1],
    "link": lambda body: body.links["hand"],
    "shapes": lambda body: body.shapes,
    "shape": lambda body: body.shapes["lower"],
    "actuators": lambda body: body.actuators,
    "actuator": lambda body: body.actuators["bend"],
    "sensors": lambda body: body.sensors,
    "sensor": lambda body: body.sensors["rate"],
    "tendons": lambda body: body.tendons,
    "tendon": lambda body: body.tendons["cord"],
    "sites": lambda body: body.sites,
    "site": lambda body: body.sites["tip"],
}


def names(it: object) -> set[str]:
    return {name for name in dir(it) if name[0] != "_"}


def compare(one: object, many: object) -> None:
    of_one = names(one) - _OF_ONE.get(type(one).__name__, set()) - _BODY
    of_many = names(many) - _OF_MANY.get(type(many).__name__, set())
    if type(one).__name__ == "Joint":
        # Spherical joints are set by their coordinates.
        of_one -= {"set_orientation_target"}
    assert of_one == of_many


@pytest.mark.parametrize("part", PARTS)
def test_parts_of_a_body_have_the_same_names(part: str) -> None:
    world, arm, _ = made()
    compare(PARTS[part](arm), PARTS[part](Worlds(world, 2)[arm]))


def test_worlds_have_the_names_of_a_world() -> None:
    world, _, _ = made()
    compare(world, Worlds(world, 2))


def test_nine_of_ten_names_are_the_same() -> None:
    """Of what many worlds have, and all parts of a body in them."""
    world, arm, _ = made()
    worlds = Worlds(world, 2)
    pairs = [(world, worlds), *((find(arm), find(worlds[arm])) for find in PARTS.values())]
    shared = sum(len(names(one) & names(many)) for one, many in pairs)
    assert shared >= 0.93 * sum(len(names(many)) for _, many in pairs)


def test_internals_are_not_listed() -> None:
    world, arm, _ = made()
    assert names(world).isdisjoint(INTERNAL["World"])
    assert names(arm).isdisjoint(INTERNAL["Body"])
    assert len(names(World)) <= 47
    assert len(names(world)) <= 50
    assert len(names(arm)) <= 40
    # They are there all the same.
    assert world.quick is not None


def test_what_is_misspelt_is_answered_with_a_public_name() -> None:
    world, arm, _ = made()
    with pytest.raises(AttributeError, match="did you mean 'positions'"):
        Worlds(world, 2)[arm].joints.positons = 0.0  # type: ignore[attr-defined]
    assert isinstance(carom.Pose, type)
    assert "Pose" in dir(carom)
    assert World is carom.World


@pytest.mark.parametrize(
    ("find", "name", "meant"),
    [
        (lambda world, arm: arm, "mass", "body.change_dynamics(link, mass=kilograms)"),
        (lambda world, arm: arm.links["hand"], "pose", "body.pose of the base, and body.joints.positions"),
        (lambda world, arm: arm.joints["elbow"], "motor_torque", "torque"),
        (lambda world, arm: arm.joints, "effort_limits", "max_forces= of servo"),
        (lambda world, arm: Worlds(world, 2), "solver", "the same of the world, before Worlds(world, count)"),
        (lambda world, arm: Worlds(world, 2)[arm].links[0], "mass", "body.change_dynamics(link, mass="),
        (
            lambda world, arm: Worlds(world, 2)[arm].tendons[0],
            "damping",
            "the same of the tendon in the world",
        ),
    ],
)
def test_what_can_only_be_read_is_answered_with_what_sets_it(find: Any, name: str, meant: str) -> None:
    world, arm, _ = made()
    with pytest.raises(AttributeError) as told:
        setattr(find(world, arm), name, 1.0)
    if "has no setter" in str(told.value):
        # Python 3.10 doesn't say of what.
        assert str(suggestion(told.value)).startswith(f"It is set by {meant}")


@pytest.mark.parametrize(
    ("find", "name", "meant"),
    [
        (lambda world, arm: world, "timestep", "time_step"),
        (lambda world, arm: Worlds(world, 2), "set_gravity", "gravity, or change_parameters(gravity="),
        (lambda world, arm: world, "add_entity", "load, or add_box"),
        (lambda world, arm: Worlds(world, 2), "times", "time"),
        (lambda world, arm: arm, "qpos", "joints.positions"),
        (lambda world, arm: Worlds(world, 2)[arm], "joint_positions", "joints.positions"),
        (lambda world, arm: arm.joints["elbow"], "frictionloss", "friction_loss"),
        (lambda world, arm: arm.joints[:1], "position", "positions"),
        (lambda world, arm: arm.links["hand"], "xpos", "pose.position"),
    ],
)
def test_names_of_other_simulators_are_answered(find: Any, name: str, meant: str) -> None:
    world, arm, _ = made()
    it = find(world, arm)
    with pytest.raises(AttributeError, match=f"no attribute '{name}'") as told:
        getattr(it, name)
    assert str(suggestion(told.value)).startswith(f"Here: {meant}")
    with pytest.raises(AttributeError):
        setattr(it, name, 0.0)
    assert not hasattr(it, "_nothing")


def test_what_is_nearly_right_is_answered_and_errors_of_properties_stay() -> None:
    world, arm, _ = made()
    for it, wrong, right in ((world, "gravty", "gravity"), (arm.joints["elbow"], "velocty", "velocity")):
        with pytest.raises(AttributeError) as told:
            getattr(it, wrong)
        assert suggestion(told.value) == f"Did you mean {right!r}?"
    with pytest.raises(AttributeError, match=r"world\.contacts\(\)"):
        world.queries().contacts  # noqa: B018
    assert copy.copy(arm.links["hand"]).name == "hand"
    assert copy.deepcopy(world)["arm"].joints.names == arm.joints.names


def test_what_is_meant_is_printed_below_the_error_that_ends_a_script() -> None:
    for line, said in (
        ("world.timestep", "Here: time_step."),
        ("world.load('franka_panda/panda.urdf').joints", "Here: that is of a body"),
        ("world.gravty", "Did you mean: 'gravity'?"),
    ):
        script = f"import carom; world = carom.World(); {line}"
        ended = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
        assert ended.returncode == 1
        assert said in ended.stderr
        assert ended.stderr.lower().count("did you mean") <= 1


def test_attributes_that_are_there_are_found_at_once() -> None:
    """With a `__getattr__`, all attributes of a class take longer, also those that are there."""
    world, arm, _ = made()
    worlds = Worlds(world, 2)
    parts = (arm.joints["elbow"], arm.joints[:1], arm.links["hand"], arm.shapes["lower"])
    batches = (worlds[arm].joints["elbow"], worlds[arm].links["hand"], worlds[arm].actuators["bend"])
    for it in (world, arm, worlds, worlds[arm], *parts, *batches):
        assert not hasattr(type(it), "__getattr__")


def test_negative_numbers_count_from_the_end_but_of_links() -> None:
    world = World()
    arm = world.load_urdf("kuka_iiwa/model.urdf", fixed_base=True)
    assert arm.joints[-1] == arm.joints[6]
    assert arm.joints[-7] == arm.joints[0]
    assert arm.links[-1] == arm.base
    for sequence, number in ((arm.joints, -8), (arm.joints, 7), (arm.links, -2)):
        with pytest.raises(IndexError, match=f"{number} is out of range"):
            sequence[number]
    joints = Worlds(world, 2)[arm].joints
    assert joints[-1].name == arm.joints[6].name


def test_names_of_movable_joints_are_those_of_the_arrays() -> None:
    world = World()
    arm = world.load_urdf("franka_panda/panda.urdf", fixed_base=True)
    assert len(arm.joints) > len(arm.joints.movable) == len(arm.joints.positions) == 9
    arm.joints["panda_finger_joint2"].position = 0.03
    assert (
        dict(zip(arm.joints.movable.names, arm.joints.positions, strict=True))["panda_finger_joint2"] == 0.03
    )
    arm.joints.movable[:2].positions = [0.1, 0.1]
    assert arm.joints.positions[:3].tolist() == [0.1, 0.1, 0.0]
    many = Worlds(world, 2)[arm].joints.movable
    assert many.names == arm.joints.movable.names
    assert many.positions.shape == (2, 9)
