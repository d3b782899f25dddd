"""Sensors of MJCF files show what MuJoCo's show."""

import json
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.mjcf_files.cases.sensor import SENSORS

from carom import World
from carom.errors import DescriptionError

ANSWERS = json.loads((Path(__file__).parent / "cases" / "sensor_answers.json").read_text())
# Those that are means over the last step, or of its forces.
OF_STEPS = ("ACC", "FORCE", "TORQUE", "ACTUATORFRC", "ACTFRC", "ACCELEROMETER")


def load(world, folder, text):
    (folder / "file.xml").write_text(text)
    return world.load(folder / "file.xml")


@pytest.mark.parametrize("name", SENSORS)
def test_readings_are_those_of_mujoco(tmp_path, name):
    answer = ANSWERS[name]
    numbers = {"qpos": answer["q"], "qvel": answer["v"], "ctrl": answer["control"]}
    key = " ".join(f'{it}="{" ".join(map(repr, values))}"' for it, values in numbers.items())
    text = SENSORS[name].replace("</mujoco>", f'<keyframe><key name="x" {key}/></keyframe></mujoco>')
    with World() as world:
        scene = load(world, tmp_path, text)
        assert not scene.ignored.that_matter
        scene.apply_options()
        scene.reset("x")
        sensors = list(scene.sensors.values())
        before = [sensor.read() for sensor in sensors]
        for body in scene.bodies:
            for joint in body.joints:
                body.change_dynamics(joint.index, joint_lower_limit=1.0, joint_upper_limit=-1.0)
        world.step()
        after = [sensor.read() for sensor in sensors]
    order = {it.name: place for place, it in enumerate(sensors)}
    assert len(order) == len(answer["values"])
    places = in_file_order(scene, answer)
    for place, kind, value in zip(places, answer["kinds"], answer["values"], strict=True):
        got = (after if kind.endswith(OF_STEPS) else before)[place]
        if "QUAT" in kind:
            value = [*value[1:], value[0]]
            got = got * np.sign(np.dot(got, value))
        tolerance = 2e-5 if kind.endswith(OF_STEPS) else 1e-9
        assert_allclose(got, value, rtol=tolerance, atol=tolerance, err_msg=f"{kind} {sensors[place]}")


def in_file_order(scene, answer):
    """Places among the sensors of all bodies, in the order of the file."""
    places = {name: place for place, name in enumerate(scene.sensors)}
    if all(answer["names"]):
        return [places[name] for name in answer["names"]]
    # Names that are made up begin with their number.
    return sorted(places.values(), key=lambda it: int(list(places)[it].removeprefix("sensor").split("_")[0]))


@pytest.mark.parametrize(
    ("sensor", "reason"),
    [
        ('<rangefinder camera="eye"/>', "fixed in the world"),
        ('<framepos objtype="geom" objname="i"/>', "meshes"),
        ('<framepos objtype="camera" objname="aim"/>', "aim"),
        ('<jointpos joint="free"/>', "hinges and slides"),
        ('<force site="still"/>', "fixed base"),
        ('<force site="fixed"/>', "fixed base"),
        ('<subtreecom body="world"/>', "of several bodies"),
        ('<actuatorpos actuator="m"/>', "not simulated"),
        ('<insidesite site="fixed" objtype="xbody" objname="f"/>', "not read yet"),
    ],
)
def test_what_has_no_sensor_is_reported(tmp_path, sensor, reason):
    text = f"""<mujoco><asset><mesh name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/></asset>
<worldbody><camera name="eye"/><camera name="aim" mode="targetbody" target="f"/><site name="still"/>
<body name="f"><freejoint name="free"/><geom name="g" size=".1"/></body><body><geom name="h" size=".1"/>
<geom name="i" type="mesh" mesh="m"/><site name="fixed"/></body></worldbody>
<actuator><orientation name="m" site="fixed" refsite="still"/></actuator><sensor>{sensor}</sensor>
</mujoco>"""
    with World() as world:
        scene = load(world, tmp_path, text)
        (lost,) = [it for it in scene.ignored.that_matter if it.element.startswith("sensor/")]
        assert reason in lost.reason
        assert not scene.sensors


def test_what_does_not_move_has_sensors(tmp_path):
    text = """<mujoco><worldbody><site name="w" pos=".1 .2 .3" euler="0 90 0"/>{}
<body name="arm" pos="0 0 1"><joint name="j" axis="0 0 1"/><geom size=".05" pos=".3 0 0"/>
<site name="e" pos=".3 0 0"/></body></worldbody><sensor><framepos objtype="site" objname="w"/>
<framepos objtype="site" objname="w" reftype="site" refname="e"/><framelinvel objtype="site" objname="w"
 reftype="site" refname="e"/><accelerometer site="w"/></sensor></mujoco>"""
    for floor in ("", '<geom type="plane" size="1 1 1"/>'):
        with World(integrator="discrete") as world:
            scene = load(world, tmp_path, text.format(floor))
            assert not scene.ignored.that_matter
            world.gravity = (0.0, 0.0, -9.81)
            scene["arm"].joints["j"].velocity = 2.0
            world.step()
            turn = scene["arm"].joints["j"].position
            c, s = np.cos(turn), np.sin(turn)
            place, seen, speed, felt = (sensor.read() for sensor in scene.sensors.values())
            assert_allclose(place, [0.1, 0.2, 0.3])
            # In axes that turn with the arm the site goes round the other way.
            assert_allclose(seen, [0.1 * c + 0.2 * s - 0.3, 0.2 * c - 0.1 * s, -0.7], atol=1e-12)
            assert_allclose(speed, [2.0 * (0.2 * c - 0.1 * s), -2.0 * (0.1 * c + 0.2 * s), 0.0], atol=1e-9)
            assert_allclose(felt, [-9.81, 0.0, 0.0], atol=1e-9)


def test_quality_is_that_of_the_file(tmp_path):
    text = """<mujoco><worldbody><body name="b"><joint name="j"/><geom size=".1"/><site name="s"/></body>
</worldbody><sensor><gyro name="g" site="s" cutoff="2" delay=".01" interval=".005" nsample="7" noise=".1"
 interp="cubic"/></sensor></mujoco>"""
    with World() as world:
        scene = load(world, tmp_path, text)
        spec = scene.sensors["g"].spec
        assert (spec.cutoff, spec.delay, spec.period, spec.samples, spec.noise) == (2.0, 0.01, 0.005, 7, 0.0)
        (lost,) = scene.ignored.that_matter
        assert lost.attributes == ("interp",)


@pytest.mark.parametrize(
    ("sensor", "problem"),
    [
        ('<gyro site="no"/>', "no site 'no'"),
        ("<gyro/>", "'site' is missing"),
        ('<framepos objtype="thing" objname="b"/>', "none of site"),
        ('<gyro site="s" cutoff="-1"/>', "cutoff of 0 or more"),
        ('<gyro name="a" site="s"/><gyro name="a" site="s"/>', "taken already"),
    ],
)
def test_mistakes_are_named(tmp_path, sensor, problem):
    text = f"""<mujoco><worldbody><body name="b"><joint name="j"/><geom size=".1"/><site name="s"/></body>
</worldbody><sensor>{sensor}</sensor></mujoco>"""
    with World() as world, pytest.raises(DescriptionError, match=problem):
        load(world, tmp_path, text)
