"""Every file of src/pybullet_data, and what makes it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
from tools.assets import (
    arms,
    blocks_to_sort,
    cubes,
    floors,
    grounds,
    gym_arms,
    gym_humanoids,
    gym_runners,
    gym_shapes,
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
    xarm_looks,
)
from tools.assets.fields import Field
from tools.assets.housings import kuka_links, panda_links
from tools.assets.housings.lofts import Loft
from tools.assets.mjcf_text import Model
from tools.assets.obj_mesh import ObjMesh, ObjParts
from tools.assets.parts import Robot, Vector3
from tools.assets.random_objects import beams

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
    "cloth_z_up.urdf": soft_shapes.cloth,
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
    "lego/lego.urdf": things.lego,
    "mini_cheetah/mini_cheetah.urdf": quadrupeds.mini_cheetah,
    "objects/mug.urdf": toys.mug,
    "pendulum5.urdf": arms.pendulum5,
    "plane.urdf": floors.plane,
    "plane100.urdf": floors.plane100,
    "plane_implicit.urdf": floors.plane_implicit,
    "plane_transparent.urdf": floors.plane_transparent,
    "pr2_gripper.urdf": manipulators.pr2_gripper,
    "quadruped/quadruped.urdf": quadrupeds.quadruped,
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
    "toys/concave_box.urdf": blocks_to_sort.concave_box,
    "tray/tray.urdf": things.tray,
    "tray/tray_textured2.urdf": things.textured_tray,
    "tray/traybox.urdf": things.traybox,
    "urdf/mug.urdf": toys.mug,
}

FAMILIES: Mapping[Callable[[str], Robot], tuple[str, ...]] = {
    quadrupeds.laikago: (
        "laikago/laikago.urdf",
        "laikago/laikago_toes.urdf",
        "laikago/laikago_toes_limits.urdf",
        "laikago/laikago_toes_zup.urdf",
        "laikago/laikago_toes_zup_lores.urdf",
    ),
    quadrupeds.minitaur: (
        "quadruped/microtaur/microtaur.urdf",
        "quadruped/minitaur.urdf",
        "quadruped/minitaur_derpy.urdf",
        "quadruped/minitaur_fixed_all.urdf",
        "quadruped/minitaur_fixed_knees.urdf",
        "quadruped/minitaur_rainbow_dash.urdf",
        "quadruped/minitaur_rainbow_dash_v1.urdf",
        "quadruped/minitaur_single_motor.urdf",
        "quadruped/minitaur_v1.urdf",
    ),
    quadrupeds.ghost: (
        "quadruped/spirit40.urdf",
        "quadruped/spirit40newer.urdf",
        "quadruped/vision60.urdf",
    ),
    manipulators.xarm6: (
        "xarm/xarm6_robot.urdf",
        "xarm/xarm6_robot_white.urdf",
        "xarm/xarm6_with_gripper.urdf",
    ),
    manipulators.xarm6_link: (
        "xarm/base.urdf",
        "xarm/base_com.urdf",
        *(f"xarm/link{number}{kind}.urdf" for number in range(1, 7) for kind in ("", "_com")),
    ),
    scenes.wsg50_finger: (
        "gripper/wsg50_one_motor_gripper_left_finger.urdf",
        "gripper/wsg50_one_motor_gripper_right_finger.urdf",
    ),
    soft_shapes.teddy: (
        "teddy_large.urdf",
        "teddy_vhacd.urdf",
    ),
}
"""Robots that are made alike, by what makes them of the name of their file."""

ROBOTS |= {path: partial(make, path) for make, paths in FAMILIES.items() for path in paths}
ROBOTS |= {f"random_urdfs/{n:03d}/{n:03d}.urdf": partial(beams.robot, n) for n in range(beams.COUNT)}

SCENE_FAMILIES: Mapping[Callable[[str], scenes.Scene], tuple[str, ...]] = {
    scenes.wsg50: (
        "gripper/wsg50_one_motor_gripper.sdf",
        "gripper/wsg50_one_motor_gripper_new.sdf",
        "gripper/wsg50_one_motor_gripper_new_free_base.sdf",
        "gripper/wsg50_one_motor_gripper_no_finger.sdf",
        "gripper/wsg50_with_r2d2_gripper.sdf",
    ),
    scenes.kuka_arm: (
        "kuka_iiwa/kuka_with_gripper.sdf",
        "kuka_iiwa/kuka_with_gripper2.sdf",
        "kuka_iiwa/model.sdf",
    ),
    scenes.stadium: (
        "plane_stadium.sdf",
        "stadium.sdf",
        "stadium_no_collision.sdf",
    ),
}

SCENES: dict[str, Callable[[], scenes.Scene]] = {
    "kiva_shelf/model.sdf": scenes.kiva_shelf,
}
SCENES |= {path: partial(make, path) for make, paths in SCENE_FAMILIES.items() for path in paths}

MODELS: Mapping[str, Callable[[], Model]] = {
    "mjcf/ant.xml": gym_runners.ant,
    "mjcf/capsule.xml": partial(gym_shapes.long_shape, "capsule", None),
    "mjcf/capsule_fromtoX.xml": partial(gym_shapes.long_shape, "capsule", gym_runners.X),
    "mjcf/capsule_fromtoY.xml": partial(gym_shapes.long_shape, "capsule", gym_runners.Y),
    "mjcf/capsule_fromtoZ.xml": partial(gym_shapes.long_shape, "capsule", gym_runners.Z),
    "mjcf/cylinder.xml": partial(gym_shapes.long_shape, "cylinder", None),
    "mjcf/cylinder_fromtoX.xml": partial(gym_shapes.long_shape, "cylinder", gym_runners.X),
    "mjcf/cylinder_fromtoY.xml": partial(gym_shapes.long_shape, "cylinder", gym_runners.Y),
    "mjcf/cylinder_fromtoZ.xml": partial(gym_shapes.long_shape, "cylinder", gym_runners.Z),
    "mjcf/ground.xml": gym_shapes.ground,
    "mjcf/ground_plane.xml": gym_shapes.ground_plane,
    "mjcf/half_cheetah.xml": gym_runners.half_cheetah,
    "mjcf/hello_mjcf.xml": gym_shapes.hello,
    "mjcf/hopper.xml": gym_runners.hopper,
    "mjcf/humanoid.xml": gym_humanoids.humanoid,
    "mjcf/humanoid_fixed.xml": partial(gym_humanoids.humanoid_symmetric, 0.5, stands_free=False),
    "mjcf/humanoid_symmetric.xml": partial(gym_humanoids.humanoid_symmetric, 0.8),
    "mjcf/humanoid_symmetric_no_ground.xml": partial(gym_humanoids.humanoid_symmetric, 0.5),
    "mjcf/inverted_double_pendulum.xml": gym_runners.inverted_double_pendulum,
    "mjcf/inverted_pendulum.xml": gym_runners.inverted_pendulum,
    "mjcf/pusher.xml": gym_arms.pusher,
    "mjcf/reacher.xml": gym_runners.reacher,
    "mjcf/striker.xml": gym_arms.striker,
    "mjcf/swimmer.xml": gym_runners.swimmer,
    "mjcf/thrower.xml": gym_arms.thrower,
    "mjcf/walker2d.xml": gym_runners.walker2d,
}

MATERIALS: Mapping[str, tuple[str, str]] = {
    "plane.mtl": ("floor", "checker_blue.png"),
    "grass.mtl": ("grass", "grass.png"),
    "duck.mtl": ("duck", "duck.png"),
    "cube.mtl": ("cube", "cube.png"),
    "cloth_z_up.mtl": ("cloth", "cube.png"),
    "textured_sphere_smooth.mtl": ("ball", "ball.png"),
    "soccerball.mtl": ("football", "football.png"),
    "jenga/jenga.mtl": ("jenga", "jenga.png"),
    "table/table.mtl": ("wood", "table.png"),
    "table_square/table.mtl": ("checkers", "checker_grid.jpg"),
}
"""Material libraries: name of the material in it, and its texture."""

TEXTURES: Mapping[str, Callable[[], textures.Colours]] = {
    "checker_blue.png": textures.floor,
    "cube.png": textures.framed,
    "ball.png": partial(textures.chessboard, 8, np.array((0.95, 0.95, 0.95)), np.array((0.75, 0.2, 0.18))),
    "duck.png": toys.duck_palette,
    "grass.png": textures.grass,
    "football.png": textures.football,
    "duckCM.png": toys.duck_palette,
    "jenga/jenga.png": textures.wood,
    "table/table.png": partial(textures.wood, np.array((0.945, 0.836, 0.69))),
    "table_square/checker_grid.jpg": partial(
        textures.chessboard, 10, np.array((0.0, 0.0, 0.0)), np.array((1.0, 1.0, 1.0)), 512
    ),
    "tray/tray.jpg": textures.wood,
    "tex256.png": partial(textures.chessboard, 8, np.array((0.9, 0.9, 0.9)), np.array((0.35, 0.4, 0.5)), 256),
    "uvmap.png": textures.colour_grid,
    "checker_grid.jpg": partial(
        textures.chessboard, 10, np.array((0.0, 0.0, 0.0)), np.array((1.0, 1.0, 1.0)), 512
    ),
    "checker_huge.gif": partial(
        textures.chessboard, 2, np.array((1.0, 1.0, 1.0)), np.array((0.6, 0.7, 0.8)), 256
    ),
    "colors16.png": textures.colour_grid,
    "heightmaps/Image8x4.png": grounds.steps_of_grey,
    "heightmaps/Maze.png": grounds.maze,
    "heightmaps/gimp_overlay_out.png": grounds.hills_painted,
    "heightmaps/wm_height_out.png": grounds.hills,
}

TRAY_FLOOR: simple_meshes.Rectangle = (-0.21, -0.21, 0.21, 0.21)
LARGE_TRAY = partial(
    simple_meshes.tray_hulls,
    (-0.42, -0.42, 0.42, 0.42),
    (-0.5901, -0.5901, 0.5901, 0.5901),
    (-0.01, 0.2612),
    0.024,
)

MESHES: dict[str, Callable[[], ObjMesh | ObjParts]] = {
    "ball.obj": partial(simple_meshes.globe, 1.0, 36, 10),
    "bunny.obj": soft_shapes.bunny_mesh,
    "duck_vhacd.obj": toys.duck_hulls,
    "samurai_monastry.obj": grounds.courtyard,
    "stone.obj": grounds.stone,
    "terrain.obj": grounds.land,
    "plane.obj": partial(simple_meshes.square, 15.0, 15.0, ("floor", "plane.mtl")),
    "grass.obj": partial(simple_meshes.square, 50.0, 25.0, ("grass", "grass.mtl")),
    "plane100.obj": partial(simple_meshes.square, 100.0, 100.0, ("floor", "plane.mtl")),
    "plane_transparent.obj": partial(simple_meshes.square, 15.0, 15.0, ("floor", "plane.mtl")),
    "bicycle/wheel.obj": rovers.wheel_disc,
    "cloth.obj": partial(simple_meshes.sheet, 1.0, 4, upright=True),
    "cloth_z_up.obj": partial(simple_meshes.sheet, 1.0, 4, material=("cloth", "cloth_z_up.mtl")),
    "cube.obj": partial(simple_meshes.textured_box, ("cube", "cube.mtl")),
    "domino/domino.obj": blocks_to_sort.domino_tile,
    "duck.obj": toys.duck_mesh,
    "franka_panda/meshes/finger.obj": panda.finger_hull,
    "jenga/jenga.obj": blocks_to_sort.jenga_brick,
    "lego/lego.obj": blocks_to_sort.lego_brick,
    "lego/lego_vhacd.obj": blocks_to_sort.lego_hulls,
    "objects/mug.obj": toys.mug_mesh,
    "objects/mug_col.obj": toys.mug_hulls,
    "quadruped/tmotor3.obj": blocks_to_sort.motor,
    "sphere_smooth.obj": partial(simple_meshes.globe, 1.0, 24, 14),
    "textured_sphere_smooth.obj": partial(
        simple_meshes.globe, 1.0, 24, 14, ("ball", "textured_sphere_smooth.mtl")
    ),
    "soccerball.obj": partial(simple_meshes.globe, 0.5, 24, 14, ("football", "soccerball.mtl")),
    "table/table.obj": partial(simple_meshes.textured_box, ("wood", "table.mtl")),
    "table_square/table.obj": partial(simple_meshes.textured_box, ("checkers", "table.mtl")),
    "teddy.obj": soft_shapes.teddy_mesh,
    "teddy2_VHACD_CHs.obj": soft_shapes.teddy_hulls,
    "torus/torus_textured.obj": partial(simple_meshes.ring, 0.5, 0.25, 32, 16),
    "toys/concave_box.obj": blocks_to_sort.concave_box_mesh,
    "toys/cube.obj": blocks_to_sort.cube,
    "toys/cylinder.obj": blocks_to_sort.cylinder,
    "toys/prism.obj": blocks_to_sort.prism,
    "toys/shape_sorter.obj": blocks_to_sort.shape_sorter,
    "tray/tray.obj": partial(simple_meshes.tray, TRAY_FLOOR, (-0.3, -0.3, 0.3, 0.3), (-0.005, 0.125), 0.012),
    "tray/tray_solid.obj": partial(
        simple_meshes.tray_hulls, TRAY_FLOOR, (-0.2969, -0.295, 0.2968, 0.3204), (-0.005, 0.1334), 0.012
    ),
}

MESHES |= {f"urdf/{name}.obj": MESHES[f"objects/{name}.obj"] for name in ("mug", "mug_col")}
MESHES |= {f"tray/tray_textured{kind}.obj": LARGE_TRAY for kind in ("", "2", "4")}
MESHES |= {f"random_urdfs/{n:03d}/{n:03d}.obj": partial(beams.mesh, n) for n in range(beams.COUNT)}

BLENDED: Mapping[str, tuple[Callable[[], Mapping[str, tuple[Field, Vector3, Vector3]]], float]] = {
    "xarm/meshes": (xarm_looks.fields, 0.017),
}
"""Folders of blended bodies: the fields, and the grid cell of their meshes [m]."""

LOFTED: Mapping[str, Mapping[str, tuple[Loft, ...]]] = {
    "franka_panda/meshes": panda_links.LOFTS,
    "kuka_iiwa/meshes": kuka_links.LOFTS,
}
"""Folders of lofted bodies."""

STL_MESHES: Mapping[str, Callable[[], ObjMesh]] = {
    "l_finger.stl": partial(manipulators.finger_mesh, (-0.0092, -0.009, -0.0278), (0.0954, 0.0458, 0.0278)),
    "l_finger_collision.stl": partial(
        manipulators.finger_mesh, (-0.0082, -0.0039, -0.0276), (0.0953, 0.0458, 0.0274)
    ),
    "l_finger_tip.stl": partial(
        manipulators.finger_mesh, (-0.0256, -0.0159, -0.0115), (0.0312, 0.0288, 0.0115)
    ),
}

COLLADA_MESHES: Mapping[str, tuple[str, Callable[[], ObjMesh]]] = {"duck.dae": ("duck", toys.duck_mesh)}
"""The name within the file, and the mesh."""

HEIGHT_TABLES: Mapping[str, Callable[[], str]] = {
    f"heightmaps/ground{number}.txt": partial(grounds.heights_text, number)
    for number in range(len(grounds.TABLES))
}
