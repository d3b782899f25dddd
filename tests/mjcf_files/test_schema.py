"""Every element and attribute of MJCF is simulated, or reported with what is lost."""

import pytest
from schema import SCHEMA
from tests.each import each

from carom import World
from carom.formats.mjcf.compiled.sensors import BUILT
from carom.formats.mjcf.rules import MJCF_RULES

UNKNOWN = "that Carom knows"
# Elements that are read; what is in others is lost with them, in one entry.
READ = (
    "mujoco", "mujoco/compiler", "mujoco/option", "mujoco/option/flag", "mujoco/default", "mujoco/asset",
    "mujoco/asset/mesh", "mujoco/asset/hfield", "mujoco/asset/texture", "mujoco/asset/material",
    "mujoco/asset/model", "mujoco/body", "mujoco/body/inertial", "mujoco/body/joint", "mujoco/body/freejoint",
    "mujoco/body/geom", "mujoco/body/attach", "mujoco/body/site", "mujoco/body/camera", "mujoco/body/frame",
    "mujoco/body/replicate", "mujoco/include", "mujoco/contact", "mujoco/contact/exclude", "mujoco/keyframe",
    "mujoco/keyframe/key", "mujoco/tendon", "mujoco/equality", "mujoco/actuator", "mujoco/sensor",
    "mujoco/body/flexcomp", "mujoco/body/flexcomp/edge", "mujoco/body/flexcomp/elasticity",
    "mujoco/body/flexcomp/contact", "mujoco/body/flexcomp/pin",
    "mujoco/deformable", "mujoco/deformable/flex", "mujoco/deformable/flex/contact",
    "mujoco/deformable/flex/edge", "mujoco/deformable/flex/elasticity", "mujoco/deformable/skin",
    "mujoco/deformable/skin/bone", "mujoco/asset/skin", "mujoco/asset/skin/bone", "mujoco/equality/flex",
    "mujoco/contact/pair", "mujoco/actuator/general", "mujoco/actuator/motor",
    "mujoco/actuator/position", "mujoco/actuator/velocity", "mujoco/actuator/intvelocity",
    "mujoco/actuator/damper", "mujoco/actuator/cylinder", "mujoco/actuator/dcmotor",
    "mujoco/actuator/adhesion", "mujoco/actuator/pid", "mujoco/equality/connect", "mujoco/equality/weld",
    "mujoco/equality/joint", "mujoco/equality/tendon", "mujoco/actuator/muscle", "mujoco/tendon/fixed",
    "mujoco/tendon/fixed/joint", "mujoco/tendon/spatial", "mujoco/tendon/spatial/site",
    "mujoco/tendon/spatial/geom", "mujoco/tendon/spatial/pulley", *(f"mujoco/sensor/{tag}" for tag in BUILT),
)  # fmt: skip


def is_lost_with_another(path):
    parents = [path.rsplit("/", count)[0] for count in range(1, path.count("/") + 1)]
    return any(parent not in READ for parent in parents)


@each("path", [path for path in SCHEMA if path not in READ and not is_lost_with_another(path)])
def test_elements_that_are_not_read_are_reported_with_a_reason(path):
    says = MJCF_RULES.of(tuple(path.split("/")), None, taken=False)
    assert says is not None
    assert UNKNOWN not in says[1]


@each(
    ("path", "name"),
    [(path, name) for path in READ for name in SCHEMA[path].split() if path != "mujoco/option/flag"],
)
def test_attributes_of_elements_that_are_read_are_known(path, name):
    for places in (path, path.replace("mujoco/body/", "mujoco/default/").replace("asset/", "default/")):
        says = MJCF_RULES.of(tuple(places.split("/")), name, taken=False)
        assert says is not None
        assert UNKNOWN not in says[1]


EVERYTHING = """<mujoco model="all"><compiler angle="radian" autolimits="true" balanceinertia="false"
boundmass="0" boundinertia="0" coordinate="local" eulerseq="xyz" fitaabb="false"
inertiafromgeom="auto" inertiagrouprange="0 5" settotalmass="-1" strippath="false"
meshdir="" texturedir="" alignfree="false"/> <option timestep="0.004" gravity="0 0
-1"/><default><default class="c"><geom density="10"/></default></default> <asset><mesh
name="m" vertex="0 0 0 1 0 0 0 1 0 0 0 1" scale="1 1 1" refpos="0 0 0" refquat="1 0 0 0"
inertia="convex"/> <material name="red" rgba="1 0 0 1" specular=".3"/><hfield name="h"
nrow="2" ncol="2" size="1 1 1 1" elevation="0 1 0 1"/> </asset><worldbody><geom
type="hfield" hfield="h"/><frame name="f" pos="0 0 1" euler="0 0 1"><body name="b" pos="0
0 1" childclass="c" quat="1 0 0 0"><inertial pos="0 0 0" quat="1 0 0 0" mass="1"
diaginertia="1 1 1"/><joint name="j" type="hinge" axis="0 1 0" pos="0 0 0" range="-1 1"
limited="auto" damping="1" armature="1" stiffness="1" ref="0" frictionloss="1"
springref=".1"/><geom name="g" type="mesh" mesh="m" material="red" mass="1" group="1"
condim="3" contype="1" conaffinity="1" friction="1 .1 .1" zaxis="0 0 1"/><site name="s"
pos="0 0 1" size=".1" type="box"/> <camera name="c" fovy="30" mode="fixed" resolution="4
3" xyaxes="1 0 0 0 1 0"/></body></frame> <replicate count="2" offset="0 0 1" sep="_"><body
name="d"><freejoint name="free" align="false"/><geom class="c" type="capsule" fromto="0 0
0 0 0 1" size=".1" rgba="1 1 1 1" shellinertia="false"/></body></replicate></worldbody>
<contact><exclude name="e" body1="b" body2="d_0"/></contact> <keyframe><key name="home"
time="1" qpos=".5 0 0 2 1 0 0 0 0 0 5 1 0 0 0" qvel="1 0 0 0 0 0 0 0 0 0 0 0 0" ctrl=""/>
</keyframe></mujoco>"""


def test_what_is_read_leaves_nothing_to_report(tmp_path):
    (tmp_path / "all.xml").write_text(EVERYTHING)
    with World() as world:
        scene = world.load(tmp_path / "all.xml", strict=True)
        assert not scene.ignored


@pytest.mark.parametrize(
    "tag", ["actuator/orientation", "sensor/insidesite", "equality/flexstrain", "deformable/rope"]
)
def test_what_is_not_read_is_reported_one_by_one(tmp_path, tag):
    around, inner = tag.split("/")
    (tmp_path / "a.xml").write_text(f"<mujoco>\n<{around}>\n<{inner}/>\n<{inner}/></{around}></mujoco>")
    with World() as world:
        (one,) = world.load(tmp_path / "a.xml").ignored
    assert (one.element, one.count, one.line, one.matters) == (tag, 2, 3, True)


@pytest.mark.parametrize("is_included", [False, True])
def test_flags_that_have_no_effect_are_reported_where_they_are(tmp_path, is_included):
    flags = '<option sleep_tolerance="1"><flag sleep="enable" refsafe="disable" island="disable"/></option>'
    (tmp_path / "flags.xml").write_text(f"<mujoco>{flags}</mujoco>")
    (tmp_path / "a.xml").write_text(
        f"""<mujoco>{'<include file="flags.xml"/>' if is_included else flags}
        <worldbody><body sleep="never"><freejoint/><geom size=".1"/></body></worldbody></mujoco>"""
    )
    with World() as world:
        found = world.load(tmp_path / "a.xml").ignored.that_matter
        assert {(it.element, it.attributes) for it in found} == {
            ("option/flag", ("sleep",)),
            ("option/flag", ("refsafe",)),
            ("mujoco/option", ("sleep_tolerance",)),
            ("worldbody/body", ("sleep",)),
        }
        assert {it.file.name for it in found if "flag" in it.element} == {
            "flags.xml" if is_included else "a.xml"
        }
