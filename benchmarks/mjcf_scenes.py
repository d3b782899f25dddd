"""Scenes of robots and heaps as MJCF, the same text for Carom and MuJoCo. Neither is imported here."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Iterable

TIME_STEP = 0.002
_OPTION = f'<option timestep="{TIME_STEP}"/><compiler angle="radian"/>'
# Corners of a tile and a wedge: two hulls beside the simple shapes.
_TILE = (
    "-.04 -.03 -.015  .04 -.03 -.015  -.04 .03 -.015  .04 .03 -.015  0 -.02 .02  .02 .01 .02  -.02 .01 .02"
)
_WEDGE = "-.035 -.03 -.02  .035 -.03 -.02  -.035 .03 -.02  .035 .03 -.02  -.035 0 .03  .035 0 .03"
_MESHES = f'<asset><mesh name="tile" vertex="{_TILE}"/><mesh name="wedge" vertex="{_WEDGE}"/></asset>'
_MIXED = (
    'type="box" size=".035 .025 .02"',
    'type="sphere" size=".03"',
    'type="capsule" size=".02 .03"',
    'type="cylinder" size=".025 .03"',
    'type="ellipsoid" size=".04 .03 .02"',
    'type="mesh" mesh="tile"',
    'type="mesh" mesh="wedge"',
)
_KINDS_OF_SENSORS = "framepos", "framequat", "framelinvel", "frameangvel"


def _model(name: str, body: str, after: str = "", assets: str = "") -> str:
    return f'<mujoco model="{name}">{_OPTION}{assets}<worldbody>{body}</worldbody>{after}</mujoco>'


def _servos(joints: Iterable[str], kp: float, kv: float, force: float) -> str:
    rows = (
        f'<position joint="{joint}" kp="{kp}" kv="{kv}" forcerange="{-force} {force}" inheritrange="1"/>'
        for joint in joints
    )
    return f"<actuator>{''.join(rows)}</actuator>"


def hand() -> str:
    """A palm with five fingers of four joints, whose links are hulls, that closes on a ball."""
    fingers, joints = [], []
    links = (0.045, 0.03, 0.025)
    for number in range(5):
        angle = -0.9 + 0.45 * number if number < 4 else math.pi
        x, y = 0.045 * math.cos(angle), 0.045 * math.sin(angle)
        inner = ""
        for link in (2, 1, 0):
            name = f"f{number}_{link}"
            joints.append(name)
            half = links[link] / 2.0
            hull = " ".join(
                f"{sx * w} {sy * w} {z}"
                for z, w in ((0.0, 0.009), (half, 0.01), (2.0 * half, 0.007))
                for sx in (-1, 1)
                for sy in (-1, 1)
            )
            inner = (
                f'<body pos="0 0 {links[link - 1] if link else 0.0}">'
                f'<joint name="{name}" axis="0 -1 0" range="-0.3 1.6" damping="0.02" armature="0.0005"/>'
                f'<geom type="mesh" mesh="{name}" mass="0.02" friction="1"/>{inner}</body>'
            )
            fingers.append(f'<mesh name="{name}" vertex="{hull}"/>')
        spread = f"s{number}"
        joints.append(spread)
        fingers.append(
            f'\n<body pos="{x} {y} 0.012" euler="0 0 {angle}"><joint name="{spread}" axis="1 0 0" '
            f'range="-0.3 0.3" damping="0.02" armature="0.0005"/><geom type="sphere" size=".008" mass="0.01" '
            f'contype="0" conaffinity="0"/>{inner}</body>'
        )
    meshes = "".join(text for text in fingers if text.startswith("<mesh"))
    bodies = "".join(text for text in fingers if not text.startswith("<mesh"))
    palm = f'<body pos="0 0 0.1"><geom type="cylinder" size="0.055 0.01" mass="0.3"/>{bodies}</body>'
    ball = '<body pos="0 0 0.1452"><freejoint/><geom type="sphere" size="0.035" mass="0.1"/></body>'
    floor = '<geom type="plane" size="1 1 .1"/>'
    return _model("hand", floor + palm + ball, _servos(joints, 2.0, 0.05, 1.0), f"<asset>{meshes}</asset>")


def bin_of_shapes(count: int = 20) -> str:
    """Mixed shapes, hulls and ellipsoids among them, that fall into a bin."""
    chance = random.Random(0)
    walls = '<geom type="plane" size="1 1 .1"/>'
    for x, y, sx, sy in (
        (0.16, 0, 0.01, 0.16),
        (-0.16, 0, 0.01, 0.16),
        (0, 0.16, 0.16, 0.01),
        (0, -0.16, 0.16, 0.01),
    ):
        walls += f'<geom type="box" pos="{x} {y} 0.15" size="{sx} {sy} 0.15"/>'
    shapes = ""
    for number in range(count):
        x = (number % 4 - 1.5) * 0.075 + chance.uniform(-0.005, 0.005)
        y, z = (number // 4 % 2 - 0.5) * 0.12, 0.06 + 0.1 * (number // 8)
        turn = " ".join(f"{chance.uniform(-3.0, 3.0):.3f}" for _ in range(3))
        shapes += (
            f'<body pos="{x:.4f} {y} {z}" euler="{turn}"><freejoint/>'
            f'<geom {_MIXED[number % len(_MIXED)]} mass="0.1"/></body>'
        )
    return _model("bin", walls + shapes, assets=_MESHES)


def humanoid() -> str:
    """A humanoid of 21 joints with 33 sensors on a floor."""
    joints: list[str] = []

    def hinge(name: str, axis: str, low: float, high: float) -> str:
        joints.append(name)
        passive = 'damping="1" armature="0.02" stiffness="2"'
        return f'<joint name="{name}" axis="{axis}" range="{low} {high}" {passive}/>'

    def limb(end: str, size: float, mass: float) -> str:
        return f'<geom type="capsule" fromto="0 0 0 {end}" size="{size}" mass="{mass}"/>'

    limbs, feet = "", []
    for side, y in (("right", -0.1), ("left", 0.1)):
        feet.append(f"{side}_foot")
        limbs += (
            f'<body name="{side}_thigh" pos="0 {y} -0.05">'
            + hinge(f"{side}_hip_x", "1 0 0", -0.4, 0.4)
            + hinge(f"{side}_hip_z", "0 0 1", -0.6, 0.6)
            + hinge(f"{side}_hip_y", "0 1 0", -1.9, 0.7)
            + limb("0 0 -0.34", 0.055, 4.0)
            + f'<body name="{side}_shin" pos="0 0 -0.4">'
            + hinge(f"{side}_knee", "0 1 0", -0.05, 2.6)
            + limb("0 0 -0.3", 0.045, 2.5)
            + f'<body name="{side}_foot" pos="0 0 -0.36">'
            + hinge(f"{side}_ankle_y", "0 1 0", -0.8, 0.8)
            + hinge(f"{side}_ankle_x", "1 0 0", -0.5, 0.5)
            + '<geom type="capsule" fromto="-0.07 -0.02 0 0.14 -0.04 0" size="0.027" mass="0.8"/>'
            + '<geom type="capsule" fromto="-0.07 0.02 0 0.14 0.04 0" size="0.027" mass="0.8"/>'
            + f'<site name="{side}_sole"/></body></body></body>'
        )
    for side, y in (("right", -0.17), ("left", 0.17)):
        limbs += (
            f'<body name="{side}_upper_arm" pos="0 {y} 0.42">'
            + hinge(f"{side}_shoulder1", "2 1 1", -1.5, 1.0)
            + hinge(f"{side}_shoulder2", "0 -1 1", -1.5, 1.0)
            + limb("0.16 0 -0.16", 0.04, 1.6)
            + f'<body name="{side}_lower_arm" pos="0.18 0 -0.18">'
            + hinge(f"{side}_elbow", "0 -1 1", -1.5, 0.8)
            + limb("0.15 0 0.15", 0.032, 1.2)
            + "</body></body>"
        )
    torso = (
        '<body name="torso" pos="0 0 0.93"><freejoint name="root"/>'
        '<geom type="capsule" fromto="0 -.07 0.3 0 .07 0.3" size="0.07" mass="8"/>'
        '<geom type="sphere" pos="0 0 0.55" size="0.09" mass="3"/><site name="imu" pos="0 0 0.2"/>'
        + '<geom type="capsule" fromto="0 -.06 0 0 .06 0" size="0.08" mass="8"/>'
        + limbs
        + '<body name="neck" pos="0 0 0.5">'
        + hinge("neck_z", "0 0 1", -0.7, 0.7)
        + hinge("neck_y", "0 1 0", -0.5, 0.5)
        + hinge("neck_x", "1 0 0", -0.3, 0.3)
        + '<geom type="sphere" pos="0 0 0.1" size="0.05" mass="1"/></body></body>'
    )
    motors = "".join(f'<motor joint="{joint}" gear="40" ctrlrange="-1 1"/>' for joint in joints)
    sensors = '<accelerometer site="imu"/><gyro site="imu"/><velocimeter site="imu"/>'
    sensors += "".join(f'<touch site="{foot[:-5]}_sole"/><force site="{foot[:-5]}_sole"/>' for foot in feet)
    sensors += "".join(f'<jointpos joint="{joint}"/>' for joint in joints[:18])
    for body in ("right_foot", "left_foot"):
        sensors += "".join(f'<{kind} objtype="body" objname="{body}"/>' for kind in _KINDS_OF_SENSORS)
    floor = '<geom type="plane" size="10 10 .1"/>'
    return _model("humanoid", floor + torso, f"<actuator>{motors}</actuator><sensor>{sensors}</sensor>")


def quadruped() -> str:
    """A quadruped of twelve servos with an IMU and feet that feel, on a floor."""
    legs, joints, sensors = (
        "",
        [],
        '<accelerometer site="imu"/><gyro site="imu"/><framequat objtype="site" objname="imu"/>',
    )
    for x, y, name in ((0.19, -0.05, "fr"), (0.19, 0.05, "fl"), (-0.19, -0.05, "rr"), (-0.19, 0.05, "rl")):
        hip, thigh, calf = (f"{name}_{part}" for part in ("hip", "thigh", "calf"))
        joints += [hip, thigh, calf]
        out = math.copysign(0.085, y)
        link = 'damping="0.5" armature="0.01"'
        legs += (
            f'<body pos="{x} {y} 0"><joint name="{hip}" axis="1 0 0" range="-0.8 0.8" {link}/>'
            '<geom type="cylinder" size="0.045 0.02" euler="1.5708 0 0" mass="0.7" contype="0" '
            'conaffinity="0"/>'
            f'<body pos="0 {out} 0" euler="0 0.8 0">'
            f'<joint name="{thigh}" axis="0 1 0" range="-1.8 3.2" {link}/>'
            '<geom type="box" size="0.012 0.012 0.1" pos="0 0 -0.1" mass="1"/>'
            f'<body pos="0 0 -0.2" euler="0 -1.5 0">'
            f'<joint name="{calf}" axis="0 1 0" range="-1.2 0.6" {link}/>'
            '<geom type="box" size="0.008 0.008 0.095" pos="0 0 -0.095" mass="0.2"/>'
            '<geom type="sphere" size="0.022" pos="0 0 -0.2" mass="0.06" friction="0.8 0.02 0.01" '
            'condim="6"/>'
            f'<site name="{name}" pos="0 0 -0.2" size="0.03"/></body></body></body>'
        )
        sensors += f'<touch site="{name}"/>'
    trunk = (
        '<body name="trunk" pos="0 0 0.3"><freejoint/><geom type="box" size="0.13 0.06 0.05" mass="5"/>'
        f'<site name="imu"/>{legs}</body>'
    )
    servos = _servos(joints, 60.0, 2.0, 33.0)
    return _model(
        "quadruped", '<geom type="plane" size="5 5 .1"/>' + trunk, f"{servos}<sensor>{sensors}</sensor>"
    )


def arm() -> str:
    """An arm of seven servos over a table, nothing of which touches."""
    inner, joints = "", []
    for number in reversed(range(7)):
        name = f"j{number}"
        joints.insert(0, name)
        axis = "0 0 1" if number % 2 == 0 else "0 1 0"
        inner = (
            f'<body pos="0 0 {0.16 if number else 0.0}"><joint name="{name}" axis="{axis}" '
            'range="-2.2 2.2" damping="1" armature="0.1"/>'
            '<geom type="capsule" fromto="0 0 0 0 0 0.15" size="0.045" '
            f'mass="{3.0 - 0.3 * number:.1f}"/>{inner}</body>'
        )
    servos = _servos(joints, 800.0, 60.0, 90.0)
    return _model("arm", f'<geom type="plane" pos="0 0 -0.1" size="2 2 .1"/>{inner}', servos)


CONTROLS: dict[str, tuple[float, float]] = {
    "hand": (0.9, 0.3),
    "sensing humanoid": (0.0, 0.5),
    "quadruped": (0.0, 0.3),
    "arm": (0.0, 0.5),
}
"""Controls of the scenes that have some: around the first number, at most the second one apart."""

SCENES: dict[str, Callable[[], str]] = {
    "hand": hand,
    "bin": bin_of_shapes,
    "sensing humanoid": humanoid,
    "quadruped": quadruped,
    "arm": arm,
}
