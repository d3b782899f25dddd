"""getCameraImage and the looks of shapes, as scripts see them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

import pybullet as p

ASSETS = Path(p.__file__).parents[1] / "pybullet_data"
VIEW = p.computeViewMatrix([0, -3, 0], [0, 0, 0], [0, 0, 1])
PROJECTION = p.computeProjectionMatrixFOV(45, 4 / 3, 0.1, 20)


@pytest.fixture
def cube(client: int) -> int:
    return p.loadURDF(str(ASSETS / "cube.urdf"))


def colours(**options):
    return p.getCameraImage(40, 30, VIEW, PROJECTION, **options)[2]


def middle(**options) -> list[int]:
    return colours(**options)[15, 20, :3].tolist()


def labels(**options):
    return p.getCameraImage(40, 30, VIEW, PROJECTION, **options)[4]


def test_shapes_and_types_are_those_of_pybullet(cube):
    width, height, rgba, depth, segmentation = p.getCameraImage(40, 30, VIEW, PROJECTION)
    assert (width, height) == (40, 30)
    assert (rgba.shape, rgba.dtype) == ((30, 40, 4), np.uint8)
    assert (depth.shape, depth.dtype) == ((30, 40), np.float32)
    assert (segmentation.shape, segmentation.dtype) == ((30, 40), np.int32)
    assert np.all(rgba[:, :, 3] == 255)
    nothing = segmentation == -1
    assert np.all(rgba[nothing] == 255)
    assert np.all(depth[nothing] == 1.0)


def test_depth_becomes_metres_by_the_formula_of_the_manual(cube):
    depth = p.getCameraImage(40, 30, VIEW, PROJECTION)[3][15, 20]
    assert 20 * 0.1 / (20 - (20 - 0.1) * depth) == pytest.approx(2.5, rel=1e-4)


def test_images_belong_to_the_script(cube):
    first = p.getCameraImage(40, 30, VIEW, PROJECTION)
    copies = [array.copy() for array in first[2:]]
    p.resetBasePositionAndOrientation(cube, [1, 0, 0], [0, 0, 0, 1])
    p.getCameraImage(40, 30, VIEW, PROJECTION)
    for array, copy in zip(first[2:], copies, strict=True):
        assert np.array_equal(array, copy)
        array.fill(0)


def test_segmentation_names_bodies_or_bodies_and_links(client):
    p.loadURDF(str(ASSETS / "plane.urdf"))
    r2d2 = p.loadURDF(str(ASSETS / "r2d2.urdf"), [0, 0, 0.5])
    view = p.computeViewMatrix([2, -2, 1.5], [0, 0, 0.4], [0, 0, 1])

    def take(flags):
        return p.getCameraImage(80, 60, view, PROJECTION, flags=flags)[4]

    bodies, links = take(-1), take(p.ER_SEGMENTATION_MASK_OBJECT_AND_LINKINDEX)
    assert set(np.unique(bodies)) == {-1, 0, r2d2}
    assert np.array_equal(np.where(links < 0, -1, links & 0xFFFFFF), bodies)
    assert len(np.unique((links[bodies == r2d2] >> 24) - 1)) > 5
    assert np.all(take(p.ER_NO_SEGMENTATION_MASK) == -1)


def test_both_renderers_give_the_same_image(cube):
    assert np.array_equal(colours(renderer=p.ER_TINY_RENDERER), colours(renderer=p.ER_BULLET_HARDWARE_OPENGL))


# Measured: the camera of PyBullet without a window shows the unit cube here, in a picture of 20 x 16.
DEFAULT_ROWS, DEFAULT_COUNT = range(4, 12), 58


def test_without_matrices_the_camera_is_pybullets(cube):
    for view, projection in ((None, None), (VIEW, None), (None, PROJECTION)):
        segmentation = p.getCameraImage(20, 16, view, projection)[4]
        rows = np.nonzero((segmentation == cube).any(axis=1))[0]
        assert rows.tolist() == list(DEFAULT_ROWS)
        assert np.sum(segmentation == cube) == DEFAULT_COUNT


def test_with_a_window_the_camera_is_that_of_the_window():
    p.connect(p.GUI)
    p.loadURDF(str(ASSETS / "cube.urdf"), [30, 0, 0])
    p.resetDebugVisualizerCamera(2.0, 0, 0, [30, 0, 0])
    assert np.mean(p.getCameraImage(20, 16)[4] == 0) > 0.05


def test_what_is_said_of_the_light_holds_for_later_images(cube):
    before = middle()
    darker = middle(lightAmbientCoeff=0.2, lightDiffuseCoeff=0.1, lightSpecularCoeff=0.0)
    assert max(darker) < min(before)
    assert middle() == darker
    coloured = middle(lightColor=[1, 0, 0], lightDiffuseCoeff=0.8, lightDirection=[0, -1, 0])
    assert coloured[0] > coloured[1]
    assert middle() == coloured
    other = p.connect(p.DIRECT)
    p.loadURDF(str(ASSETS / "cube.urdf"), physicsClientId=other)
    assert middle(physicsClientId=other) == before


def test_shadows_are_off_until_asked_for(client):
    p.loadURDF(str(ASSETS / "plane.urdf"))
    p.loadURDF(str(ASSETS / "cube_small.urdf"), [0, 0, 0.5])
    near = p.computeProjectionMatrixFOV(45, 1, 0.01, 20)
    view = p.computeViewMatrix([0.2, -1.5, 1.5], [0, 0, 0.2], [0, 0, 1])

    def take(**options):
        return p.getCameraImage(60, 60, view, near, **options)[2]

    plain, shadowed = take(), take(shadow=1)
    assert 10 < np.sum((shadowed < plain).any(axis=2)) < 1000
    assert np.array_equal(take(), shadowed)
    assert np.array_equal(take(shadow=0), plain)


def test_the_matrices_of_a_window_that_is_not_there_show_nothing(cube):
    camera = p.getDebugVisualizerCamera()
    image = p.getCameraImage(6, 4, viewMatrix=camera[2], projectionMatrix=camera[3])
    assert image[2].min() == 255
    assert image[4].max() == -1


@pytest.mark.parametrize(
    "arguments",
    [
        (0, 30),
        (30, 0),
        (-5, 30),
        (100_000, 100_000),
        (40, 30, [float("nan")] * 16, PROJECTION),
        (40, 30, "sixteen letters!", PROJECTION),
        (40, 30, VIEW, PROJECTION, [0, 0, 0]),
        (40, 30, VIEW, PROJECTION, None, ["red", 0, 0]),
        (40, 30, VIEW, PROJECTION, None, None, float("inf")),
    ],
)
def test_bad_arguments_are_refused_and_nothing_is_lost(cube, arguments):
    before = colours()
    with pytest.raises(p.error):
        p.getCameraImage(*arguments)
    assert np.array_equal(colours(), before)


def test_a_projective_texture_falls_from_the_camera_if_nothing_else_is_said(cube):
    texture = p.loadTexture(str(ASSETS / "uvmap.png"))
    p.changeVisualShape(cube, -1, textureUniqueId=texture)
    stuck = colours()
    cast = colours(flags=p.ER_USE_PROJECTIVE_TEXTURE)
    assert not np.array_equal(stuck, cast)
    assert np.array_equal(
        cast,
        colours(
            flags=p.ER_USE_PROJECTIVE_TEXTURE, projectiveTextureView=VIEW, projectiveTextureProj=PROJECTION
        ),
    )
    elsewhere = p.computeViewMatrix([0.3, -3, 0], [0.3, 0, 0], [0, 0, 1])
    assert not np.array_equal(
        cast,
        colours(
            flags=p.ER_USE_PROJECTIVE_TEXTURE,
            projectiveTextureView=elsewhere,
            projectiveTextureProj=PROJECTION,
        ),
    )


@pytest.mark.parametrize("change", [p.changeVisualShape, p.resetVisualShapeData])
def test_colours_change_by_both_names(cube, change):
    change(cube, -1, rgbaColor=[1, 0, 0, 1], textureUniqueId=-1)
    red, green, blue = middle()
    assert red > 100
    assert green == blue == 0


def test_alpha_0_hides_a_shape(cube):
    p.changeVisualShape(cube, -1, rgbaColor=[1, 1, 1, 0])
    assert np.all(labels() == -1)


def test_double_sided_shapes_are_seen_from_inside(cube):
    inside = p.computeViewMatrix([0, 0, 0], [1, 0, 0], [0, 0, 1])

    def seen():
        return np.mean(p.getCameraImage(8, 8, inside, PROJECTION)[4] == cube)

    assert seen() == 0.0
    p.changeVisualShape(cube, -1, flags=p.VISUAL_SHAPE_DOUBLE_SIDED)
    assert seen() == 1.0
    p.changeVisualShape(cube, -1, flags=0)
    assert seen() == 0.0


def test_unknown_bodies_links_and_shapes_are_no_error_as_in_pybullet(cube, caplog):
    before = colours()
    for arguments in ((99, -1), (cube, 5), (cube, -2), (cube, -1, 7)):
        p.changeVisualShape(*arguments, rgbaColor=[1, 0, 0, 1])
    assert len(caplog.records) == 4
    assert np.array_equal(colours(), before)


@pytest.mark.parametrize(
    "options", [{"rgbaColor": [1, 0, 0, None]}, {"specularColor": "red"}, {"textureUniqueId": 77}]
)
def test_bad_looks_are_refused(cube, options):
    with pytest.raises(p.error, match="Error resetting visual shape info"):
        p.changeVisualShape(cube, -1, **options)


def test_texture_ids_count_on_from_those_of_the_meshes(cube):
    # Measured: the texture of the cube's mesh has id 0, and a reset forgets textures but no ids.
    file = str(ASSETS / "ball.png")
    assert [p.loadTexture(file), p.loadTexture(file)] == [1, 2]
    p.resetSimulation()
    assert p.loadTexture(file) == 3


def test_textures_are_numbered_as_bodies_are_loaded_whichever_is_changed_first(cube):
    other = p.loadURDF(str(ASSETS / "cube.urdf"))
    p.changeVisualShape(other, -1, rgbaColor=[1, 0, 0, 1])
    numbers = [
        p.getVisualShapeData(body, flags=p.VISUAL_SHAPE_DATA_TEXTURE_UNIQUE_IDS)[0][8]
        for body in (cube, other)
    ]
    assert numbers == [0, 1]


def test_textures_are_searched_for_like_robots(client, tmp_path):
    # Under a name of its own: the process goes on searching where other tests told it to.
    (tmp_path / "found_here_only.png").write_bytes((ASSETS / "uvmap.png").read_bytes())
    with pytest.raises(p.error, match="Error loading texture"):
        p.loadTexture("found_here_only.png")
    p.setAdditionalSearchPath(str(tmp_path))
    assert p.loadTexture("found_here_only.png") == 0


def test_a_broken_texture_is_refused(client, tmp_path):
    path = tmp_path / "broken.png"
    path.write_bytes(b"\x89PNG")
    with pytest.raises(p.error, match=r"Error loading texture.*broken\.png"):
        p.loadTexture(str(path))


@pytest.mark.parametrize("kind", [list, tuple, bytes, np.array, lambda v: np.array(v, dtype=np.uint8)])
def test_the_image_of_a_texture_changes(cube, tmp_path, kind):
    path = tmp_path / "white.png"
    Image.new("RGB", (2, 2), (255, 255, 255)).save(path)
    texture = p.loadTexture(str(path))
    p.changeVisualShape(cube, -1, textureUniqueId=texture)
    assert len(set(middle())) == 1
    p.changeTexture(texture, kind([255, 0, 0] * 6), 3, 2)
    assert middle()[1:] == [0, 0]


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        ((0, [1] * 11, 2, 2), "invalid arguments"),
        ((0, [300] * 12, 2, 2), "invalid arguments"),
        ((0, [-1] * 12, 2, 2), "invalid arguments"),
        ((0, [0.5] * 12, 2, 2), "invalid arguments"),
        ((0, ["a"] * 12, 2, 2), "invalid arguments"),
        ((0, [[1], [1, 2]], 1, 1), "invalid arguments"),
        ((0, [1] * 12, 0, 2), "invalid arguments"),
        ((-1, [1] * 12, 2, 2), "invalid arguments"),
        ((9, [1] * 12, 2, 2), "Error processing changeTexture"),
    ],
)
def test_bad_pixels_are_refused(cube, arguments, text):
    with pytest.raises(p.error, match=text):
        p.changeTexture(*arguments)


def test_nothing_works_without_a_connection():
    for call in (
        lambda: p.getCameraImage(4, 4),
        lambda: p.loadTexture("a.png"),
        lambda: p.changeTexture(0, [0, 0, 0], 1, 1),
        lambda: p.changeVisualShape(0, -1),
        lambda: p.resetVisualShapeData(0, -1),
    ):
        with pytest.raises(p.error, match="Not connected to physics server"):
            call()


TENT = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 0 0 1\nf 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 3 2\n"
TENT_ROBOT = """<robot name="tent"><link name="base"><visual><geometry>
<mesh filename="tent.obj"/></geometry></visual></link></robot>"""


@pytest.mark.parametrize("way", ["loadURDF", "createVisualShape"])
def test_files_may_be_removed_once_they_are_loaded(client, tmp_path, way):
    mesh, robot = tmp_path / "tent.obj", tmp_path / "tent.urdf"
    mesh.write_text(TENT)
    robot.write_text(TENT_ROBOT)
    if way == "loadURDF":
        p.loadURDF(str(robot), useFixedBase=True)
        mesh.unlink()
    else:
        shape = p.createVisualShape(p.GEOM_MESH, fileName=str(mesh))
        mesh.unlink()
        p.createMultiBody(0, -1, shape)
    view = p.computeViewMatrix([0, -3, 2], [0, 0, 0], [0, 0, 1])
    image = p.getCameraImage(32, 24, view, p.computeProjectionMatrixFOV(60, 4 / 3, 0.1, 10))
    assert (image[4] == 0).sum() > 30


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize(("argument", "value"), [("lightDistance", far) for far in (0, 1e17, 1e30)])
def test_lamps_may_be_anywhere(cube: int, argument: str, value: float) -> None:
    assert np.ptp(colours(shadow=1, **{argument: value})) > 100


@pytest.mark.parametrize(
    "light", [{"lightDistance": 1e31}, {"lightDirection": [1e-300, 0, 0]}, {"lightDirection": [1e300, 0, 0]}]
)
def test_lights_without_direction_are_refused(client: int, light: dict[str, Any]) -> None:
    with pytest.raises(p.error, match="light"):
        colours(shadow=1, **light)
