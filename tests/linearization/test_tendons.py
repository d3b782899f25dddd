"""Linearised steps with tendons over joints and their actuators, beside central differences."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.linearization.scenes import assert_exact, statuses
from tests.linearization.test_yielding_rows import of_file

from carom import World, Worlds

ARM = """
<option timestep="0.004"/><default><geom contype="0" conaffinity="0"/></default><worldbody>
<body pos="0 0 1"><joint name="a" axis="0 1 .2" damping=".1"/>
<geom type="capsule" fromto="0 0 0 .3 0 -.1" size=".03"/>
<body pos=".3 0 -.1"><joint name="b" axis="1 1 0"/>
<geom type="capsule" fromto="0 0 0 .1 .2 -.27" size=".03"/>
<body pos=".1 .2 -.27"><joint name="c" type="slide" axis="0 .6 .8"/>
<geom type="box" size=".1 .05 .03" pos=".1 0 0"/></body></body></body></worldbody>
<tendon><fixed name="t" {tendon}><joint joint="a" coef="1.5"/><joint joint="b" coef="-.7"/>
<joint joint="c" coef="2"/></fixed></tendon><actuator>{actuator}</actuator>
"""
SUM = 'actuatorfrclimited="true" actuatorfrcrange="-1 1"'
LIMITED = 'limited="true" range="-.2 .1"'
PARAMETERS = ["masses", "inertias", "armature"]


def arm(folder: Path, tendon: str = "", actuator: str = "", control: float = 0.0) -> World:
    world = of_file(folder, ARM.format(tendon=tendon, actuator=actuator))
    (body,) = world.bodies.values()
    body.joints.positions = [0.3, -0.2, 0.1]
    body.joints.velocities = [0.4, -0.5, 0.3]
    if actuator:
        body.actuators["u"].control = control
    return world


@pytest.mark.parametrize(
    ("tendon", "rows"),
    [
        ('stiffness="40" springlength=".1"', {"spring": "holds"}),
        ('stiffness="40" springlength=".1 2"', {}),
        ('stiffness="40" damping="3" springlength=".1"', {"spring": "holds"}),
        ('damping="3" armature=".2"', {"spring": "holds"}),
        ('stiffness="4" armature=".2" frictionloss=".01"', {"spring": "holds", "friction": "lower"}),
        ('frictionloss="300"', {"friction": "holds"}),
        (LIMITED, {"limit": "holds"}),
        (f'{LIMITED} margin=".05" solreflimit=".06 .8" solimplimit=".4 .95 .3 .5 2"', {"limit": "holds"}),
        ('limited="true" range="1.4 2" solreflimit="-300 -20"', {"limit": "holds"}),
    ],
)
def test_tendons_over_joints(tmp_path, tendon, rows):
    step = assert_exact(arm(tmp_path, tendon), parameters=PARAMETERS)
    found = {name: status[0] for name, status in statuses(step).items() if "tendon" in name}
    assert len(found) == len(rows)
    for kind, status in rows.items():
        (own,) = (it for name, it in found.items() if name.startswith(f"{kind} of tendon"))
        assert status in own


@pytest.mark.parametrize("own", [False, True])
def test_a_rigid_limit_and_one_that_yields_for_its_own_inverse_mass(tmp_path, own):
    world = arm(tmp_path, LIMITED)
    world.contact_arrays.users.numpy["user_impedance"][:, 3 if own else 1] = 0.0
    step = assert_exact(world, parameters=PARAMETERS)
    assert statuses(step)["limit of tendon, constraint 0"] == ["holds"]


@pytest.mark.parametrize(
    ("actuator", "control"),
    [
        ('<motor name="u" tendon="t" gear="3"/>', 0.4),
        ('<position name="u" tendon="t" kp="60" kv="2"/>', 0.2),
        ('<velocity name="u" tendon="t" kv="5" gear="-2"/>', 0.7),
        ('<position name="u" tendon="t" kp="60" forcerange="-1 1"/>', 3.0),
        ('<intvelocity name="u" tendon="t" kp="30" actrange="-1 1"/>', 0.5),
        ('<general name="u" tendon="t" gainprm="4" biastype="affine" biasprm="1 3 .5"/>', 0.5),
        ('<general name="u" tendon="t" dyntype="filter" dynprm=".1" gainprm="9"/>', 0.5),
    ],
)
def test_actuators_of_tendons(tmp_path, actuator, control):
    world = arm(tmp_path, 'stiffness="10"', actuator, control)
    step = assert_exact(
        world, controls=["actuators"], parameters=["actuator_gains", "actuator_biases", "masses"]
    )
    (status,) = (it for name, it in statuses(step).items() if name.startswith("actuator of tendon"))
    assert status == (["at its upper bound"] if "forcerange" in actuator else ["holds"])
    assert np.abs(step.B).max() > 0.0 or "forcerange" in actuator or "dyntype" in actuator


def test_several_steps_in_many_worlds(tmp_path):
    world = arm(tmp_path, f'{LIMITED} stiffness="10"', '<position name="u" tendon="t" kp="60"/>', 0.2)
    assert_exact(world, controls=["actuators"], steps=3, atol=3e-6)
    lone = world.linearize(["actuators"])
    steps = Worlds(world, 3).linearize(["actuators"])
    assert (steps.A == lone.A).all()


@pytest.mark.parametrize(
    ("actuator", "tendon"),
    [
        ('<muscle name="u" tendon="t" lengthrange="0 1"/>', ""),
        ('<muscle name="u" joint="a" lengthrange="-1 1" tausmooth=".5"/>', ""),
        ('<motor name="v" tendon="t"/><position name="u" tendon="t" kp="9"/>', f"{SUM}"),
        ('<motor name="u" tendon="t"/>', 'actuatorfrclimited="true" actuatorfrcrange="-1 1"'),
    ],
)
def test_muscles_and_sums_with_bounds(tmp_path, actuator, tendon):
    world = arm(tmp_path, tendon, actuator, 0.6)
    for it in next(iter(world.bodies.values())).actuators:
        if it.spec.dynamics:
            it.activation = 0.4
    assert_exact(world, controls=["actuators"], parameters=["masses"])
