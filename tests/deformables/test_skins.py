"""Skins, which follow their bones, beside what MuJoCo 4.0 makes of them; in images and in windows."""

from __future__ import annotations

import copy
import json
from pathlib import Path
from struct import pack
from threading import RLock
from xml.etree import ElementTree

import numpy as np
import pytest
from tests.deformables.cases import AT, SKIN, SKINS, node
from tests.each import each

from carom import Camera, World, Worlds
from carom.description.pose import IDENTITY
from carom.errors import DescriptionError
from carom.render.appearance import appearance_of
from carom.render.skins import skin_in
from carom.render.textured import texture_image
from carom.viewer import scene_feed
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.messages import decoded

ANSWERS = json.loads((Path(__file__).parent / "answers.json").read_text())["skin"]


def loaded(world, tmp_path, text, name="skin.xml"):
    (tmp_path / name).write_text(text)
    return world.load(tmp_path / name)


def meshes(latest):
    """The vertices of all meshes among the latest messages."""
    found = []
    for key, entry in latest._entries.items():
        if isinstance(key, tuple) and key[0] == "mesh" and not entry.gone:
            header, payload = decoded(entry.message)
            found.append(np.frombuffer(payload[: 12 * header["vertices"]], dtype="<f4").reshape(-1, 3))
    return found


def put(scene, at=AT):
    scene["a"].joints["j"].position, scene["a"].joints["k"].position = at[:2]
    w, x, y, z = at[5:]
    scene["c"].pose = at[2:5], (x, y, z, w)


def present(world):
    with world.present_poses():
        return skin_in(world, appearance_of(world).skins[0].skin, IDENTITY)


def picture(world):
    """An image from above, looking down, with y to the top."""
    camera = Camera(64, 48, fx=40.0).look_at((0.4, 0.0, 2.5), (0.4, 0.0, 1.0), up=(0.0, 1.0, 0.0))
    return camera.capture(world).colour.astype(int)


def is_green(rgb):
    return (rgb[..., 1] > rgb[..., 0] + 60) & (rgb[..., 1] > rgb[..., 2] + 60)


@each("name", list(SKINS))
def test_vertices_and_normals_are_those_of_mujoco(tmp_path, name):
    with World() as world:
        scene = loaded(world, tmp_path, SKINS[name])
        assert not scene.ignored.that_matter
        put(scene)
        vertices, normals = present(world)
        np.testing.assert_allclose(vertices, ANSWERS[name]["vertices"], atol=2e-7)
        np.testing.assert_allclose(normals, ANSWERS[name]["normals"], atol=2e-6)


def test_images_show_a_skin_where_its_bones_are(tmp_path):
    with World() as world:
        scene = loaded(world, tmp_path, SKINS["plain"])
        flat = is_green(picture(world))
        # The skin is 0.8 m by 0.2 m and 1.45 m away, with 40 pixels per metre at 1 m; a piece of it is a bit
        # longer, as its last corner follows a third body.
        assert 0.8 < flat.sum() / (0.8 * 0.2 * (40 / 1.45) ** 2) < 1.2
        scene["a"].joints["j"].position = 1.5
        turned = is_green(picture(world))
        assert turned.sum() < 0.5 * flat.sum()


def test_textures_are_those_of_their_coordinates(tmp_path):
    text = SKIN.format("halves", "0", "").replace("0 0 .5 0 1 0 0 1 .5 1 1 1", "0 0 .5 0 1 0 0 .4 .5 .4 1 .4")
    with World() as world:
        loaded(world, tmp_path, text)
        rgb = picture(world)
        # The upper row of the image is red, then blue: in files of skins v goes downwards.
        material = appearance_of(world).skins[0].skin.material
        assert material is not None
        image = texture_image(material.image)
        assert image is not None
        assert (image[0] == ((255, 0, 0), (0, 0, 255))).all()
        red, blue = (
            np.flatnonzero((rgb[..., a] > rgb[..., b] + 60).any(axis=0)) for a, b in ((0, 2), (2, 0))
        )
        assert min(len(red), len(blue)) > 5
        assert red.max() <= blue.min() + 1


def test_groups_that_are_hidden_are_not_drawn(tmp_path):
    with World() as world:
        loaded(world, tmp_path, SKIN.format("plain", "0", 'group="3"'))
        assert not is_green(picture(world)).any()


def test_saved_and_copied_worlds_have_their_skins(tmp_path):
    with World() as world:
        put(loaded(world, tmp_path, SKINS["plain"]))
        before = present(world)[0]
        world.save(tmp_path / "saved.carom")
        with World() as other:
            other.load(tmp_path / "saved.carom")
            np.testing.assert_allclose(present(other)[0], before, atol=1e-12)
            assert is_green(picture(other)).any()
        np.testing.assert_allclose(present(copy.deepcopy(world))[0], before, atol=1e-12)


def test_a_skin_goes_with_a_body_that_is_removed(tmp_path):
    with World() as world:
        scene = loaded(world, tmp_path, SKINS["plain"])
        world.remove(scene["c"])
        assert not is_green(picture(world)).any()


def test_images_of_many_worlds_show_them_as_they_are_in_each(tmp_path):
    with World() as world:
        loaded(world, tmp_path, SKINS["plain"])
        camera = Camera(64, 48, fx=40.0).look_at((0.4, 0.0, 2.5), (0.4, 0.0, 1.0), up=(0.0, 1.0, 0.0))
        flat = camera.capture(world).colour
        worlds = Worlds(world, 2)
        worlds.bodies["a"].joints.positions[1] = (1.5, 0.0)
        first, second = worlds.images(camera).colour
        np.testing.assert_array_equal(first, flat)
        assert is_green(second.astype(int)).sum() < 0.5 * is_green(flat.astype(int)).sum()


def test_pages_see_skins_move(tmp_path, monkeypatch):
    monkeypatch.setattr(scene_feed, "_SHAPE_INTERVAL", 0.0)
    with World(gravity=(0.0, 0.0, 0.0)) as world:
        scene = loaded(world, tmp_path, SKINS["plain"])
        latest = LatestMessages()
        feed = scene_feed.SceneFeed(world, RLock(), latest)
        feed.frame({})
        (flat,) = [mesh for mesh in meshes(latest) if len(mesh) == 6]
        put(scene)
        world.step()
        feed.frame({})
        (bent,) = [mesh for mesh in meshes(latest) if len(mesh) == 6]
        assert np.abs(bent - flat).max() > 0.1
        revision = latest.revision
        feed.frame({})
        assert latest.revision == revision, "nothing has moved"


def test_nodes_of_flexes_are_bones(tmp_path):
    nodes = node("n0", "0 0 1", 0.5) + node("n1", "1 0 1", 0.5) + node("n2", "0 1 1", 0.5)
    bones = "".join(
        f'<bone body="n{k}" bindpos="{place}" bindquat="1 0 0 0" vertid="{k}" vertweight="1"/>'
        for k, place in enumerate(("0 0 0", "1 0 0", "0 1 0"))
    )
    text = (
        f"<mujoco><worldbody>{nodes}</worldbody><deformable>"
        '<flex name="f" dim="2" body="n0 n1 n2" element="0 1 2"/>'
        f'<skin vertex="0 0 .1 1 0 .1 0 1 .1" face="0 1 2">{bones}</skin></deformable></mujoco>'
    )
    with World() as world:
        scene = loaded(world, tmp_path, text)
        world.step(20)
        np.testing.assert_allclose(present(world)[0], scene["f"].nodes + np.array((0, 0, 0.1)), atol=1e-12)


def skn(text=SKINS["plain"]):
    """The skin of the file above as a binary file."""
    root = ElementTree.fromstring(text)
    (skin,) = root.iter("skin")
    numbers = {name: list(map(float, skin.attrib[name].split())) for name in ("vertex", "texcoord", "face")}
    bones = list(skin)
    data = pack("<4i", 6, 6, 4, len(bones))
    data += pack("<18f", *numbers["vertex"]) + pack("<12f", *numbers["texcoord"])
    data += pack("<12i", *map(int, numbers["face"]))
    for bone in bones:
        bind = [*map(float, bone.attrib["bindpos"].split()), *map(float, bone.attrib["bindquat"].split())]
        rows = list(map(int, bone.attrib["vertid"].split()))
        weights = list(map(float, bone.attrib["vertweight"].split()))
        data += pack("<40s7fi", bone.attrib["body"].encode(), *bind, len(rows))
        data += pack(f"<{len(rows)}i", *rows) + pack(f"<{len(rows)}f", *weights)
    return data


def of_file(tmp_path, data):
    (tmp_path / "a.skn").write_bytes(data)
    begin, end = SKINS["plain"].index("<deformable>"), SKINS["plain"].index("</deformable>")
    skin = '<deformable><skin name="s" material="plain" file="a.skn"/>'
    return SKINS["plain"][:begin] + skin + SKINS["plain"][end:]


def test_binary_files_are_read(tmp_path):
    with World() as world:
        scene = loaded(world, tmp_path, of_file(tmp_path, skn()))
        assert not scene.ignored.that_matter
        put(scene)
        np.testing.assert_allclose(present(world)[0], ANSWERS["plain"]["vertices"], atol=1e-6)


@each("length", range(0, len(skn()), 7))
def test_binary_files_that_are_cut_off_are_errors(tmp_path, length):
    with World() as world, pytest.raises(DescriptionError, match=r"a\.skn"):
        loaded(world, tmp_path, of_file(tmp_path, skn()[:length]))


@each(
    ("old", "new", "says"),
    [
        ('body="c"', 'body="z"', "there is no body 'z', which is a bone"),
        ('vertid="5"', 'vertid="6"', "names a vertex that is not there; there are 6"),
        ('vertid="5"', 'vertid="4 5"', "as many weights as vertices"),
        ('face="0 1 3', 'face="0 1 9', "a face names a vertex that is not there"),
        ('face="0 1 3', 'face="1 3', "face needs 3 numbers"),
        ('texcoord="0 0 ', 'texcoord="', "texcoord has 5 pairs; there are 6 vertices"),
        ('vertweight="1 .5 1 .5"', 'vertweight="0 .5 1 .5"', "weights of vertex 0 do not add up"),
        ('bindquat="2 0 0 0"', 'bindquat="0 0 0 0"', "bindquat is 0"),
        ('bindpos="0 1 1" ', "", "'bindpos' is missing"),
        ('material="plain" inflate', 'material="gone" inflate', "there is no material 'gone'"),
        ('name="s"', 'name="s" file="gone.skn"', "was found"),
    ],
)
def test_broken_skins_are_errors_that_say_what_is_wrong(tmp_path, old, new, says):
    assert old in SKINS["plain"]
    with World() as world:
        with pytest.raises(DescriptionError, match=says):
            loaded(world, tmp_path, SKINS["plain"].replace(old, new))
        assert len(world.bodies) == 0
