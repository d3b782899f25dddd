"""SDF files as their format means them: axes, limits, springs, gearboxes, models inside models."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.errors import DescriptionError
from carom.world.scene import Scene

INERTIAL = """<inertial><pose>0 0 -0.5 0 0 0</pose><mass>2</mass>
<inertia><ixx>0.3</ixx><iyy>0.2</iyy><izz>0.1</izz><ixy>0.01</ixy></inertia></inertial>"""


def link(name: str, pose: str = "0 0 0 0 0 0", inside: str = INERTIAL) -> str:
    return f'<link name="{name}"><pose>{pose}</pose>{inside}</link>'


def joint(name: str, parent: str, child: str, inside: str = "", kind: str = "revolute") -> str:
    ends = f"<parent>{parent}</parent><child>{child}</child>"
    return f'<joint name="{name}" type="{kind}">{ends}{inside}</joint>'


def axis(xyz: str, inside: str = "", attributes: str = "") -> str:
    return f"<axis><xyz{attributes}>{xyz}</xyz>{inside}</axis>"


def load(tmp_path: Path, *parts: str, version: str = "1.9", static: bool = False) -> Scene:
    file = tmp_path / "m.sdf"
    text = "\n".join(parts)
    if static:
        base = text.split('<link name="')[1].split('"')[0]
        text += f'<joint name="held" type="fixed"><parent>world</parent><child>{base}</child></joint>'
    file.write_text(f'<sdf version="{version}"><model name="m">{text}</model></sdf>')
    return World().load(file, strict=True)


def test_inertia_is_that_of_the_file_and_no_air_brakes(tmp_path: Path):
    body = load(tmp_path, link("a"))[0]
    moments = np.linalg.eigvalsh([[0.3, 0.01, 0], [0.01, 0.2, 0], [0, 0, 0.1]])
    assert_allclose(sorted(body.dynamics(-1).inertia), moments, atol=1e-9)
    body.world.gravity = (0, 0, -10)
    body.world.step(10)
    assert_allclose(body.world.velocity[5], -10 * 10 / 240, rtol=1e-12)


def test_limits_that_are_not_stated_are_none(tmp_path: Path):
    parts = [link("a"), link("b"), link("c"), link("d")]
    parts += [joint("free", "a", "b", axis("0 0 1"))]
    parts += [joint("lower", "b", "c", axis("0 0 1", "<limit><lower>-1</lower><effort>-1</effort></limit>"))]
    limit = "<limit><lower>-1</lower><upper>2</upper><effort>3</effort><velocity>4</velocity></limit>"
    joints = load(tmp_path, *parts, joint("both", "c", "d", axis("0 0 1", limit)))[0].joints
    assert [joint.effort_limit for joint in joints] == [math.inf, math.inf, 3.0]
    assert joints["both"].limits == (-1.0, 2.0)
    assert joints["lower"].limits == (-1.0, math.inf)
    assert joints["free"].limits == (-math.inf, math.inf)


def test_dynamics_of_joints(tmp_path: Path):
    inside = "<damping>0.5</damping><friction>0.2</friction>"
    inside += "<spring_reference>0.1</spring_reference><spring_stiffness>7</spring_stiffness>"
    body = load(
        tmp_path, link("a"), link("b"), joint("j", "a", "b", axis("0 0 1", f"<dynamics>{inside}</dynamics>"))
    )[0]
    found = body.joints["j"]
    assert (found.damping, found.friction_loss) == (0.5, 0.2)
    assert (found.stiffness, found.spring_reference) == (7.0, 0.1)


@pytest.mark.parametrize(
    ("version", "attributes", "inside", "expected"),
    [
        ("1.9", "", "", (0, 1, 0)),
        ("1.5", "", "<use_parent_model_frame>1</use_parent_model_frame>", (1, 0, 0)),
        ("1.4", "", "", (1, 0, 0)),
        ("1.4", "", "<use_parent_model_frame>0</use_parent_model_frame>", (0, 1, 0)),
        ("1.9", ' expressed_in="__model__"', "", (1, 0, 0)),
        ("1.9", ' expressed_in="up"', "", (0, 0, 1)),
    ],
)
def test_frames_of_axes(
    tmp_path: Path, version: str, attributes: str, inside: str, expected: tuple[int, ...]
):
    # The child's x axis is the model's y axis; that of the frame is the model's z axis.
    parts = [
        link("a"),
        link("b", f"0 0 0 0 0 {math.pi / 2}"),
        joint("j", "a", "b", axis("1 0 0", inside, attributes)),
    ]
    parts += [f'<frame name="up"><pose>0 0 0 0 {-math.pi / 2} 0</pose></frame>']
    body = load(tmp_path, *parts, version=version, static=True)[0]
    body.joints["j"].reset(0.3)
    turned = body.links["b"].pose.orientation
    whole = (0.0, 0.0, math.sin(math.pi / 4), math.cos(math.pi / 4))
    axis_of_turn = _vector_of(_product(turned, _inverse(whole)))
    assert_allclose(axis_of_turn / np.linalg.norm(axis_of_turn), expected, atol=1e-9)


def _product(a, b):
    (u, s), (v, t) = (np.array(a[:3]), a[3]), (np.array(b[:3]), b[3])
    return (*(s * v + t * u + np.cross(u, v)), s * t - u @ v)


def _inverse(q):
    return (-q[0], -q[1], -q[2], q[3])


def _vector_of(q):
    return np.array(q[:3]) * np.sign(q[3])


def test_a_joint_is_where_its_pose_says(tmp_path: Path):
    """A pendulum about a joint one metre above the origin of its link, and one whose link is there itself."""
    falling = joint("j", "a", "b", "<pose>0 0 1 0 0 0</pose>" + axis("0 1 0"))
    apart = load(tmp_path, link("a"), link("b", "0 0 3 0 0 0"), falling, static=True)[0]
    shifted = INERTIAL.replace("0 0 -0.5 0 0 0", "0 0 -1.5 0 0 0")
    same = load(
        tmp_path,
        link("a"),
        link("b", "0 0 4 0 0 0", shifted),
        joint("j", "a", "b", axis("0 1 0")),
        static=True,
    )[0]
    for body in (apart, same):
        body.world.gravity = (0, 0, -10)
        body.joints["j"].reset(1.0)
        body.world.step(50)
    position, turn = apart.links["b"].pose
    angle = 2.0 * math.atan2(turn[1], turn[3])
    assert_allclose(position, (-math.sin(angle), 0, 4 - math.cos(angle)), atol=1e-12)
    assert apart.joints["j"].position == pytest.approx(same.joints["j"].position, abs=1e-12)
    assert_allclose(
        apart.links["b"].inertial_pose.position, same.links["b"].inertial_pose.position, atol=1e-12
    )


GEARED = (
    link("frame"), link("motor"), link("wheel", "1 0 0 0 0 0"),
    joint("of motor", "frame", "motor", axis("0 0 1")),
)  # fmt: skip


@pytest.mark.parametrize(
    ("of_wheel", "second", "expected"),
    [
        (joint("of wheel", "frame", "wheel", axis("0 0 1")), "", -0.5),
        (joint("of wheel", "frame", "wheel", axis("0 0 -1")), "<axis2><xyz>0 0 1</xyz></axis2>", 0.5),
    ],
)
def test_a_gearbox_ties_two_joints(tmp_path: Path, of_wheel: str, second: str, expected: float):
    inside = "<gearbox_reference_body>frame</gearbox_reference_body><gearbox_ratio>0.5</gearbox_ratio>"
    gears = joint("gears", "motor", "wheel", inside + axis("0 0 1") + second, kind="gearbox")
    body = load(tmp_path, *GEARED, of_wheel, gears, static=True)[0]
    body.joints["of motor"].set_torque(1.0)
    for _ in range(30):
        body.joints["of motor"].set_torque(1.0)
        body.world.step()
    turned = body.joints["of motor"].position
    assert turned > 0.01
    assert body.joints["of wheel"].position == pytest.approx(expected * turned, rel=1e-6)


def test_a_gearbox_needs_two_joints_on_its_reference_body(tmp_path: Path):
    inside = "<gearbox_reference_body>frame</gearbox_reference_body><gearbox_ratio>0.5</gearbox_ratio>"
    gears = joint("gears", "motor", "wheel", inside, kind="gearbox")
    fixed = joint("of wheel", "frame", "wheel", kind="fixed")
    with pytest.raises(DescriptionError, match="joints are not geared"):
        load(tmp_path, *GEARED, fixed, gears)
    with pytest.raises(DescriptionError, match="there is no link 'shaft'"):
        load(tmp_path, *GEARED, fixed, gears.replace(">motor<", ">shaft<"))


def test_models_inside_models(tmp_path: Path):
    """Links and joints inside have the names of their models before theirs, and their poses add up."""
    turned = f"0 0 1 0 0 {math.pi / 2}"
    hand = (
        link("palm", "1 0 0 0 0 0")
        + link("thumb", "2 0 0 0 0 0")
        + joint("bend", "palm", "thumb", axis("0 0 1"))
    )
    inner = f'<model name="hand"><pose>{turned}</pose>{hand}</model>'
    wrist = joint("wrist", "upper", "hand::palm", kind="fixed")
    middle = f'<model name="arm"><pose>10 0 0 0 0 0</pose>{link("upper")}{inner}{wrist}</model>'
    scene = load(
        tmp_path, link("base"), middle, joint("shoulder", "base", "arm::upper", axis("0 1 0")), static=True
    )
    (body,) = scene.bodies.values() if isinstance(scene.bodies, dict) else scene.bodies
    assert {it.name for it in body.links} == {
        "world",
        "base",
        "arm::upper",
        "arm::hand::palm",
        "arm::hand::thumb",
    }
    assert {it.name for it in body.joints} == {"held", "shoulder", "arm::wrist", "arm::hand::bend"}
    assert_allclose(body.links["arm::hand::thumb"].pose.position, (10, 2, 1), atol=1e-12)


def test_a_joint_to_the_world_holds_a_model(tmp_path: Path):
    body = load(tmp_path, link("a", "0 0 2 0 0 0"), joint("j", "world", "a", axis("0 1 0")))[0]
    body.world.gravity = (0, 0, -10)
    body.joints["j"].reset(0.5)
    body.world.step(20)
    assert_allclose(body.links["a"].pose.position, (0, 0, 2), atol=1e-12)
    assert abs(body.joints["j"].velocity) > 0.1
