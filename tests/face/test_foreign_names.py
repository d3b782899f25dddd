"""First lines that people write who come from other simulators, and what they are told."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

import carom
from carom import World, Worlds
from carom.examples import robot_file
from carom.foreign_names import FOREIGN
from carom.suggestions import suggestion

from .scene import made


def told_of(line: str) -> str:
    """The suggestion for a line that fails."""
    world, arm, box = made()
    known: dict[str, Any] = {"carom": carom, "world": world, "arm": arm, "box": box, "np": np}
    known |= {"worlds": Worlds(world, 2), "scene": World().load("<mujoco/>"), "camera": None}
    known["camera"] = carom.Camera.with_field_of_view(8, 6, 45)
    known["arms"] = known["worlds"][arm]
    known["description"] = carom.read(robot_file("hand.xml"))
    with pytest.raises((AttributeError, TypeError)) as told:
        exec(line, known)
    return str(suggestion(told.value))


@pytest.mark.parametrize(
    ("line", "meant"),
    [
        # MuJoCo
        ("carom.MjModel.from_xml_path('a.xml')", "Here: world = carom.World(); scene = world.load(file)"),
        ("carom.mj_step(world, world)", "Here: world.step"),
        ("carom.mj_kinematics(world, world)", "Here: `python -m carom docs from-mujoco`"),
        ("carom.World.from_xml_path('a.xml')", "Here: world = carom.World()"),
        ("carom.viewer.launch_passive(world)", "Here: world.view()"),
        ("world.body('hand').xpos", "Here: world['name'], a body"),
        ("world.keyframes", "Here: scene.keyframes"),
        ("world.nv", "Here: len(state.velocity)"),
        ("scene.step()", "Here: that is of the world"),
        ("arm.actuators['bend'].ctrl", "Here: control"),
        ("arm.actuators['bend'].ctrl = 1", "Here: control"),
        ("arms.actuators['bend'].ctrl", "Here: control"),
        ("arm.shapes[0].rgba", "Here: colour"),
        ("description.worldbody", "Here: bodies['name']"),
        ("description.bodies['palm'].add_site(name='x')", "Here: add('site'"),
        ("description.bodies['palm'].pos", "Here: part['pos']"),
        # Genesis
        ("carom.init(backend='cpu')", "Here: not needed"),
        ("carom.Scene(show_viewer=False)", "Here: world = carom.World()"),
        ("scene.add_entity('x')", "Here: load"),
        ("scene.build(n_envs=4)", "Here: not needed"),
        ("world.add_camera(res=(8, 6))", "Here: carom.Camera.with_field_of_view"),
        ("carom.Camera(res=(8, 6), fov=40)", "Here: carom.Camera.with_field_of_view"),
        ("carom.Camera(8, 6)", "Here: carom.Camera.with_field_of_view"),
        ("camera.render()", "Here: capture()"),
        ("arm.get_link('hand')", "Here: links['name']"),
        ("arm.set_dofs_kv([1, 1])", "Here: joints.servo"),
        ("worlds.step(envs_idx=[0])", "Did you mean 'where'?"),
        ("box.friction", "Here: shapes['name'].friction"),
        # PyBullet
        ("world.loadURDF('plane.urdf')", "Here: load"),
        ("world.getJointState(0, 0)", "Here: world['body'].joints['name'].position"),
        ("world.setTimeStep(0.01)", "Here: time_step"),
        ("carom.connect(1)", "Here: not needed: begin with world = carom.World()"),
        ("world.load_urdf('plane.urdf', useFixedBase=True)", "Did you mean 'fixed_base'?"),
        ("world.load_urdf('plane.urdf', globalScaling=2)", "Did you mean 'scale'?"),
        # Guesses
        ("world.bodies('arm')", "Square brackets take one: world.bodies['name']"),
        ("arm.joints('elbow')", "Square brackets take one or more: body.joints['elbow']"),
        ("arm.joints[:1].servo([0], kp=1, kv=1)", "Did you mean 'kd'?"),
        ("arm.inverse_kinematics('hand', (1, 0, 0), quat=(0, 0, 0, 1))", "Did you mean 'orientations'?"),
        ("world.add_box((1, 1, 1), pos=(0, 0, 1))", "Did you mean 'position'?"),
        ("carom.Worlds(1024)", "Here: carom.Worlds(world, count)"),
        ("world.step(1.0)", "Here: world.step(count)"),
        ("world.step(dt=0.1)", "Here: world.step(count)"),
        ("carom.LQR", "Here: carom.controllers.LQR"),
    ],
)
def test_first_lines_of_other_simulators_are_answered(line: str, meant: str) -> None:
    assert told_of(line).startswith(meant)


def test_errors_say_what_to_write_instead() -> None:
    world, arm, box = made()
    worlds = Worlds(world, 2)
    for wrong, kind, message in (
        (lambda: World("robot.xml"), TypeError, r"world = carom.World\(\); world.load\(file\)"),  # type: ignore[arg-type]
        (lambda: worlds.reset([0]), TypeError, "where= says which worlds"),  # type: ignore[arg-type]
        (lambda: setattr(box, "velocity", 1), ValueError, "a linear and an angular velocity"),
        (lambda: setattr(worlds[box], "velocity", 1), ValueError, "a linear and an angular velocity"),
        (
            lambda: box.change_dynamics(-1, friction=1),
            AttributeError,
            "'friction'; those .* lateral_friction",
        ),
        (lambda: box.links[0], IndexError, "-1 is the base"),
        (lambda: arm.inverse_kinematics("hand", [(1, 0, 0)]), ValueError, r"a Pose or a position \(3,\)"),
        (lambda: arm.inverse_kinematics(["hand"], (1, 0, 0)), ValueError, "must be a Pose or"),
    ):
        with pytest.raises(kind, match=message):
            wrong()


def test_names_that_are_said_to_be_here_are_here() -> None:
    world, arm, box = made()
    worlds = Worlds(world, 2)
    arms = worlds[arm]
    things: dict[str, Any] = {
        "World": world,
        "Worlds": worlds,
        "Body": arm,
        "BodyBatch": arms,
        "Joint": arm.joints["elbow"],
        "JointBatch": arms.joints["elbow"],
        "Joints": arm.joints,
        "JointGroup": arm.joints[:1],
        "JointGroupBatch": arms.joints,
        "Link": arm.links["hand"],
        "LinkBatch": arms.links["hand"],
        "BodyActuator": arm.actuators["bend"],
        "ActuatorBatch": arms.actuators["bend"],
        "BodyShape": arm.shapes["upper"],
        "ShapeBatch": arms.shapes["upper"],
        "Scene": World().load("<mujoco/>"),
        "Camera": carom.Camera.with_field_of_view(8, 6, 45),
        "CameraImage": world.image(carom.Camera.with_field_of_view(8, 6, 45)),
        "Description": carom.read(robot_file("hand.xml")),
        "Contact": world.contacts(box, now=True)[0] if world.contacts(box, now=True) else None,
    }
    wrong: list[str] = []
    for kind, names in FOREIGN.items():
        it = things.get(kind)
        for name, meant in names.items():
            if (
                it is None
                or " of " in meant
                or not (begins := re.match(r"[a-z_]+(?=$|[.(\[,]| and )", meant))
            ):
                continue
            if begins[0] not in (
                "not",
                "world",
                "worlds",
                "body",
                "scene",
                "carom",
                "extract",
                "len",
            ) and not hasattr(it, begins[0]):
                wrong.append(f"{kind}.{name}: {meant}")
            assert not hasattr(it, name) or name in dir(type(it)), f"{kind} has {name}"
    assert not wrong, chr(10).join(wrong)


def test_a_method_is_not_replaced_by_a_number(monkeypatch: pytest.MonkeyPatch) -> None:
    world, arm, _ = made()
    worlds = Worlds(world, 2)
    for it, name in ((world, "contacts"), (world, "step"), (worlds, "contacts"), (arm, "set_pose")):
        with pytest.raises(AttributeError, match=rf"\.{name} is a method, which is called: {name}\(\.\.\.\)"):
            setattr(it, name, 3)
    # Tests replace methods by functions, and whoever derives a class may do as they like.
    with monkeypatch.context() as patch:
        patch.setattr(world, "contacts", lambda: ["mine"])
        assert world.contacts() == ["mine"]  # type: ignore[comparison-overlap]
    assert world.contacts() == []

    class Own(World):
        pass

    own: Any = Own()
    own.contacts = 3
    assert own.contacts == 3


def test_bodies_of_a_world_are_iterated_as_those_of_many() -> None:
    world, arm, box = made()
    assert list(world.bodies) == [world[0], arm, box] == list(world) == [*world.bodies.values()]
    assert [body.name for body in world.bodies] == [body.name for body in Worlds(world, 2).bodies]
    assert arm in world.bodies and "arm" in world.bodies and arm.id in world.bodies
    assert "leg" not in world.bodies and 7 not in world.bodies
    assert list(world.bodies.keys()) == [0, arm.id, box.id]
    assert world.bodies["arm"] is world.bodies[arm.id] is world.bodies[arm] is arm
    for body in world.bodies:
        world.remove(body)
    assert len(world.bodies) == 0


def test_images_take_a_list_of_poses() -> None:
    world, _, box = made()
    worlds = Worlds(world, 2)
    camera = carom.Camera.with_field_of_view(16, 12, 60)
    poses = [camera.look_at(eye, (1, 0, 0.5)).pose for eye in ((1.8, 0, 0.8), (1, 0.8, 0.8))]
    images = worlds.images(camera, poses=poses)
    stacked = carom.Pose(np.array([it.position for it in poses]), np.array([it.orientation for it in poses]))
    assert np.array_equal(images.colour, worlds.images(camera, poses=stacked).colour)
    assert (images.body_ids == box.id).any(axis=(1, 2)).all()
