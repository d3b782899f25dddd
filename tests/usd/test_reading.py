"""USD stages in a world: bodies, joints, drives, colliders, masses, units, pairs, and what is left out."""

from __future__ import annotations

import math
from pathlib import Path

import pytest
from numpy.testing import assert_allclose
from tests.each import each
from tests.usd.stages import body, joint, prim, stage

import carom
from carom import World
from carom.description import Box, Capsule, ConvexHull, Sphere, TriangleMesh
from carom.description.actuator import ActuatorSpec
from carom.errors import DescriptionError
from carom.layouts.codes import ActivationDynamics
from carom.world.scene import Scene

pytest.importorskip("pxr", reason="usd-core reads the stages")


def load(tmp_path: Path, content: str, *, strict: bool = True, **units) -> Scene:
    return World().load(stage(tmp_path, content, **units), strict=strict)


def test_a_hinge_with_limits_and_a_fixed_base(tmp_path: Path):
    hinge = """uniform token physics:axis = "Y"; point3f physics:localPos0 = (1, 0, 0);
        float physics:lowerLimit = -90; float physics:upperLimit = 45;"""
    content = body("a", at=(0, 0, 1)) + body("b", at=(1, 0, 1)) + joint("Revolute", "j", "a b", hinge)
    content += joint("Fixed", "weld", "- a", "point3f physics:localPos0 = (0, 0, 1);")
    (robot,) = load(tmp_path, content)
    assert robot.fixed_base
    assert [it.name for it in robot.links] == ["a", "b"]
    (hinge,) = robot.joints
    assert_allclose(hinge.limits, (-math.pi / 2, math.pi / 4), rtol=1e-7)
    assert_allclose(hinge.axis, (0, 1, 0), atol=1e-12)
    hinge.reset(math.pi / 4)
    assert_allclose(robot.links["b"].pose.position, (1, 0, 1), atol=1e-7)


def test_a_joint_that_is_not_at_its_link_carries_it(tmp_path: Path):
    hinge = 'uniform token physics:axis = "Z"; point3f physics:localPos1 = (-1, 0, 0);'
    (robot,) = load(tmp_path, body("a") + body("b", at=(1, 0, 0)) + joint("Revolute", "j", "a b", hinge))
    assert [it.name for it in robot.links] == ["a", "b@j", "b"]
    robot.joints["j"].reset(math.pi / 2)
    assert_allclose(robot.links["b"].pose.position, (0, 1, 0), atol=1e-7)


def test_a_joint_is_where_the_stage_has_its_bodies(tmp_path: Path):
    slide = 'uniform token physics:axis = "X";'
    (robot,) = load(tmp_path, body("a") + body("b", at=(0.25, 0, 0)) + joint("Prismatic", "j", "a b", slide))
    assert_allclose(robot.joints["j"].position, 0.25, rtol=1e-12)
    assert_allclose(robot.links["b"].pose.position, (0.25, 0, 0), atol=1e-12)


def test_a_joint_turned_around_moves_the_same_way(tmp_path: Path):
    content = body("a") + body("b", at=(0.25, 0, 0))
    content += joint("Prismatic", "j", "b a", 'uniform token physics:axis = "X";')
    content += joint("Fixed", "weld", "- a")
    (robot,) = load(tmp_path, content)
    assert_allclose(robot.joints["j"].position, -0.25, rtol=1e-12)
    robot.joints["j"].reset(-0.5)
    assert_allclose(robot.links["b"].pose.position, (0.5, 0, 0), atol=1e-12)


@each(
    ("values", "gain", "bias", "control"),
    [
        (
            "stiffness = 180; targetPosition = 90",
            180 * 180 / math.pi,
            (0, -180 * 180 / math.pi, 0),
            math.pi / 2,
        ),
        ("damping = 2; targetVelocity = 180", 360 / math.pi, (0, 0, -360 / math.pi), math.pi),
        ("maxForce = 3", 1, (0, 0, 0), 0),
    ],
)
def test_drives_are_servos_or_motors(tmp_path: Path, values, gain, bias, control):
    stated = "".join(f"float drive:angular:physics:{it};" for it in values.split("; "))
    content = body("a") + body("b") + joint("Revolute", "j", "a b", stated, ("DriveAPI:angular",))
    (robot,) = load(tmp_path, content)
    (servo,) = robot.actuators
    assert_allclose((servo.spec.gain[0], *servo.spec.bias), (gain, *bias), rtol=1e-6)
    assert_allclose(servo.control, control, rtol=1e-6)


def test_actuators_of_mujocos_schema(tmp_path: Path):
    servo = """double[] mjc:gainPrm = [10]; double[] mjc:biasPrm = [0, -10, -1];
        token mjc:biasType = "affine";
        token mjc:dynType = "filter"; bool mjc:actEarly = 1;
        double[] mjc:gear = [2]; double mjc:ctrlRange:min = -1; double mjc:ctrlRange:max = 3;
        rel mjc:target = </World/j>;"""
    content = body("a") + body("b") + joint("Revolute", "j", "a b", "double mjc:armature = 0.5;")
    (robot,) = load(tmp_path, content + prim("MjcActuator", "motor", servo))
    spec = robot.actuators["motor"].spec
    assert (spec.joint, spec.gain, spec.bias, spec.gear) == ("j", (10, 0, 0), (0, -10, -1), 2)
    assert spec.control_range == (-1, 3)
    assert (spec.dynamics, spec.acts_early) == (ActivationDynamics.FILTER, True)
    assert robot.joints["j"].armature == 0.5
    assert 'actearly="true"' in carom.read(tmp_path / "stage.usda").text()


def servo_of(tmp_path: Path, kind: str) -> ActuatorSpec:
    stated = f'float drive:linear:physics:stiffness = 10; uniform token drive:linear:physics:type = "{kind}";'
    content = body("a") + body("b") + joint("Prismatic", "j", "a b", stated, ("DriveAPI:linear",))
    (robot,) = load(tmp_path, content + joint("Fixed", "weld", "- a"), strict=False)
    return robot.actuators["j"].spec


def test_drives_of_accelerations_are_for_the_mass_that_they_move(tmp_path: Path):
    assert_allclose(servo_of(tmp_path, "force").gain[0], 10.0)
    assert_allclose(servo_of(tmp_path, "acceleration").gain[0], 20.0)


def test_units_and_the_axis_that_is_up(tmp_path: Path):
    cube = prim("Cube", "c", "double size = 20;", ("CollisionAPI",))
    content = prim("PhysicsScene", "scene") + body("a", cube, at=(0, 300, 0), mass=2000)
    scene = load(tmp_path, content, unit=0.01, mass=0.001, up="Y")
    (robot,) = scene
    assert_allclose(robot.links["a"].pose.position, (0, 0, 3), atol=1e-12)
    assert_allclose(robot.spec.base.mass, 2.0)
    assert_allclose(robot.spec.base.inertia, [0.1 * 0.001 * 0.0001] * 3, rtol=1e-6)
    (collision,) = robot.spec.base.collisions
    assert isinstance(collision.geometry, Box)
    assert_allclose(collision.geometry.half_extents, [0.1] * 3, rtol=1e-12)
    assert_allclose(scene.world.parameters.gravity, (0, 0, -9.81), atol=1e-12)


SHAPES = {
    "Cube": ("double size = 1; float3 xformOp:scale = (1, 2, 4);", Box((0.5, 1.0, 2.0))),
    "Sphere": ("double radius = 0.5; float3 xformOp:scale = (2, 2, 2);", Sphere(1.0)),
    "Capsule": ('double radius = 0.5; double height = 1; token axis = "Y"; float3 xformOp:scale = (2, 4, 2);',
                Capsule(1.0, 4.0)),
}  # fmt: skip


@each("kind", SHAPES)
def test_colliders_have_the_scale_of_their_frame(tmp_path: Path, kind: str):
    text, expected = SHAPES[kind]
    order = 'uniform token[] xformOpOrder = ["xformOp:scale"];'
    (robot,) = load(tmp_path, body("a", prim(kind, "c", text + order, ("CollisionAPI",))))
    (collision,) = robot.spec.base.collisions
    assert collision.geometry == expected


TETRAHEDRON = """point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)];
int[] faceVertexCounts = [3, 3, 3, 3];
int[] faceVertexIndices = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3];"""


def test_meshes_collide_by_their_approximation(tmp_path: Path):
    apis = ("CollisionAPI", "MeshCollisionAPI")
    hull = prim("Mesh", "hull", TETRAHEDRON + 'uniform token physics:approximation = "convexHull";', apis)
    ball = prim("Mesh", "ball", TETRAHEDRON + 'uniform token physics:approximation = "boundingSphere";', apis)
    scene = load(tmp_path, body("a", hull + ball) + prim("Mesh", "ground", TETRAHEDRON, apis))
    first, second = scene["a"].spec.base.collisions
    assert isinstance(first.geometry, ConvexHull)
    assert isinstance(second.geometry, Sphere)
    (ground,) = scene["ground"].spec.base.collisions
    assert isinstance(ground.geometry, TriangleMesh)
    assert scene["ground"].fixed_base


def test_a_mesh_whose_faces_do_not_fit_is_refused(tmp_path: Path):
    broken = TETRAHEDRON.replace("1, 2, 3]", "1, 2, 9]")
    with pytest.raises(DescriptionError, match=r"</World/a/m>.*do not fit each other"):
        load(tmp_path, body("a", prim("Mesh", "m", broken, ("CollisionAPI",))))


def test_masses_from_densities_as_usd_computes_them(tmp_path: Path):
    first = prim(
        "Cube", "c", "double size = 1; float physics:density = 100;", ("CollisionAPI", "MassAPI"), (1, 0, 0)
    )
    second = prim("Sphere", "s", "double radius = 0.5;", ("CollisionAPI",), (0, 0, 1))
    mesh = prim("Mesh", "m", TETRAHEDRON + 'uniform token physics:approximation = "convexHull";',
                ("CollisionAPI", "MeshCollisionAPI"))  # fmt: skip
    base = load(tmp_path, prim("Xform", "a", first + second + mesh, ("RigidBodyAPI",)))["a"].spec.base
    ball, tetra = 1000 * math.pi / 6, 1000 / 6
    total = 100 + ball + tetra
    assert_allclose(base.mass, total, rtol=1e-6)
    centre = ((100 + tetra / 4) / total, tetra / 4 / total, (ball + tetra / 4) / total)
    assert_allclose(base.inertial_frame.position, centre, rtol=1e-6)
    # The trace of an inertia is twice the polar moment.
    own = 100 * 0.5 + ball * 0.3 + tetra * 2 * (3 * (2 / 20 - 1 / 16))
    arms = [(100, (1, 0, 0)), (ball, (0, 0, 1)), (tetra, (0.25, 0.25, 0.25))]
    moved = sum(2 * m * sum((p - q) ** 2 for p, q in zip(at, centre, strict=True)) for m, at in arms)
    assert_allclose(sum(base.inertia), own + moved, rtol=1e-6)


def test_materials_give_friction_and_restitution(tmp_path: Path):
    values = "float physics:dynamicFriction = 0.7; float physics:staticFriction = 0.7;"
    values += "float physics:restitution = 0.4;"
    rubber = prim("Material", "rubber", values, ("MaterialAPI",))
    ball = 'def Sphere "s" (prepend apiSchemas = ["PhysicsCollisionAPI", "MaterialBindingAPI"])\n{\n' \
           "rel material:binding:physics = </World/rubber>\n}\n"  # fmt: skip
    contact = load(tmp_path, rubber + body("a", ball))["a"].spec.base.contact
    assert contact.lateral_friction == pytest.approx(0.7)
    assert contact.restitution == pytest.approx(0.4)


BALL = prim("Sphere", "s", "double radius = 0.5;", ("CollisionAPI",))


HELD = "point3f physics:localPos0 = (0.5, 0, 0);"


def touching(scene: Scene) -> bool:
    scene.world.step()
    return bool(len(scene.world.contacts()))


@each(
    ("more", "touches"),
    [
        ("", True),
        (joint("Spherical", "j", "a b", HELD), False),
        (
            joint("Spherical", "j", "a b", HELD + "bool physics:collisionEnabled = 1;"),
            True,
        ),
        (
            prim(
                "PhysicsCollisionGroup",
                "g",
                "rel collection:colliders:includes = [</World/a>, </World/b>];"
                "rel physics:filteredGroups = </World/g>;",
                ("CollectionAPI:colliders",),
            ).replace("PhysicsCollectionAPI", "CollectionAPI"),
            False,
        ),
    ],
)
def test_which_bodies_collide(tmp_path: Path, more: str, touches: bool):
    assert touching(load(tmp_path, body("a", BALL) + body("b", BALL, at=(0.5, 0, 0)) + more)) == touches


def test_filtered_pairs_do_not_collide(tmp_path: Path):
    filtered = prim(
        "Xform", "a", BALL + "rel physics:filteredPairs = </World/b>;", ("RigidBodyAPI", "FilteredPairsAPI")
    )
    assert not touching(load(tmp_path, filtered + body("b", BALL, at=(0.5, 0, 0))))


def test_bodies_that_are_switched_off_or_kinematic_stay(tmp_path: Path):
    off = prim("Xform", "off", BALL + "bool physics:rigidBodyEnabled = 0;", ("RigidBodyAPI",), (5, 0, 0))
    held = body("held", BALL + "bool physics:kinematicEnabled = 1;", at=(9, 0, 0))
    thrown = body("thrown", "vector3f physics:velocity = (1, 0, 0);")
    scene = load(tmp_path, prim("PhysicsScene", "scene") + off + held + thrown)
    for _ in range(24):
        scene.world.step()
    assert scene["s"].links["s"].pose.position[2] == 0.0
    assert scene["held"].links["held"].pose.position[2] == 0.0
    assert scene["held"].spec.is_mocap
    x, _, z = scene["thrown"].links["thrown"].pose.position
    assert_allclose(x, 0.1, rtol=1e-9)
    assert z < -0.04


def test_a_joint_of_several_directions_is_a_chain(tmp_path: Path):
    locked = ("transX", "transY", "transZ", "rotX")
    limits = "".join(
        f"float limit:{it}:physics:low = 1; float limit:{it}:physics:high = -1;" for it in locked
    )
    apis = tuple(f"LimitAPI:{it}" for it in locked)
    scene = load(tmp_path, body("a") + body("b") + joint("", "j", "a b", limits, apis), strict=False)
    assert [it.name for it in scene[0].joints] == ["j@rotY", "j@rotZ"]
    assert [one.element for one in scene.ignored.that_matter] == ["PhysicsJoint"]


def test_a_loop_stays_closed(tmp_path: Path):
    bars = body("a") + body("b", at=(1, 0, 0)) + body("c", at=(1, 0, -1)) + body("d", at=(0, 0, -1))
    hinge = 'uniform token physics:axis = "Y"; point3f physics:localPos0 = {};'
    places = {"a b": (1, 0, 0), "b c": (0, 0, -1), "c d": (-1, 0, 0), "d a": (0, 0, 1)}
    names = zip("pqrs", places.items(), strict=True)
    joints = "".join(joint("Revolute", name, ends, hinge.format(at)) for name, (ends, at) in names)
    scene = load(tmp_path, prim("PhysicsScene", "scene") + bars + joints + joint("Fixed", "weld", "- a"))
    (robot,) = scene
    assert set(scene.constraints) == {"r", "r@2"}
    robot.joints["p"].velocity = 1.0
    for _ in range(240):
        scene.world.step()
    assert abs(robot.joints["p"].position) > 0.01
    ends = [robot.links[name].pose.position for name in ("d", "a")]
    assert_allclose(math.dist(*ends), 1.0, atol=1e-4)


def test_references_and_instances_are_read(tmp_path: Path):
    (tmp_path / "part.usda").write_text(
        '#usda 1.0\n(\n defaultPrim = "part"\n)\n' + prim("Xform", "part", body("a", BALL).replace(";", "\n"))
    )
    used = 'def Xform "{}" (instanceable = true\n prepend references = @part.usda@)\n{{\n}}\n'
    scene = load(tmp_path, used.format("one") + used.format("two"))
    assert len(scene) == 2
    assert all(len(robot.spec.base.collisions) == 1 for robot in scene)


def test_what_is_not_read_is_reported(tmp_path: Path):
    more = 'float physxRigidBody:linearDamping = 1; custom string userProperties:note = "x";'
    scene = load(tmp_path, body("a", more) + prim("MjcTendon", "motor"), strict=False)
    lost = {(one.element, one.attributes) for one in scene.ignored.that_matter}
    assert lost == {("Xform", ("physxRigidBody:linearDamping",)), ("MjcTendon", ())}
    with pytest.raises(DescriptionError, match="linearDamping"):
        load(tmp_path, body("a", more))


@each(
    ("content", "complaint"),
    [
        (body("a", mass=-1.0), "physics:mass is -1"),
        (
            body("a") + body("b") + joint("Revolute", "j", "a b", 'uniform token physics:axis = "W";'),
            "axis is 'W'",
        ),
        (body("a", prim("Sphere", "s", "double radius = -1;", ("CollisionAPI",))), "radius is -1"),
        ("def Xform", "USD cannot open it: "),
    ],
)
def test_what_has_no_meaning_is_refused(tmp_path: Path, content: str, complaint: str):
    with pytest.raises(DescriptionError, match=complaint):
        load(tmp_path, content)
