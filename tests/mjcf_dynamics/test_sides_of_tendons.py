"""A tendon goes around the side of its sidesite as in MuJoCo, also where that is far from both ways.

The lengths are those of `mujoco` 4.0, for ends and sidesites at which the ways differ by much.
"""

from pathlib import Path

import pytest

from carom import World

FILE = """<mujoco><option gravity="0 0 0"/><worldbody><geom name="ball" size=".04"/><site name="a" pos="{}"/>
<site name="s" pos="{}"/><body><joint type="slide" axis="0 0 1"/><geom size=".01" pos="1 0 0"/>
<site name="b" pos="{}"/></body></worldbody><tendon><spatial name="t" stiffness="1" springlength="0">
<site site="a"/><geom geom="ball" sidesite="s"/><site site="b"/></spatial></tendon></mujoco>"""


@pytest.mark.parametrize(
    ("first", "side", "last", "length", "acceleration"),
    [
        (
            "-.00709297 -.17027822 .21350423",
            "-.04098915 .04503689 -.08480312",
            "-.02721922 .02664911 -.01867991",
            0.3087580250839392,
            57.310502266289475,
        ),
        ("-.1 .02 0", "-.03 -.06 .01", "-.02 .05 .02", 0.08774964387392123, -4.77464829275686),
    ],
)
def test_the_way_is_that_of_mujoco(
    tmp_path: Path, first: str, side: str, last: str, length: float, acceleration: float
):
    (tmp_path / "file.xml").write_text(FILE.format(first, side, last))
    scene = World(integrator="discrete").load(tmp_path / "file.xml")
    assert scene.tendons["t"].length == pytest.approx(length, rel=1e-9)
    scene.world.time_step = 1e-6
    scene.world.step()
    joint = next(joint for body in scene.bodies for joint in body.joints.movable)
    assert joint.velocity / 1e-6 == pytest.approx(acceleration, rel=1e-4)
