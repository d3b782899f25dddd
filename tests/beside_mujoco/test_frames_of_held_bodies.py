"""Free bodies that a weld or a connect holds away from their centres of mass, beside steps of MuJoCo."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from carom import World

# A rod that begins far from where a weld at its end wants it: it spins by a quarter of a radian a step.
_SCENE = """<mujoco><option timestep="0.015" impratio="1.5" iterations="100" tolerance="0"/><worldbody>
<site name="there" pos="0 -1 1"/>
<body name="rod" pos="0 -1 1"><freejoint/>
<geom type="box" size=".2" fromto="0 0 0 0 -2 0" contype="0" conaffinity="0"/><site name="end"/></body>
<body name="free" pos="9 0 1"><freejoint/><geom size=".1" pos=".3 0 0" contype="0" conaffinity="0"/></body>
<body name="middle" pos="7 0 1"><freejoint/><geom size=".1" contype="0" conaffinity="0"/></body>
</worldbody><equality>{}<connect body1="middle" body2="world" anchor="0 0 0"/></equality>
<keyframe><key qpos="-2 -2 1 1 0 0 0 9 0 1 1 0 0 0 7 0 1 1 0 0 0"
 qvel="1 1 1 1 1 1 0 0 0 0 0 0 0 0 0 0 0 0"/></keyframe>
</mujoco>"""
_WELD = '<weld site1="there" site2="end" torquescale="0.1"/>'
# Velocities of the origin of the rod after so many steps of MuJoCo 4.0 [m/s].
_VELOCITIES = {
    1: (34.577111965, 16.665166667, -0.040559474),
    7: (5.843851864, 3.003268966, -0.001731195),
    31: (-0.107230341, 0.143908482, -0.009712833),
    60: (0.058094968, 0.133652759, -0.005169804),
}


def _world(folder: Path, equality: str = _WELD) -> World:
    path = folder / "scene.xml"
    path.write_text(_SCENE.format(equality))
    world = World(contact="compliant")
    scene = world.load(path)
    scene.apply_options()
    scene.reset(next(iter(scene.keyframes)))
    return world


def test_a_rod_that_spins_about_its_weld_moves_as_in_mujoco(tmp_path: Path) -> None:
    world = _world(tmp_path)
    rod = next(body for body in world.bodies.values() if body.name == "rod")
    for number in range(1, 201):
        world.step()
        if number in _VELOCITIES:
            found = world.velocity[rod.first_velocity + 3 : rod.first_velocity + 6]
            assert found == pytest.approx(_VELOCITIES[number], abs=1e-5)
    assert np.abs(world.velocity[rod.first_velocity : rod.first_velocity + 6]).max() < 20.0


def test_other_bodies_have_one_link(tmp_path: Path) -> None:
    bodies = {body.name: body for body in _world(tmp_path).bodies.values()}
    assert {name: body.joint_count for name, body in bodies.items()} == {"rod": 1, "free": 0, "middle": 0}
    assert bodies["rod"].spec.links[0].name == "rod"
    loose = {body.name: body.joint_count for body in _world(tmp_path, "").bodies.values()}
    assert loose == {"rod": 0, "free": 0, "middle": 0}
