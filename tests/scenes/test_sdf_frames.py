"""Poses of SDF files that are relative to other frames."""

from __future__ import annotations

from math import inf

import pytest
from numpy.testing import assert_allclose

from carom import World
from carom.errors import DescriptionError

TEXT = """<sdf version="1.9"><model name="m"><pose>10 0 0 0 0 0</pose>
<link name="base"><pose>0 0 1 0 0 0</pose></link>
<frame name="mount" attached_to="base"><pose>0 2 0 0 0 1.5707963267948966</pose></frame>
<link name="arm"><pose relative_to="mount">3 0 0 0 0 0</pose></link>
<joint name="j" type="fixed"><parent>base</parent><child>arm</child></joint>
</model></sdf>"""


def load(world: World, tmp_path, text: str):
    file = tmp_path / "m.sdf"
    file.write_text(text)
    return world.load(file)


def test_links_are_placed_relative_to_links_and_frames(tmp_path):
    with World() as world:
        scene = load(world, tmp_path, TEXT)
        links = {link.name: link for link in scene[0].links}
        assert_allclose(links["base"].pose.position, [10, 0, 1], atol=1e-12)
        assert_allclose(links["arm"].pose.position, [10, 5, 1], atol=1e-12)
        assert not [one for one in scene.ignored if "pose" in one.element or one.element == "model/frame"]


@pytest.mark.parametrize(
    ("old", "new", "complaint"),
    [
        (
            'relative_to="mount"',
            'relative_to="mont"',
            r":4: .*no frame 'mont'; there are base, mount, arm, j",
        ),
        ('attached_to="base"', 'attached_to="arm"', r"frames are in a circle"),
    ],
)
def test_frames_that_do_not_exist_are_errors(tmp_path, old, new, complaint):
    with World() as world:
        with pytest.raises(DescriptionError, match=complaint):
            load(world, tmp_path, TEXT.replace(old, new))
        assert not world.bodies


@pytest.mark.parametrize(("stated", "found"), [("0", 0.0), ("3", 3.0), ("-1", inf), ("", inf)])
def test_a_bound_of_zero_is_a_bound_and_a_negative_one_is_none(tmp_path, stated, found):
    limit = "".join(f"<{name}>{stated}</{name}>" for name in ("effort", "velocity") if stated)
    moving = f'type="revolute"><axis><xyz>0 0 1</xyz><limit>{limit}</limit></axis>'
    with World() as world:
        scene = load(world, tmp_path, TEXT.replace('type="fixed">', moving))
        spec = scene[0].joints["j"].spec
        assert (spec.effort, spec.velocity) == (found, found)
