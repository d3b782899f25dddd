"""URDF files as their authors meant them: inertia, damping, friction, couplings, meshes."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from carom import World
from carom.algorithms import mass_matrix
from carom.errors import DescriptionError
from carom.layouts.flags import LoadFlags

STEP = 1.0 / 240.0


def link(name: str, mass: float = 2.0, moment: float = 0.5, inside: str = "") -> str:
    inertia = f'<inertia ixx="{moment}" ixy="0" ixz="0" iyy="{moment}" iyz="0" izz="{moment}"/>'
    return f'<link name="{name}"><inertial><mass value="{mass}"/>{inertia}</inertial>{inside}</link>'


def joint(name: str, parent: str, child: str, kind: str = "continuous", inside: str = "") -> str:
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<axis xyz="0 0 3"/>{inside}</joint>'
    )


@pytest.fixture
def load(tmp_path: Path):
    worlds = []

    def load(*parts: str, **arguments):
        path = tmp_path / "robots" / "robot.urdf"
        path.parent.mkdir(exist_ok=True)
        path.write_text(f'<robot name="r">{"".join(parts)}</robot>')
        worlds.append(World(contact="bullet"))
        return worlds[-1].load(path, **arguments)

    yield load
    for world in worlds:
        world.__exit__()


@pytest.mark.parametrize(("turn", "product"), [("0.4 0.5 0.6", 0.0), ("0 0 0", 0.05)])
def test_spherical_joints_turn_links_and_not_their_principal_axes(load, turn, product):
    inertia = f'<inertia ixx="0.3" ixy="{product}" ixz="0" iyy="0.2" iyz="0" izz="0.25"/>'
    inertial = f'<origin xyz="0.1 0.2 0.3" rpy="{turn}"/><mass value="2"/>{inertia}'
    ball = f'<link name="ball"><inertial>{inertial}</inertial></link>'
    turned = joint("j", "base", "ball", "spherical", '<origin xyz="0 0 1" rpy="0.3 0.2 0.1"/>')
    (body,) = load(link("base"), ball, turned, fixed_base=True).bodies
    rotation = Rotation.from_rotvec([0.3, -0.5, 0.7])
    body.joints["j"].reset(rotation.as_quat())
    expected = Rotation.from_euler("xyz", [0.3, 0.2, 0.1]) * rotation
    pose = body.links["ball"].pose
    assert_allclose(pose.position, [0, 0, 1], atol=1e-12)
    assert_allclose(pose.orientation, expected.as_quat(), atol=1e-9)


def two_wheels(inside: str = "") -> tuple[str, ...]:
    """Two links that turn about parallel axes of a fixed base, independently of each other."""
    return (
        link("base"),
        link("one", moment=0.5),
        link("two", moment=0.25),
        joint("first", "base", "one"),
        joint("second", "base", "two", inside=inside),
    )


def test_inertia_is_that_of_the_file_to_the_last_digits(load):
    tensor = np.array([[0.3, 0.02, -0.01], [0.02, 0.2, 0.03], [-0.01, 0.03, 0.25]])
    inertial = (
        '<link name="b"><inertial><origin xyz="0.1 0.2 0.3" rpy="0.4 0.5 0.6"/><mass value="1.5"/>'
        '<inertia ixx="0.3" ixy="0.02" ixz="-0.01" iyy="0.2" iyz="0.03" izz="0.25"/></inertial></link>'
    )
    body = load(link("a"), inertial, joint("j", "a", "b"), fixed_base=True)[0]
    from carom.description.transform import quaternion_from_rpy, rotation_matrix

    turn = np.array(rotation_matrix(quaternion_from_rpy(0.4, 0.5, 0.6)))
    about_z = (turn @ tensor @ turn.T)[2, 2] + 1.5 * (0.1**2 + 0.2**2)
    assert mass_matrix(body, [0.7])[0, 0] == pytest.approx(about_z, rel=1e-13)


def test_products_of_inertia_count_singly(load):
    part = (
        '<link name="a"><inertial><mass value="1"/><inertia ixx="2" ixy="0.5" iyy="2" izz="2"/>'
        "</inertial></link>"
    )
    moments = sorted(load(part)[0].spec.base.inertia)
    assert moments == pytest.approx([1.5, 2.0, 2.5])


def test_links_without_inertial_have_no_mass(load, caplog):
    scene = load(link("a"), '<link name="b"/>', joint("j", "a", "b", "fixed"))
    assert scene[0].links["b"].mass == 0.0
    assert not scene[0].fixed_base
    assert not caplog.records


def test_links_without_inertial_can_be_given_a_mass(load):
    scene = load(link("a"), '<link name="b"/>', joint("j", "a", "b"), default_mass=0.25)
    assert (scene[0].links["b"].mass, scene[0].spec.links[0].inertia) == (0.25, (0.25, 0.25, 0.25))


def test_a_joint_that_moves_nothing_with_mass_stays_and_is_reported(load):
    swinging = (link("a"), link("b"), joint("j", "a", "b", inside='<origin rpy="1.57 0 0"/>'))
    finger = ('<link name="tip"/>', joint("k", "b", "tip", inside='<origin xyz="0.3 0.2 0"/>'))
    with_finger, without = load(*swinging, *finger, fixed_base=True), load(*swinging, fixed_base=True)
    (one,) = with_finger.ignored
    assert (one.element, one.consequence) == ("robot/joint", "no force or motor moves the joint")
    assert "('tip')" in one.reason
    for scene in (with_finger, without):
        scene.world.gravity = (0, 0, -9.81)
        scene[0].joints["j"].set_velocity_target(2.0, max_force=0.5)
    with_finger[0].joints["k"].reset(0.7)
    with_finger[0].joints["k"].set_velocity_target(1.0, max_force=10.0)
    for scene in (with_finger, without):
        scene.world.step(240)
    assert with_finger[0].joints["j"].position == pytest.approx(without[0].joints["j"].position, rel=1e-12)
    assert with_finger[0].joints["k"].position == 0.7


def test_a_massless_link_between_others_is_fine(load):
    body = load(
        link("a"),
        '<link name="b"/>',
        link("c"),
        joint("j", "a", "b"),
        joint("k", "b", "c", inside='<origin xyz="1 0 0"/>'),
        fixed_base=True,
    )[0]
    # The second joint is 1 m beside the first: M = [[I + m, I], [I, I]].
    assert mass_matrix(body, [0.3, 0.9]) == pytest.approx(np.array([[2.5, 0.5], [0.5, 0.5]]))


@pytest.mark.parametrize(
    ("parts", "is_fixed"),
    [
        ((link("a"),), False),
        (('<link name="a"/>',), True),
        (('<link name="a"/>', link("b"), joint("j", "a", "b", "fixed")), False),
        (('<link name="a"/>', link("b"), joint("j", "a", "b")), True),
    ],
)
def test_a_base_is_fixed_if_nothing_in_it_has_mass(load, parts, is_fixed):
    assert load(*parts)[0].fixed_base == is_fixed


def test_a_floating_base_without_mass_of_its_own_falls_with_its_links(load):
    scene = load('<link name="a"/>', link("b"), joint("j", "a", "b", "fixed", '<origin xyz="0 0 1"/>'))
    scene.world.gravity = (0, 0, -10)
    scene.world.step(24)
    assert scene[0].links[-1].velocity[0] == pytest.approx((0, 0, -1.0))


def test_nothing_holds_or_damps_a_body(load):
    scene = load(*two_wheels())
    body, world = scene[0], scene.world
    body.set_base_velocity((1, 2, 3), (0, 0, 0))
    body.set_joint_state(0, [0.0], [4.0])
    body.set_joint_state(1, [0.0], [-8.0])
    world.step(240)
    # The wheels of equal and opposite momentum turn on, and the base does not.
    assert body.joints.velocities == pytest.approx([4.0, -8.0])
    assert body.links[-1].velocity[0] == pytest.approx((1, 2, 3))


def test_the_length_of_an_axis_means_nothing(load):
    scene = load(*two_wheels(), fixed_base=True)
    scene[0].set_joint_state(0, [0.0], [1.0])
    scene.world.step(240)
    assert scene[0].joints[0].position == pytest.approx(1.0)


def test_damping_and_friction_slow_a_joint(load):
    scene = load(*two_wheels('<dynamics damping="0.5" friction="0.75"/>'), fixed_base=True)
    body = scene[0]
    body.set_joint_state(1, [0.0], [2.0])
    scene.world.step()
    # Damping is implicit in velocity.
    after = (0.25 * 2.0 - STEP * 0.75) / (0.25 + STEP * 0.5)
    assert body.joints[1].velocity == pytest.approx(after, rel=1e-12)


def test_friction_alone_stops_a_joint_after_the_time_it_takes(load):
    scene = load(*two_wheels('<dynamics friction="0.75"/>'), fixed_base=True)
    body = scene[0]
    body.set_joint_state(1, [0.0], [2.0])
    scene.world.step(120)
    assert body.joints[1].velocity == pytest.approx(2.0 - 0.5 * 0.75 / 0.25)
    scene.world.step(120)
    assert body.joints[1].velocity == pytest.approx(0.0, abs=1e-15)


def test_friction_holds_until_a_force_exceeds_it(load):
    scene = load(*two_wheels('<dynamics friction="0.75"/>'), fixed_base=True)
    body, world = scene[0], scene.world
    for torque, rate in ((0.7, 0.0), (1.0, STEP * 0.25 / 0.25)):
        world.joint_torque[body.velocity_index[1]] = torque
        world.step()
        assert body.joints[1].velocity == pytest.approx(rate, abs=1e-15)


def test_a_motor_works_against_friction(load):
    scene = load(*two_wheels('<dynamics friction="0.75"/>'), fixed_base=True)
    body, world = scene[0], scene.world
    body.joints[1].set_velocity_target(100.0, max_force=1.0)
    world.step()
    assert body.joints[1].velocity == pytest.approx(STEP * (1.0 - 0.75) / 0.25)


def test_friction_is_saved_with_a_world(load, tmp_path):
    scene = load(
        *two_wheels('<dynamics friction="0.75"/><mimic joint="first" multiplier="2"/>'), fixed_base=True
    )
    scene[0].set_joint_state(0, [0.0], [2.0])
    scene.world.save(tmp_path / "saved")
    with World() as other:
        bodies = other.load(tmp_path / "saved")
        for world in (scene.world, other):
            world.step(60)
        assert bodies[0].joints.positions.tolist() == scene[0].joints.positions.tolist()


def test_a_coupling_is_exact_within_a_step(load):
    scene = load(*two_wheels('<mimic joint="first" multiplier="-2"/>'), fixed_base=True)
    body, world, coupling = scene[0], scene.world, scene.constraints["second"]
    world.joint_torque[body.velocity_index[0]] = 3.0
    world.step()
    # One joint with the inertia of both: I1 + (-2)² I2.
    rate = STEP * 3.0 / (0.5 + 4.0 * 0.25)
    assert body.joints.velocities == pytest.approx([rate, -2.0 * rate], rel=1e-13)
    assert coupling.force == pytest.approx(0.25 * -2.0 * rate / STEP, rel=1e-12)
    assert coupling.error == pytest.approx(0.0, abs=1e-15)


def test_a_coupling_reduces_its_error_as_limits_do(load):
    scene = load(*two_wheels('<mimic joint="first" multiplier="2" offset="0.1"/>'), fixed_base=True)
    coupling = scene.constraints["second"]
    assert scene[0].joints.positions.tolist() == [0.0, 0.1]
    scene[0].joints.reset([0.0, 0.0])
    assert coupling.error == pytest.approx(-0.1)
    scene.world.step()
    assert coupling.error == pytest.approx(-0.1 * (1.0 - 0.2))
    scene.world.step(200)
    assert coupling.error == pytest.approx(0.0, abs=1e-12)


def test_a_coupling_can_be_switched_off_and_on(load):
    scene = load(*two_wheels('<mimic joint="first"/>'), fixed_base=True)
    body, coupling = scene[0], scene.constraints["second"]
    coupling.enabled = False
    body.set_joint_state(0, [0.0], [1.0])
    scene.world.step(24)
    assert body.joints.positions == pytest.approx([0.1, 0.0])
    assert coupling.force == 0.0
    coupling.enabled = True
    scene.world.step(200)
    assert coupling.error == pytest.approx(0.0, abs=1e-12)


def test_followers_are_placed_with_their_leaders(load):
    third = (link("three"), joint("third", "base", "three", inside='<mimic joint="second" multiplier="3"/>'))
    scene = load(*two_wheels('<mimic joint="first" multiplier="2" offset="0.1"/>'), *third)
    body = scene[0]
    assert body.joints.positions == pytest.approx([0.0, 0.1, 0.3])
    body.joints["first"].reset(0.5, 1.0)
    assert body.joints.positions == pytest.approx([0.5, 1.1, 3.3])
    assert body.joints.velocities == pytest.approx([1.0, 2.0, 6.0])
    scene.constraints["second"].enabled = False
    body.joints["first"].reset(0.0)
    assert body.joints.positions == pytest.approx([0.0, 1.1, 3.3])


def test_couplings_in_a_chain_converge(load):
    parts = [link("l0")]
    for n in range(1, 5):
        follow = '<mimic joint="j1" multiplier="0.5"/>' if n > 1 else ""
        parts += [
            link(f"l{n}"),
            joint(f"j{n}", f"l{n - 1}", f"l{n}", inside='<origin xyz="0.3 0 0"/>' + follow),
        ]
    scene = load(*parts, fixed_base=True)
    body, world = scene[0], scene.world
    for _ in range(50):
        world.joint_torque[body.velocity_index[0]] = 2.0
        world.step()
    first, *others = body.joints.velocities
    assert others == pytest.approx([0.5 * first] * 3, rel=1e-3)
    # As one joint: M reduced by the couplings, at the start of the last step.
    assert len(scene.constraints) == 3


def test_a_follower_of_a_fixed_joint_stays(load):
    scene = load(
        link("a"), link("b"), link("c"), joint("j", "a", "b", "fixed"),
        joint("k", "a", "c", inside='<mimic joint="j" offset="0.3"/>'), fixed_base=True,
    )  # fmt: skip
    scene.world.step(240)
    assert scene[0].joints["k"].position == pytest.approx(0.3)
    assert scene.constraints["k"].leader is None


def test_a_pin_that_cannot_follow_is_reported(load):
    scene = load(link("a"), link("b"), link("c"), joint("k", "a", "c"),
                 joint("j", "a", "b", "spherical", '<mimic joint="k"/>'))  # fmt: skip
    (one,) = scene.ignored
    assert one.reason == "'j' is neither revolute nor prismatic"


def test_merged_links_move_as_before(load):
    turned = '<origin xyz="0.2 -0.1 0.4" rpy="0.3 0.2 0.1"/>'
    part = (
        '<link name="c"><inertial><origin xyz="0.1 0 0.2" rpy="0.5 0 0.4"/><mass value="0.7"/>'
        '<inertia ixx="0.3" ixy="0.02" ixz="0" iyy="0.2" iyz="0.01" izz="0.25"/></inertial></link>'
    )
    parts = (link("a"), link("b"), part, link("d"), joint("j", "a", "b"),
             joint("k", "b", "c", "fixed", turned),
             joint("l", "c", "d", inside='<origin xyz="0 0.5 0" rpy="1 0 0"/>'))  # fmt: skip
    whole = load(*parts, fixed_base=True)[0]
    merged = load(*parts, fixed_base=True, flags=LoadFlags.MERGE_FIXED_LINKS)[0]
    assert (whole.joint_count, merged.joint_count) == (3, 2)
    assert mass_matrix(merged, [0.4, 0.9]) == pytest.approx(mass_matrix(whole, [0.4, 0.9]), rel=1e-12)


def test_an_impossible_tensor_is_used_with_a_warning(load, caplog):
    part = '<link name="a"><inertial><mass value="1"/><inertia ixx="3" iyy="1" izz="1"/></inertial></link>'
    assert load(part)[0].spec.base.inertia == (3.0, 1.0, 1.0)
    assert "no body has the inertia tensor" in caplog.text


def test_as_pybullet_reads_as_before(load, tmp_path):
    path = tmp_path / "robots" / "robot.urdf"
    load(*two_wheels())
    with World() as world:
        body = world.load_urdf(path, fixed_base=True, as_pybullet=True)
        assert body.spec.is_held
        assert body.spec.link_damping == pytest.approx(0.04)
        assert body.spec.links[0].joint_axis_length == 3.0


MESH = '<collision><geometry><mesh filename="{}"/></geometry></collision>'
TRIANGLES = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 3 4\nf 2 3 4\n"


def test_a_missing_mesh_is_an_error_unless_it_may_be(load):
    part = link("a", inside=MESH.format("package://hand/palm.obj"))
    with pytest.raises(DescriptionError, match=r"palm\.obj' was found neither"):
        load(part)
    scene = load(part, missing_meshes="warn")
    assert scene[0].spec.base.collisions == ()
    (one,) = scene.ignored
    assert (one.element, one.consequence) == ("link/collision", "the link is without this shape")
    assert "palm.obj" in one.reason


def test_packages_are_searched(load, tmp_path):
    meshes = tmp_path / "elsewhere" / "hand" / "meshes"
    meshes.mkdir(parents=True)
    (meshes / "palm.obj").write_text(TRIANGLES)
    part = link("a", inside=MESH.format("package://hand/meshes/palm.obj"))
    for folder in (tmp_path / "elsewhere", tmp_path / "elsewhere" / "hand"):
        (collision,) = load(part, package_paths=[folder])[0].spec.base.collisions
        assert collision.geometry.path == meshes / "palm.obj"


def test_a_package_above_the_file_may_be_in_a_folder_of_another_name(load, tmp_path):
    (tmp_path / "package.xml").write_text("<package><name>hand</name></package>")
    (tmp_path / "palm.obj").write_text(TRIANGLES)
    part = link("a", inside=MESH.format("package://hand/palm.obj"))
    (collision,) = load(part)[0].spec.base.collisions
    assert collision.geometry.path == tmp_path / "palm.obj"


def test_the_mesh_folder_of_mujocos_extension_is_searched(load, tmp_path):
    (tmp_path / "robots" / "assets").mkdir(parents=True)
    (tmp_path / "robots" / "assets" / "palm.obj").write_text(TRIANGLES)
    extension = '<mujoco><compiler meshdir="assets" strippath="true" balanceinertia="true"/></mujoco>'
    scene = load(extension, link("a", inside=MESH.format("package://x/y/palm.obj")))
    assert len(scene[0].spec.base.collisions) == 1
    assert [(one.element, one.attributes) for one in scene.ignored] == [
        ("mujoco/compiler", ("balanceinertia",))
    ]


def test_worlds_couple_and_rub_too(load):
    from carom import Worlds

    scene = load(
        *two_wheels('<dynamics friction="0.1"/><mimic joint="first" multiplier="2"/>'), fixed_base=True
    )
    body = scene[0]
    worlds = Worlds(scene.world, 3)
    worlds[body].joints.velocities[:] = [[1.0, 2.0], [2.0, 4.0], [0.0, 0.0]]
    worlds.step()
    rates = worlds[body].joints.velocities
    slowed = STEP * 0.1 * 2.0 / (0.5 + 4.0 * 0.25)
    assert rates[:, 0] == pytest.approx([1.0 - slowed, 2.0 - slowed, 0.0], abs=1e-9)
    assert rates @ [2.0, -1.0] == pytest.approx([0.0, 0.0, 0.0], abs=1e-9)


@pytest.mark.parametrize("fixed_base", [False, True])
def test_a_floating_joint_to_a_root_that_stands_for_the_world_frees_the_robot(load, fixed_base):
    parts = ('<link name="world"/>', link("base"), link("arm"))
    floating = '<joint name="free" type="floating"><parent link="world"/><child link="base"/></joint>'
    scene = load(*parts, floating, joint("j", "base", "arm"), fixed_base=fixed_base)
    (body,) = scene.bodies
    assert not scene.ignored.that_matter
    assert body.fixed_base is fixed_base
    assert (body.links[-1].name, [joint.name for joint in body.joints]) == ("base", ["j"])
    scene.world.step()
    assert (body.links[-1].pose.position[2] < 0.0) is not fixed_base


@pytest.mark.parametrize(
    "parts",
    [
        (link("world"), '<origin xyz="0 0 0"/>'),
        ('<link name="world"/>', '<origin xyz="0 0 1"/>'),
        ('<link name="world"/>' + link("other") + joint("k", "world", "other"), ""),
    ],
)
def test_other_floating_joints_are_reported_and_fixed(load, parts):
    roots, origin = parts
    floating = f'<joint name="f" type="floating"><parent link="world"/><child link="base"/>{origin}</joint>'
    scene = load(roots, link("base"), floating)
    assert [found.consequence for found in scene.ignored.that_matter] == ["it is fixed"]
    assert scene.bodies[0].joints["f"].degrees_of_freedom == 0


def test_an_inertial_without_a_mass_has_none(load):
    tip = '<link name="tip"><inertial><inertia ixx="0" iyy="0" izz="0"/></inertial></link>'
    scene = load(link("base"), tip, joint("j", "base", "tip", "fixed"))
    assert scene.bodies[0].links["tip"].mass == 0.0


def test_the_whole_path_of_a_missing_mesh_is_named(tmp_path):
    name = f"package://a_robot_description/{'meshes/' * 9}the_visual_of_its_third_link.stl"
    for path, said in ((name, name), (f"{'folder/' * 90}end.stl", "...")):
        text = (
            f'<robot name="r"><link name="a"><visual><geometry><mesh filename="{path}"/></geometry></visual>'
        )
        (tmp_path / "robot.urdf").write_text(f"{text}</link></robot>")
        with World() as world, pytest.raises(DescriptionError) as problem:
            world.load(tmp_path / "robot.urdf")
        assert said in str(problem.value)
        assert f"{path[-20:]}' was found neither" in str(problem.value)
        assert len(problem.value.reason) < 500
