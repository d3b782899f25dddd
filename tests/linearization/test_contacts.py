"""Linearised steps with contacts, beside central differences."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.linearization.scenes import ASSETS, assert_exact, new_world, set_velocity, statuses, tighten

from carom import Body, World

SURFACE = {"rolling_friction": 0.0, "spinning_friction": 0.0}


def on_plane(file: str, height: float, *, steps: int = 5, **surface: float) -> tuple[World, Body]:
    """A body on a plane, which it has come to penetrate a little."""
    world = new_world(plane=True)
    body = world.load_urdf(f"{ASSETS}/{file}", (0.0, 0.0, height))
    body.change_dynamics(-1, **{**SURFACE, **surface})
    world.step(steps)
    # At rest they are where the gap changes its sign, and with it the law of the contact.
    world.position[body.first_position + 2] -= 1e-4
    return world, body


PARAMETERS = ["masses", "friction"]


@pytest.mark.parametrize("torsion", [{}, {"rolling_friction": 0.01, "spinning_friction": 0.02}])
@pytest.mark.parametrize("friction", ["cone", "pyramid", "isotropic"])
def test_a_ball_rolls_and_slides(torsion, friction):
    world, ball = on_plane("sphere2.urdf", 0.5, **torsion)
    world.parameters.cone_friction = friction == "cone"
    world.parameters.isotropic_friction = friction == "isotropic"
    world.apply_parameters()
    set_velocity(ball, 0.0, 2.0, 0.1, 1.0, 0.0, 0.0)
    found = statuses(assert_exact(world, parameters=PARAMETERS))
    assert found["friction of contact 0 of box and sphere"] == ["holds", "holds"]
    # Without a cone there is none, as in PyBullet.
    spins = bool(torsion) and friction != "pyramid"
    assert ("spinning friction of contact 0 of box and sphere" in found) == spins
    set_velocity(ball, 0.0, 0.0, 0.3, 3.0, 1.0, 0.0)
    found = statuses(assert_exact(world, parameters=PARAMETERS))
    assert "holds" not in found["friction of contact 0 of box and sphere"]


@pytest.mark.parametrize("isotropic", [False, True])
def test_a_box_rests_slides_and_stands_on_a_corner(isotropic):
    world, box = on_plane("cube.urdf", 0.5)
    world.parameters.isotropic_friction = isotropic
    world.apply_parameters()
    set_velocity(box, *np.zeros(6))
    assert {status for _, status in assert_exact(world).rows} == {"holds"}
    set_velocity(box, 0.0, 0.0, 0.0, 1.0, 0.4, 0.0)
    # The sum of the impulses of four corners is known, not how they share it: no torque depends on that here.
    assert (
        statuses(assert_exact(world, parameters=PARAMETERS))["friction of contact 0 of box and box"]
        == ["slides"] * 2
    )
    tilted = new_world(plane=True)
    tilted.parameters.isotropic_friction = isotropic
    tilted.apply_parameters()
    box = tilted.load_urdf(f"{ASSETS}/cube.urdf", (0.0, 0.0, 0.83), (0.3, 0.2, 0.15, 1.0))
    set_velocity(box, 0.5, 0.4, 0.1, 2.6, 0.2, -0.6)
    while not tilted.linearize().rows:
        tilted.step()
    assert_exact(tilted, parameters=PARAMETERS)


def test_two_balls_meet():
    world = new_world()
    balls = [
        world.load_urdf(f"{ASSETS}/sphere2.urdf", place) for place in ((0.0, 0.0, 1.5), (0.3, 0.2, 2.43))
    ]
    for ball in balls:
        ball.change_dynamics(-1, restitution=0.0, **SURFACE)
    set_velocity(balls[1], 0.1, 0.2, 0.3, 0.1, -0.2, -2.0)
    while not world.linearize().rows:
        world.step()
    assert_exact(world, parameters=PARAMETERS)


def quadruped() -> str:
    """A box on four legs with knees and round feet, as URDF."""
    inertial = '<inertial><origin xyz="0 0 {z}"/><mass value="{m}"/>{inertia}</inertial>'
    inertia = '<inertia ixx="{i}" iyy="{i}" izz="{i}" ixy="0" ixz="0" iyz="0"/>'
    trunk, part = inertia.format(i=0.05), inertia.format(i=0.002)
    parts = [f'<link name="trunk">{inertial.format(z=0, m=5, inertia=trunk)}</link>']
    for leg, (x, y) in enumerate(((0.2, 0.1), (0.2, -0.1), (-0.2, 0.1), (-0.2, -0.1))):
        foot = '<collision><origin xyz="0 0 -0.2"/><geometry><sphere radius="0.03"/></geometry></collision>'
        for name, parent, origin, axis, shape in (
            (f"hip{leg}", "trunk", f"{x} {y} 0", "1 0 0", ""),
            (f"thigh{leg}", f"hip{leg}", "0 0 0", "0 1 0", ""),
            (f"knee{leg}", f"thigh{leg}", "0 0 -0.2", "0 1 0", foot),
        ):
            own = inertial.format(z=-0.1, m=0.3, inertia=part)
            parts.append(f'<link name="{name}">{own}{shape}</link>')
            parts.append(
                f'<joint name="{name}_joint" type="continuous"><parent link="{parent}"/>'
                f'<child link="{name}"/>'
                f'<origin xyz="{origin}"/><axis xyz="{axis}"/></joint>'
            )
    return f'<robot name="quadruped">{"".join(parts)}</robot>'


def test_a_quadruped_stands_on_its_feet_and_flies(tmp_path: Path):
    file = tmp_path / "quadruped.urdf"
    file.write_text(quadruped())
    world = new_world(plane=True)
    body = world.load_urdf(file, (0.0, 0.0, 0.38), as_pybullet=False)
    for link in range(-1, body.joint_count):
        body.change_dynamics(link, **SURFACE)
        if link >= 0:
            rest = (0.1, 0.5, -1.0)[link % 3]
            body.change_dynamics(link, joint_stiffness=100.0, joint_damping=2.0, joint_spring_reference=rest)
            body.joints[link].reset(rest)
    world.step(20)
    step = assert_exact(world, parameters=["masses", "stiffness"])
    assert sum(name.startswith("contact") for name, _ in step.rows) == 4
    # Feet that stick hold the trunk; in the air nothing does.
    world.position[body.first_position + 2] += 1.0
    assert not assert_exact(world, parameters=["masses"]).rows


@pytest.mark.parametrize("friction", ["cone", "pyramid", "isotropic"])
def test_feet_of_a_quadruped_slide(tmp_path: Path, friction: str):
    file = tmp_path / "quadruped.urdf"
    file.write_text(quadruped())
    world = new_world(plane=True)
    world.parameters.cone_friction = friction == "cone"
    world.parameters.isotropic_friction = friction == "isotropic"
    world.apply_parameters()
    body = world.load_urdf(file, (0.0, 0.0, 0.37), as_pybullet=False)
    for link in range(-1, body.joint_count):
        body.change_dynamics(link, **SURFACE)
        if link >= 0:
            body.joints[link].reset((0.1, 0.5, -1.0)[link % 3])
    set_velocity(body, 0.3, -0.2, 0.5, 1.0, 0.6, -0.4)
    step = assert_exact(world, parameters=["masses", "inertias", "armature", "friction"])
    sliding = [status for name, status in step.rows if name.startswith("friction of contact")]
    # The rows of a pyramid slide each for itself.
    assert len(sliding) >= 4
    assert len(sliding) // 2 <= len([status for status in sliding if status != "holds"])


@pytest.mark.parametrize("sliding", [False, True])
def test_a_ball_and_a_corner_touch_faces_that_move(sliding: bool):
    for file, turn in (("sphere2.urdf", (0.0, 0.0, 0.0, 1.0)), ("cube.urdf", (0.3, 0.2, 0.15, 1.0))):
        world = new_world()
        below = world.load_urdf(f"{ASSETS}/cube.urdf", (0.0, 0.0, 0.0), (0.1, 0.05, 0.2, 1.0))
        above = world.load_urdf(f"{ASSETS}/{file}", (0.05, -0.1, 1.5), turn)
        for body in (below, above):
            body.change_dynamics(-1, restitution=0.0, lateral_friction=0.1 if sliding else 2.0, **SURFACE)
        set_velocity(below, 0.2, -0.3, 0.4, 0.1, 0.2, 0.3)
        set_velocity(above, 0.3, 0.1, -0.2, 0.3, 0.1, -2.0)
        for _ in range(100):
            world.step()
            if world.linearize().rows:
                break
        found = assert_exact(world, parameters=PARAMETERS)
        of_friction = {status for name, status in found.rows if name.startswith("friction")}
        assert of_friction == ({"slides"} if sliding else {"holds"})


def test_stiff_contacts_are_springs():
    world, ball = on_plane("sphere2.urdf", 0.5, contact_stiffness=1e4, contact_damping=100.0)
    set_velocity(ball, 0.0, 2.0, 0.1, 1.0, 0.0, -0.1)
    assert_exact(world, parameters=PARAMETERS)


@pytest.mark.parametrize(
    ("what", "message"),
    [
        ({"restitution": 0.9}, "a bounce has no exact derivatives"),
        ({"anisotropic_friction": (1.0, 0.1, 1.0)}, "anisotropic friction"),
    ],
)
def test_what_has_no_exact_derivatives_is_named(what: dict[str, Any], message: str):
    world, ball = on_plane("sphere2.urdf", 0.5, **what)
    world.bodies[0].change_dynamics(-1, restitution=0.9)
    set_velocity(ball, 0.0, 0.0, 0.0, 0.0, 0.0, -1.0)
    with pytest.raises(NotImplementedError, match=message):
        world.linearize(method="exact")
    assert np.isfinite(world.linearize(method="differences").A).all()


def test_contacts_with_a_moving_fixed_base_are_refused():
    world, _ = on_plane("sphere2.urdf", 0.5)
    assert world.linearize().rows
    set_velocity(world.bodies[0], 0.0, 0.3, 0.0, 0.2, 0.0, 0.0)
    with pytest.raises(NotImplementedError, match=r"fixed base that has a velocity"):
        world.linearize(method="exact")
    world.linearize(method="differences")


FINGER = """
<robot name="finger"><link name="base"/><link name="tip"><inertial><mass value="1"/>
<inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><geometry><sphere radius=".05"/></geometry></collision></link>
<joint name="x" type="prismatic"><parent link="base"/><child link="tip"/><axis xyz="1 0 0"/>
<limit lower="-1" upper="3" effort="100" velocity="10"/></joint></robot>"""


def test_contacts_that_are_kept_from_the_step_before_are_exact(tmp_path):
    path = tmp_path / "finger.urdf"
    path.write_text(FINGER)
    world = World(1 / 100, contact="bullet")
    world.gravity = (0.0, 0.0, -9.81)
    world.add_plane()
    world.add_box((0.1, 0.1, 0.1), (0.3, 0.0, 0.1), mass=1.0)
    finger = world.load_urdf(str(path), (0.0, 0.0, 0.1), fixed_base=True)
    finger.joints.free()
    kept = 0
    for row in range(50):
        finger.joints.set_torques([6.0])
        if row >= 33:
            held = world.copy()
            tighten(held)
            held.bodies[finger.id].joints.set_torques([6.0])
            exact = held.linearize()
            near = held.linearize(method="differences")
            touching = sum("box and sphere" in name for name, _ in exact.rows)
            # Some steps are at a switch.
            kept += touching > 2 and np.abs(exact.A - near.A).max() < 1e-5 * np.abs(near.A).max()
        world.step()
    assert kept >= 5
