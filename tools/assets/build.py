"""Write every file of src/pybullet_data: `python -m tools.assets.build [NAME ...]` from the root."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import numpy as np
from tools.assets import (
    arms,
    cubes,
    floors,
    gym_humanoids,
    gym_runners,
    kuka,
    manipulators,
    panda,
    people,
    quadrupeds,
    r2d2,
    rovers,
    scenes,
    simple_meshes,
    soft_shapes,
    spheres,
    textures,
    things,
    toys,
)
from tools.assets.fields import Field
from tools.assets.mjcf_text import Model, mjcf_text
from tools.assets.obj_mesh import ObjMesh, material_text
from tools.assets.parts import Robot, Vector3
from tools.assets.png import png_bytes
from tools.assets.sdf_text import sdf_text
from tools.assets.surface import mesh_of
from tools.assets.urdf_text import urdf_text

TARGET = Path(__file__).resolve().parents[2] / "src" / "pybullet_data"

ROBOTS: dict[str, Callable[[], Robot]] = {
    "TwoJointRobot_w_fixedJoints.urdf": arms.two_joint_robot_with_fixed_joints,
    "TwoJointRobot_wo_fixedJoints.urdf": arms.two_joint_robot_without_fixed_joints,
    "a1/a1.urdf": quadrupeds.a1,
    "aliengo/aliengo.urdf": quadrupeds.aliengo,
    "bicycle/bike.urdf": rovers.bike,
    "biped/biped2d_pybullet.urdf": people.biped2d,
    "block.urdf": cubes.block,
    "cartpole.urdf": arms.cartpole,
    "cube.urdf": cubes.cube,
    "cube_collisionfilter.urdf": cubes.cube_collisionfilter,
    "cube_no_rotation.urdf": cubes.cube_no_rotation,
    "cube_rotate.urdf": cubes.cube_rotate,
    "cube_small.urdf": cubes.cube_small,
    "differential/diff_ring.urdf": rovers.diff_ring,
    "domino/domino.urdf": things.domino,
    "duck_vhacd.urdf": toys.duck,
    "franka_panda/panda.urdf": panda.panda,
    "humanoid/humanoid.urdf": people.humanoid,
    "husky/husky.urdf": rovers.husky,
    "jenga/jenga.urdf": things.jenga,
    "kuka_iiwa/model.urdf": kuka.model,
    "kuka_iiwa/model_free_base.urdf": kuka.model_free_base,
    "kuka_iiwa/model_vr_limits.urdf": kuka.model_vr_limits,
    "laikago/laikago.urdf": partial(quadrupeds.laikago, "laikago/laikago.urdf"),
    "laikago/laikago_toes.urdf": partial(quadrupeds.laikago, "laikago/laikago_toes.urdf"),
    "laikago/laikago_toes_limits.urdf": partial(quadrupeds.laikago, "laikago/laikago_toes_limits.urdf"),
    "laikago/laikago_toes_zup.urdf": partial(quadrupeds.laikago, "laikago/laikago_toes_zup.urdf"),
    "lego/lego.urdf": things.lego,
    "mini_cheetah/mini_cheetah.urdf": quadrupeds.mini_cheetah,
    "objects/mug.urdf": toys.mug,
    "pendulum5.urdf": arms.pendulum5,
    "plane.urdf": floors.plane,
    "plane100.urdf": floors.plane100,
    "plane_implicit.urdf": floors.plane_implicit,
    "plane_transparent.urdf": floors.plane_transparent,
    "pr2_gripper.urdf": manipulators.pr2_gripper,
    "quadruped/minitaur.urdf": partial(quadrupeds.minitaur, "quadruped/minitaur.urdf"),
    "quadruped/minitaur_v1.urdf": partial(quadrupeds.minitaur, "quadruped/minitaur_v1.urdf"),
    "quadruped/quadruped.urdf": quadrupeds.quadruped,
    "quadruped/spirit40.urdf": partial(quadrupeds.ghost, "quadruped/spirit40.urdf"),
    "quadruped/vision60.urdf": partial(quadrupeds.ghost, "quadruped/vision60.urdf"),
    "r2d2.urdf": r2d2.r2d2,
    "racecar/racecar.urdf": rovers.racecar,
    "racecar/racecar_differential.urdf": rovers.racecar_differential,
    "rrbot.urdf": arms.rrbot,
    "simple_arm.urdf": arms.simple_arm,
    "soccerball.urdf": spheres.soccerball,
    "sphere2.urdf": spheres.sphere2,
    "sphere2red.urdf": spheres.sphere2red,
    "sphere2red_nocol.urdf": spheres.sphere2red_nocol,
    "sphere8cube.urdf": spheres.sphere8cube,
    "sphere_1cm.urdf": spheres.sphere_1cm,
    "sphere_small.urdf": spheres.sphere_small,
    "sphere_transparent.urdf": spheres.sphere_transparent,
    "sphere_with_restitution.urdf": spheres.sphere_with_restitution,
    "spherical_joint_limit.urdf": arms.spherical_joint_limit,
    "table/table.urdf": things.table,
    "table_square/table_square.urdf": things.table_square,
    "samurai.urdf": soft_shapes.samurai,
    "teddy_large.urdf": partial(soft_shapes.teddy, "teddy_large.urdf"),
    "teddy_vhacd.urdf": partial(soft_shapes.teddy, "teddy_vhacd.urdf"),
    "tray/tray.urdf": things.tray,
    "tray/traybox.urdf": things.traybox,
    "xarm/xarm6_robot.urdf": partial(manipulators.xarm6, "xarm/xarm6_robot.urdf"),
    "xarm/xarm6_with_gripper.urdf": partial(manipulators.xarm6, "xarm/xarm6_with_gripper.urdf"),
}

ROBOTS |= {
    f"random_urdfs/{n:03d}/{n:03d}.urdf": partial(soft_shapes.blob, n) for n in range(soft_shapes.BLOBS)
}

SCENES: Mapping[str, Callable[[], scenes.Scene]] = {
    "gripper/wsg50_one_motor_gripper.sdf": partial(scenes.wsg50, "gripper/wsg50_one_motor_gripper.sdf"),
    "gripper/wsg50_one_motor_gripper_new.sdf": partial(
        scenes.wsg50, "gripper/wsg50_one_motor_gripper_new.sdf"
    ),
    "gripper/wsg50_one_motor_gripper_new_free_base.sdf": partial(
        scenes.wsg50, "gripper/wsg50_one_motor_gripper_new_free_base.sdf"
    ),
    "kiva_shelf/model.sdf": scenes.kiva_shelf,
    "kuka_iiwa/kuka_with_gripper.sdf": partial(scenes.kuka_arm, "kuka_iiwa/kuka_with_gripper.sdf"),
    "kuka_iiwa/kuka_with_gripper2.sdf": partial(scenes.kuka_arm, "kuka_iiwa/kuka_with_gripper2.sdf"),
    "kuka_iiwa/model.sdf": partial(scenes.kuka_arm, "kuka_iiwa/model.sdf"),
    "plane_stadium.sdf": partial(scenes.stadium, "plane_stadium.sdf"),
    "stadium.sdf": partial(scenes.stadium, "stadium.sdf"),
}

MODELS: Mapping[str, Callable[[], Model]] = {
    "mjcf/ant.xml": gym_runners.ant,
    "mjcf/ground_plane.xml": gym_runners.ground_plane,
    "mjcf/half_cheetah.xml": gym_runners.half_cheetah,
    "mjcf/hopper.xml": gym_runners.hopper,
    "mjcf/humanoid.xml": gym_humanoids.humanoid,
    "mjcf/humanoid_symmetric.xml": partial(gym_humanoids.humanoid_symmetric, 0.8),
    "mjcf/humanoid_symmetric_no_ground.xml": partial(gym_humanoids.humanoid_symmetric, 0.5),
    "mjcf/inverted_double_pendulum.xml": gym_runners.inverted_double_pendulum,
    "mjcf/inverted_pendulum.xml": gym_runners.inverted_pendulum,
    "mjcf/reacher.xml": gym_runners.reacher,
    "mjcf/swimmer.xml": gym_runners.swimmer,
    "mjcf/walker2d.xml": gym_runners.walker2d,
}

MATERIALS: Mapping[str, tuple[str, str]] = {
    "plane.mtl": ("floor", "checker_blue.png"),
    "grass.mtl": ("grass", "grass.png"),
    "duck.mtl": ("duck", "duck.png"),
    "cube.mtl": ("cube", "cube.png"),
    "textured_sphere_smooth.mtl": ("ball", "ball.png"),
    "soccerball.mtl": ("football", "football.png"),
    "table/table.mtl": ("wood", "table.png"),
    "table_square/table.mtl": ("wood", "table.png"),
}
"""Material libraries: name of the material in it, and its texture."""

TEXTURES: Mapping[str, Callable[[], textures.Colours]] = {
    "checker_blue.png": textures.floor,
    "cube.png": textures.framed,
    "ball.png": partial(textures.chessboard, 8, np.array((0.95, 0.95, 0.95)), np.array((0.75, 0.2, 0.18))),
    "duck.png": toys.duck_palette,
    "grass.png": textures.grass,
    "football.png": textures.football,
    "table/table.png": textures.wood,
    "table_square/table.png": textures.wood,
    "tex256.png": partial(textures.chessboard, 8, np.array((0.9, 0.9, 0.9)), np.array((0.35, 0.4, 0.5)), 256),
    "uvmap.png": textures.colour_grid,
}

TRAY_FLOOR: simple_meshes.Rectangle = (-0.21, -0.21, 0.21, 0.21)

MESHES: dict[str, Callable[[], ObjMesh]] = {
    "plane.obj": partial(simple_meshes.square, 15.0, 15.0, ("floor", "plane.mtl")),
    "grass.obj": partial(simple_meshes.square, 50.0, 25.0, ("grass", "grass.mtl")),
    "plane100.obj": partial(simple_meshes.square, 100.0, 100.0, ("floor", "plane.mtl")),
    "plane_transparent.obj": partial(simple_meshes.square, 15.0, 15.0, ("floor", "plane.mtl")),
    "bicycle/wheel.obj": rovers.wheel_disc,
    "cube.obj": partial(simple_meshes.textured_box, ("cube", "cube.mtl")),
    "duck.obj": toys.duck_mesh,
    "franka_panda/meshes/finger.obj": panda.finger_hull,
    "objects/mug.obj": toys.mug_mesh,
    "sphere_smooth.obj": partial(simple_meshes.globe, 1.0, 24, 14),
    "textured_sphere_smooth.obj": partial(
        simple_meshes.globe, 1.0, 24, 14, ("ball", "textured_sphere_smooth.mtl")
    ),
    "soccerball.obj": partial(simple_meshes.globe, 0.5, 24, 14, ("football", "soccerball.mtl")),
    "table/table.obj": partial(simple_meshes.textured_box, ("wood", "table.mtl")),
    "table_square/table.obj": partial(simple_meshes.textured_box, ("wood", "table.mtl")),
    "teddy.obj": soft_shapes.teddy_mesh,
    "tray/tray.obj": partial(simple_meshes.tray, TRAY_FLOOR, (-0.3, -0.3, 0.3, 0.3), (-0.005, 0.125), 0.012),
    "tray/tray_solid.obj": partial(
        simple_meshes.tray, TRAY_FLOOR, (-0.2969, -0.295, 0.2968, 0.3204), (-0.005, 0.1334), 0.012
    ),
}

MESHES |= {
    f"random_urdfs/{n:03d}/{n:03d}.obj": partial(soft_shapes.blob_mesh, n) for n in range(soft_shapes.BLOBS)
}

HOUSINGS: Mapping[str, tuple[Callable[[], Mapping[str, tuple[Field, Vector3, Vector3]]], float]] = {
    "franka_panda/meshes": (panda.fields, 0.019),
    "kuka_iiwa/meshes": (kuka.fields, 0.0235),
}
"""Folders of blended bodies: the fields, and the grid cell they are meshed with [m]."""


def _housing(field: Field, low: Vector3, high: Vector3, cell: float) -> ObjMesh:
    return mesh_of(field, np.asarray(low), np.asarray(high), cell)


def urdf_files() -> dict[str, str]:
    """The text of every URDF file, by its path in the data folder."""
    return {path: urdf_text(robot()) for path, robot in ROBOTS.items()}


def scene_files() -> dict[str, str]:
    """The text of every SDF and MJCF file."""
    made = {path: sdf_text(scene()) for path, scene in SCENES.items()}
    return made | {path: mjcf_text(model()) for path, model in MODELS.items()}


def mesh_files() -> dict[str, str]:
    """The text of every mesh and material file."""
    made = {path: material_text(name, texture) for path, (name, texture) in MATERIALS.items()}
    made |= {path: mesh().text() for path, mesh in MESHES.items()}
    for folder, (fields, cell) in HOUSINGS.items():
        made |= {f"{folder}/{name}.obj": _housing(*body, cell).text() for name, body in fields().items()}
    return made


def texture_files() -> dict[str, bytes]:
    """The bytes of every picture."""
    return {path: png_bytes(colours()) for path, colours in TEXTURES.items()}


def main(names: list[str]) -> None:
    texts = urdf_files() | scene_files() | mesh_files()
    for path, content in ({path: text.encode() for path, text in texts.items()} | texture_files()).items():
        if names and not any(name in path for name in names):
            continue
        target = TARGET / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)


if __name__ == "__main__":
    main(sys.argv[1:])
