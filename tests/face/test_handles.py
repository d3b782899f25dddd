"""Parts are found by handles, slices and patterns, and several are set at once."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from tests.face.scene import made

from carom import Camera, Pose, World, Worlds


def both() -> list[tuple[Any, Any]]:
    """The arm and its world, lone and in two worlds."""
    world, arm, _ = made()
    worlds = Worlds(world, 2)
    return [(world, arm), (worlds, worlds[arm])]


def test_parts_are_found_by_handles_of_their_own_and_of_the_original_world() -> None:
    _, original, other = made()
    for _, arm in both():
        for parts, of in ((arm.joints, original.joints), (arm.links, original.links)):
            assert parts[parts[1]].name == of[1].name
            assert parts[of[1]].name == of[1].name
            assert parts[[of[0], of[1].name]].names == [of[0].name, of[1].name]
        for kind in ("shapes", "actuators", "sensors", "sites", "tendons"):
            own = getattr(arm, kind)
            assert own[own[0]].name == own[getattr(original, kind)[0]].name == own.names[0]
        with pytest.raises(KeyError, match="is not among these; there are world, arm, hand"):
            arm.links[other.base]
        with pytest.raises(TypeError, match=r"an actuator is found by its number, its name or its handle"):
            arm.actuators[1.5]


def test_several_parts_without_arrays_of_their_own_are_a_list() -> None:
    for _, arm in both():
        assert [it.name for it in arm.shapes[:1]] == ["upper"]
        assert [it.name for it in arm.shapes["*er"]] == ["upper", "lower"]
        assert [it.name for it in arm.actuators[["turn", 0]]] == ["turn", "bend"]
        assert [it.name for it in arm.sensors["[ar]*"]] == ["rate", "angle"]
        with pytest.raises(KeyError, match="no shape has a name like 'x\\*'; there are upper, lower"):
            arm.shapes["x*"]
        assert repr(Worlds(made()[0], 2).bodies) == "<body: 'world', 'arm', 'box'>"


def test_groups_have_and_set_the_terms_of_their_joints() -> None:
    for world, arm in both():
        shape = np.shape(world.time)
        for name, value in (("damping", 0.2), ("stiffness", 0.3), ("armature", 0.4)):
            setattr(arm.joints, name, value)
            setattr(arm.joints["e*"], name, [2.0 * value])
            assert getattr(arm.joints, name).shape == (*shape, 2)
            assert getattr(arm.joints, name).reshape(-1, 2)[-1].tolist() == [value, 2.0 * value]
            assert np.ravel(getattr(arm.joints["elbow"], name))[-1] == 2.0 * value
            with pytest.raises(ValueError, match=f"{name} must be >= 0"):
                setattr(arm.joints, name, [1.0, -1.0])
            with pytest.raises(ValueError, match=name):
                setattr(arm.joints, name, [1.0, 2.0, 3.0])
            assert getattr(arm.joints, name).reshape(-1, 2)[0].tolist() == [value, 2.0 * value]
        assert not arm.joints.friction_loss.any()
    _, arm = both()[0]
    arm.joints.friction_loss = (0.1, 0.0)
    assert arm.joints["shoulder"].friction_loss == 0.1


def test_limits_are_set_of_one_joint_and_of_several() -> None:
    (_, arm), (_, arms) = both()
    arm.joints["elbow"].limits = (-0.5, 0.5)
    assert arm.joints.limits[0].tolist() == [-2.0, -0.5]
    arm.joints.limits = (-1.0, (1.0, 1.5))
    assert arm.joints["elbow"].limits == (-1.0, 1.5)
    arms.joints["shoulder"].limits = ([-1.0, -1.5], 1.0)
    assert arms.joints.limits[0][:, 0].tolist() == [-1.0, -1.5]
    arms.joints[:1].limits = (-0.1, 0.1)
    assert arms.joints.limits[1][:, 0].tolist() == [0.1, 0.1]
    for joint in (arm.joints["elbow"], arms.joints["shoulder"], arm.joints, arms.joints):
        with pytest.raises(ValueError, match="limits must be the least and the greatest position"):
            joint.limits = 1.0
    with pytest.raises(ValueError, match="'elbow' has no limits: set them in the original world"):
        arms.joints["elbow"].limits = (-1.0, 1.0)


def test_one_position_is_for_all_joints() -> None:
    for world, arm in both():
        arm.joints.positions = 0.25
        assert np.asarray(arm.joints.positions).tolist() == np.full((*np.shape(world.time), 2), 0.25).tolist()
        arm.joints["e*"].positions = 0.5
        assert np.ravel(arm.joints["elbow"].position)[0] == 0.5


def test_a_servo_keeps_its_gains_when_it_gets_another_target() -> None:
    for _, arm in both():
        with pytest.raises(ValueError, match="a servo needs its gains the first time"):
            arm.joints.servo(0.1)
        arm.joints.servo([0.1, 0.2], kp=[10.0, 20.0], kd=3.0)
        arm.joints[:1].servo(0.5)
        arm.joints["elbow"].servo(0.6, kp=7.0)
        motors = arm.joints.motors()
        assert np.atleast_2d(motors["targets"])[-1].tolist() == [0.5, 0.6]
        assert np.atleast_2d(motors["gains"])[-1].tolist() == [10.0, 7.0]
        assert np.atleast_2d(motors["velocity_gains"])[-1].tolist() == [3.0, 3.0]


def test_a_servo_keeps_its_gains_in_the_worlds_that_are_chosen() -> None:
    _, arms = both()[1]
    arms.joints.servo(0.0, kp=[[1.0, 2.0], [3.0, 4.0]], kd=0.1)
    arms.joints.servo(0.7, where=[1])
    assert arms.joints.motors()["gains"].tolist() == [[1.0, 2.0], [3.0, 4.0]]
    assert arms.joints.motors()["targets"].tolist() == [[0.0, 0.0], [0.7, 0.7]]


def test_controls_and_sensors_are_found_by_name() -> None:
    for world, arm in both():
        arm.actuators.controls = (0.3, 0.4)
        assert world.controls["turn"].tolist() == np.full((*np.shape(world.time), 1), 0.4).tolist()
        assert world.sensors["rate"].shape == (*np.shape(world.time), 3)
        assert (world.sensors["angle"][..., 0] == arm.joints["elbow"].position).all()
        with pytest.raises(KeyError, match="nothing is called 'knee' here; there are rate, angle"):
            world.sensors["knee"]


def test_inverse_kinematics_takes_poses_of_several_links() -> None:
    for world, arm in both():
        arm.joints.positions = (0.3, 0.4)
        wanted = [arm.links["arm"].pose, arm.links["hand"].pose]
        arm.joints.positions = (0.1, 0.1)
        found = arm.inverse_kinematics(["arm", "hand"], wanted, iterations=200)
        np.testing.assert_allclose(np.atleast_2d(found.positions)[-1], (0.3, 0.4), atol=1e-3)
        assert np.shape(found.positions) == (*np.shape(world.time), 2)


def test_a_start_of_another_length_is_answered_with_the_right_one() -> None:
    panda = World().load_urdf("franka_panda/panda.urdf", fixed_base=True)
    with pytest.raises(
        ValueError, match="start has 9: one for each coordinate of the movable joints of 'panda'"
    ):
        panda.inverse_kinematics("panda_hand", Pose((0.5, 0.0, 0.5)), start=[0.0] * 7)


def test_contacts_of_a_shape_are_answered_with_what_has_them() -> None:
    for world, arm in both():
        for ask in (world.contacts, world.force_between):
            with pytest.raises(TypeError, match="contacts are asked of bodies and links, not of shapes"):
                ask(arm.shapes["lower"])
        world.contacts(a=arm, b="box")


def test_pixels_of_a_body_are_found_in_one_image_and_in_many() -> None:
    camera = Camera.with_field_of_view(32, 24, 60.0).look_at((0.3, -0.8, 1.0), (0.3, 0.0, 1.0))
    (world, arm), (worlds, arms) = both()
    one, many = world.image(camera), worlds.images(camera)
    for keys in ((arm,), ("arm",), (arm.id,), (arm, "hand"), (arm, arm.links["hand"]), ("arm", 1)):
        assert one.mask(*keys).any()
        assert (many.mask(*keys) == one.mask(*keys)).all()
    assert (many.mask(arms, arms.links["hand"]) == one.mask("arm", "hand")).all()
    with pytest.raises(KeyError, match="there is no body 'leg'; there are"):
        many.mask("leg")
    colour, depth, bodies, links = many
    assert colour.shape == (2, 24, 32, 3)
    assert depth.shape == bodies.shape == links.shape == (2, 24, 32)


def test_poses_are_made_with_a_quaternion() -> None:
    turned = Pose((1.0, 2.0, 3.0), quaternion=(0.0, 0.0, 1.0, 0.0))
    assert turned.quaternion.tolist() == turned.orientation.tolist() == [0.0, 0.0, 1.0, 0.0]
    assert Pose(orientation=(0.0, 0.0, 1.0, 0.0)).quaternion.tolist() == [0.0, 0.0, 1.0, 0.0]
    assert repr(turned).startswith("Pose(position=array([1., 2., 3.]), quaternion=array(")
