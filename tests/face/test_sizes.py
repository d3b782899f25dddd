"""Sizes of shapes, which may differ between worlds: whatever depends on them follows."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from carom import Body, Camera, World, Worlds
from carom.camera import DAYLIGHT
from carom.description import Sphere
from carom.layouts.flags import LoadFlags
from carom.model.shape_arrays import ShapeArrays

LAWS = ("bullet", "rigid", "compliant")
COUNT = 16
SCENE = """
<mujoco><option timestep="0.004"/><worldbody><geom name="floor" type="plane" size="5 5 .1"/>
  <body name="barrow" pos="0 0 .3"><freejoint/>
    <inertial pos="0 0 0" mass="2" diaginertia=".02 .03 .04"/>
    <geom name="tray" type="box" size="{tray} .1 .05"/>
    <geom name="wheel" type="sphere" pos=".2 0 -.05" size="{wheel}"/>
    <geom name="leg" type="capsule" pos="-.2 0 0" euler="0 20 0" size="{leg} .1"/>
    <body name="arm" pos="0 0 .1"><joint axis="0 1 0"/>
      <inertial pos="0 0 .1" mass="1" diaginertia=".01 .01 .01"/>
      <geom name="mace" type="cylinder" size="{mace} .06" pos="0 0 .15"/></body></body>
  <body name="ball" pos=".1 .02 1"><freejoint/>
    <inertial pos="0 0 0" mass=".5" diaginertia=".002 .002 .002"/>
    <geom name="round" type="sphere" size="{ball}"/></body>
</worldbody></mujoco>
"""
FIRST = {"tray": 0.25, "wheel": 0.0625, "leg": 0.03125, "mace": 0.0625, "ball": 0.125}
"""Half a side, or radii [m]; all of these and their sums are exact in binary."""


def made(law: str = "bullet", **sizes: float) -> World:
    """A body of several shapes on a floor, with a joint, and a ball that falls on it."""
    world = World()
    world.load(SCENE.format(**{**FIRST, **sizes}))
    world.contact = law
    return world


def drawn(count: int = COUNT) -> dict[str, np.ndarray]:
    """Sizes by name, as those of `FIRST`, (count,)."""
    some = np.random.default_rng(3)
    numbers = {"tray": 16.0, "wheel": 32.0, "leg": 32.0, "mace": 16.0, "ball": 16.0}
    return {name: some.integers(1, 5, count) / share for name, share in numbers.items()}


def resize(bodies: Any, sizes: dict[str, Any]) -> None:
    """Set sizes of the shapes of many worlds (count,), or of a lone one."""
    tray, leg, mace = (2.0 * np.asarray(sizes[name]) for name in ("tray", "leg", "mace"))
    of = {**{shape.name: shape for shape in bodies["barrow"].shapes}, "round": bodies["ball"].shapes[0]}
    of["tray"].size = np.stack([tray, np.full_like(tray, 0.2), np.full_like(tray, 0.1)], axis=-1)
    of["wheel"].size = 2.0 * np.asarray(sizes["wheel"])[..., np.newaxis]
    of["leg"].size = np.stack([leg, leg, leg + 0.2], axis=-1)
    of["mace"].size = np.stack([mace, mace, np.full_like(mace, 0.12)], axis=-1)
    of["round"].size = 2.0 * np.asarray(sizes["ball"])[..., np.newaxis]


def of_world(sizes: dict[str, np.ndarray], number: int) -> dict[str, float]:
    return {name: float(values[number]) for name, values in sizes.items()}


def same(worlds: Worlds, number: int, lone: World) -> None:
    """Check that all coordinates and velocities are the same, bit for bit."""
    np.testing.assert_array_equal(worlds.state.position[number], lone.state.position)
    np.testing.assert_array_equal(worlds.state.velocity[number], lone.state.velocity)


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("count", "threads"), [(1, 1), (3, 1), (COUNT, 2)])
def test_worlds_move_as_lone_worlds_that_were_made_so(law: str, count: int, threads: int) -> None:
    sizes = drawn(count)
    worlds = Worlds(made(law), count, threads=threads)
    resize(worlds, sizes)
    worlds.step(200)
    for number in range(count):
        lone = made(law, **of_world(sizes, number))
        lone.step(200)
        same(worlds, number, lone)


@pytest.mark.parametrize("law", LAWS)
def test_sizes_are_set_between_steps_in_one_world_and_in_many(law: str) -> None:
    sizes = drawn(4)
    worlds = Worlds(made(law), 4)
    worlds.step(60)
    resize(worlds, sizes)
    worlds.step(100)
    for number in range(4):
        lone = made(law)
        lone.step(60)
        resize(lone, of_world(sizes, number))
        lone.step(100)
        same(worlds, number, lone)


@pytest.mark.parametrize("law", LAWS)
def test_a_box_that_became_smaller_comes_to_rest_lower(law: str) -> None:
    world = World(contact=law)
    world.gravity = (0.0, 0.0, -10.0)
    world.add_plane()
    box = world.add_box((0.5, 0.5, 0.5), (0.0, 0.0, 0.5))
    world.step(100)
    start = world.snapshot()
    worlds = Worlds(world, 3)
    worlds[box].shapes[0].change(size=0.98, where=[1])
    worlds[box].shapes[0].change(size=0.5, where=[2])
    worlds.step(300)
    np.testing.assert_allclose(worlds[box].pose.position[:, 2], [0.5, 0.49, 0.25], atol=2e-3)
    # The contacts of the start are those of another box.
    worlds.reset()
    worlds.step(300)
    np.testing.assert_allclose(worlds[box].pose.position[:, 2], [0.5, 0.49, 0.25], atol=2e-3)
    box.shapes[0].size = 0.98
    world.restore(start)
    world.step(300)
    assert box.pose.position[2] == pytest.approx(0.49, abs=2e-3)


def test_masses_and_inertias_stay() -> None:
    worlds = Worlds(made(), 2)
    before = worlds["barrow"].dynamics(-1), worlds["barrow"].mass
    worlds["barrow"].shapes["tray"].size = [(1.0, 0.2, 0.1), (0.5, 0.2, 0.1)]
    after = worlds["barrow"].dynamics(-1), worlds["barrow"].mass
    for name, values in before[0].items():
        np.testing.assert_array_equal(after[0][name], values, err_msg=name)
    np.testing.assert_array_equal(after[1], before[1])


def test_what_is_asked_of_worlds_follows() -> None:
    sizes = drawn()
    worlds = Worlds(made(), COUNT)
    resize(worlds, sizes)
    starts = np.array([(0.1, 0.02, 3.0), (-0.9, 0.0, 0.3), (0.0, 0.03, 0.8), (0.2, -1.0, 0.25)])
    ends = np.array([(0.1, 0.02, 0.0), (0.9, 0.0, 0.3), (0.0, 0.0, 0.0), (0.2, 1.0, 0.25)])
    hits = worlds.rays(starts, ends)
    nearest = worlds.nearest("barrow", "ball", 2.0)
    inside = worlds.overlapping((0.3, -0.05, 0.25), (0.6, 0.05, 0.35))
    bounds = {name: worlds[name].bounds for name in ("barrow", "ball")}
    for number in range(COUNT):
        lone = made("bullet", **of_world(sizes, number))
        own = lone.rays(starts, ends)
        for name in own._fields:
            np.testing.assert_array_equal(getattr(hits, name)[number], getattr(own, name), err_msg=name)
        found = Worlds(lone, 1).nearest("barrow", "ball", 2.0)
        assert nearest.distance[number] == found.distance[0]
        assert [link.name for link in inside[number]] == [
            link.name for link in lone.overlapping((0.3, -0.05, 0.25), (0.6, 0.05, 0.35))
        ]
        for name, extent in bounds.items():
            np.testing.assert_array_equal(extent.lower[number], lone[name].bounds.lower)
            np.testing.assert_array_equal(extent.upper[number], lone[name].bounds.upper)
    assert len({len(links) for links in inside}) > 1


def test_sizes_that_were_set_are_told() -> None:
    sizes = drawn()
    worlds, lone = Worlds(made(), COUNT), made()
    resize(worlds, sizes)
    resize(lone, of_world(sizes, 5))
    for name in ("barrow", "ball"):
        for many, one in zip(worlds[name].shapes, lone[name].shapes, strict=True):
            np.testing.assert_array_equal(many.size[5], one.size)
            many.size[:] = 0.0
            assert many.size.all()
    np.testing.assert_array_equal(worlds["ball"].shapes[0].size[:, 0], 2.0 * sizes["ball"])
    assert lone["ball"].shapes[0].geometry == Sphere(sizes["ball"][5])


def test_some_worlds_are_chosen() -> None:
    worlds = Worlds(made(), 4)
    ball = worlds["ball"].shapes[0]
    ball.change(size=1.0, where=[True, False, False, True])
    ball.change(size=[[0.5]], where=[1])
    np.testing.assert_array_equal(ball.size[:, 0], [1.0, 0.5, 0.25, 1.0])
    ball.change(size=[(0.25,) * 3, (0.75,) * 3], where=slice(2, 4), friction=[0.1, 0.2])
    np.testing.assert_array_equal(ball.size[:, 2], [1.0, 0.5, 0.25, 0.75])
    np.testing.assert_array_equal(ball.friction[2:], [0.1, 0.2])
    ball.size = (0.5, 0.5, 0.5)
    np.testing.assert_array_equal(ball.size, np.full((4, 3), 0.5))


WRONG: list[tuple[str, Any]] = [
    ("tray", (0.1, -0.1, 0.1)),
    ("tray", (0.1, 0.0, 0.1)),
    ("tray", (0.1, math.nan, 0.1)),
    ("tray", (0.1, math.inf, 0.1)),
    ("tray", (1e16, 1.0, 1.0)),
    ("tray", (0.1, 0.1)),
    ("tray", "big"),
    ("wheel", (0.1, 0.2, 0.1)),
    ("leg", (0.1, 0.2, 0.5)),
    ("leg", (0.1, 0.1, 0.05)),
    ("mace", (0.1, 0.2, 0.5)),
]


@pytest.mark.parametrize(("name", "size"), WRONG)
def test_wrong_sizes_change_nothing(name: str, size: Any) -> None:
    worlds, lone = Worlds(made(), 3), made()
    for bodies in (worlds, lone):
        shape = bodies["barrow"].shapes[name]  # type: ignore[index]
        before = shape.size.copy()
        with pytest.raises(ValueError, match=r"size|sides|capsule|three"):
            shape.size = size
        with pytest.raises(ValueError, match=r"size|sides|capsule|three"):
            shape.change(friction=0.123, size=size)
        np.testing.assert_array_equal(shape.size, before)
        assert not (np.asarray(shape.friction) == 0.123).any()
    with pytest.raises(ValueError, match=r"size has shape \(2, 3\)"):
        worlds["barrow"].shapes["tray"].size = np.ones((2, 3))


def test_hulls_and_planes_keep_their_size() -> None:
    world = made()
    rounded = world.add_box((0.2, 0.2, 0.2), name="pebble", radius=0.05)
    worlds = Worlds(world, 2)
    for shape in (worlds[rounded].shapes[0], worlds["world"].shapes["floor"]):
        with pytest.raises(NotImplementedError, match="load a body of each size"):
            shape.size = 0.5
        assert shape.size.shape == (2, 3)
    rounded.shapes[0].size = (0.5, 0.25, 0.25)
    np.testing.assert_array_equal(rounded.shapes[0].size, (0.5, 0.25, 0.25))
    np.testing.assert_allclose(rounded.bounds.size, (0.5, 0.25, 0.25), atol=1e-9)
    with pytest.raises(ValueError, match="shorter than edges"):
        rounded.shapes[0].size = 0.05
    with pytest.raises(ValueError, match="size"):
        world["world"].shapes["floor"].size = 1.0


def test_cylinders_that_are_hulls_say_how_to_be_round(tmp_path: Path) -> None:
    file = tmp_path / "can.urdf"
    file.write_text(
        "<robot name='can'><link name='l'><collision><geometry><cylinder radius='.1' length='.5'/></geometry>"
        "</collision></link></robot>"
    )
    world = World()
    hull, can = world.load_urdf(file), world.load_urdf(file, flags=LoadFlags.USE_IMPLICIT_CYLINDER)
    worlds = Worlds(world, 2)
    with pytest.raises(NotImplementedError, match="USE_IMPLICIT_CYLINDER"):
        worlds[hull].shapes[0].size = (0.5, 0.5, 1.0)
    worlds[can].shapes[0].size = (0.5, 0.5, 1.0)
    np.testing.assert_array_equal(worlds[can].shapes[0].size, [(0.5, 0.5, 1.0)] * 2)
    hull.shapes[0].size = (0.5, 0.5, 1.0)
    np.testing.assert_allclose(hull.bounds.size, (0.5, 0.5, 1.0), atol=1e-3)


def pixels(images: Any, body: Any) -> np.ndarray:
    return np.asarray(images.mask(body)).reshape(-1, 48 * 48).sum(axis=1)


@pytest.mark.parametrize("shadow", [False, True])
def test_images_show_the_sizes(shadow: bool) -> None:
    world = World()
    world.add_plane()
    half = math.sqrt(0.5)
    aside = (half, 0.0, 0.0, half)
    shapes: list[tuple[Body, tuple[float, float, float]]] = [
        (world.add_box((0.2, 0.2, 0.2), (0.0, -0.9, 0.5), (0.3, 0.1, 0.2, 0.9), name="b"), (0.9, 0.6, 0.7)),
        (world.add_sphere(0.2, (0.0, -0.3, 0.5), name="s"), (0.6, 0.6, 0.6)),
        (world.add_capsule(0.1, 0.2, (0.0, 0.3, 0.5), (0.2, 0.1, 0.0, 0.9), name="c"), (0.4, 0.4, 0.7)),
        (world.add_cylinder(0.1, 0.3, (0.0, 0.9, 0.5), aside, name="d"), (0.3, 0.3, 0.6)),
        (world.add_capsule(0.1, 0.2, (0.0, 0.6, 1.0), aside, name="e"), (0.3, 0.3, 0.8)),
    ]
    camera = Camera.with_field_of_view(48, 48, 50.0, light=replace(DAYLIGHT, shadow=shadow))
    camera = camera.look_at((2.5, 0.0, 1.0), (0.0, 0.0, 0.6))
    # One without a shaft.
    world["e"].shapes[0].size = 0.2
    worlds = Worlds(world, 3)
    before = worlds.images(camera)
    for body, size in shapes:
        worlds[body].shapes[0].change(size=size, where=[1])
        worlds[body].shapes[0].change(size=0.9 * np.array(size), where=[2])
    images = worlds.images(camera)
    # Shadow maps are those of other bounding spheres.
    assert (images.colour[0] == before.colour[0]).mean() > (0.995 if shadow else 0.9999)
    for body, _ in shapes:
        was, now = pixels(before, body), pixels(images, body)
        assert abs(now[0] - was[0]) <= 1 and now[1] > now[2] > was[2], body.name
    for number in (1, 2):
        lone = worlds.extract(number).image(camera)
        # Corners differ by rounding to single precision.
        assert (images.colour[number] == lone.colour).mean() > (0.98 if shadow else 0.995)
        assert (images.body_ids[number] == lone.body_ids).mean() > 0.998
    # Some worlds only, in another order.
    some = worlds.images(camera, [2, 1])
    np.testing.assert_array_equal(some.colour, images.colour[[2, 1]])
    # Colours of worlds go together with sizes.
    worlds["s"].shapes[0].colour = (1.0, 0.0, 0.0)
    red = worlds.images(camera)
    np.testing.assert_array_equal(pixels(red, "s"), pixels(images, "s"))
    assert (red.colour != images.colour).any()


def test_finer_visible_shapes_stay_as_they_are() -> None:
    world = World()
    world.load(
        '<mujoco><worldbody><body name="b"><geom type="box" size=".2 .2 .2" group="3"/>'
        '<geom type="sphere" size=".2" contype="0" conaffinity="0"/></body></worldbody></mujoco>'
    )
    camera = Camera.with_field_of_view(48, 48, 40.0).look_at((2.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    worlds = Worlds(world, 2)
    before = worlds.images(camera)
    worlds["b"].shapes[0].size = 1.0
    np.testing.assert_array_equal(worlds.images(camera).colour, before.colour)


@pytest.mark.parametrize("law", LAWS)
def test_files_checkpoints_and_copies_keep_them(law: str, tmp_path: Path) -> None:
    sizes = drawn(4)
    worlds = Worlds(made(law), 4)
    resize(worlds, sizes)
    worlds.step(70)
    worlds.save(tmp_path / "many.carom")
    loaded = Worlds.load(tmp_path / "many.carom")
    resumed = Worlds(made(law), 4)
    resumed.resume(worlds.checkpoint())
    lone = worlds.extract(2)
    again = World()
    lone.save(tmp_path / "one.carom")
    again.load_saved(tmp_path / "one.carom")
    copy = lone.copy()
    for many in (loaded, resumed):
        np.testing.assert_array_equal(many["ball"].shapes[0].size, worlds["ball"].shapes[0].size)
    for each in (worlds, loaded, resumed, lone, again, copy):
        each.step(70)
    for number in range(4):
        for name in ("barrow", "ball"):
            wanted = worlds[name].pose.position[number]
            np.testing.assert_array_equal(loaded[name].pose.position[number], wanted)
            np.testing.assert_array_equal(resumed[name].pose.position[number], wanted)
    for each in (lone, again, copy):
        same(worlds, 2, each)
        assert each["ball"].shapes[0].size[0] == 2.0 * sizes["ball"][2]


def test_sizes_are_no_state() -> None:
    worlds = Worlds(made(), 2)
    start = worlds.snapshot()
    worlds["ball"].shapes[0].size = [[0.5], [1.0]]
    worlds.step(10)
    worlds.reset()
    np.testing.assert_array_equal(worlds["ball"].shapes[0].size[:, 0], [0.5, 1.0])
    worlds.restore(start)
    np.testing.assert_array_equal(worlds["ball"].shapes[0].size[:, 0], [0.5, 1.0])
    # What is restored with the sizes it had goes on bit for bit.
    worlds.step(100)
    middle = worlds.snapshot()
    worlds.step(50)
    wanted = worlds["ball"].pose.position
    worlds.restore(middle)
    worlds.step(50)
    np.testing.assert_array_equal(worlds["ball"].pose.position, wanted)


def test_derivatives_of_a_step_are_those_of_lone_worlds() -> None:
    world = World()
    world.contact = "compliant"
    world.gravity = (0.0, 0.0, -10.0)
    world.add_plane()
    ball = world.add_sphere(0.25, (0.0, 0.0, 0.249))
    worlds = Worlds(world, 2)
    worlds[ball].shapes[0].size = [[0.5], [0.5 + 2.0**-10]]
    found = worlds.linearize()
    for number in range(2):
        np.testing.assert_array_equal(found.A[number], worlds.extract(number).linearize().A)
    assert (found.A[0] != found.A[1]).any()


def test_memory_of_what_is_the_same_stays_shared() -> None:
    world = World()
    box = world.add_box()
    worlds = Worlds(world, 8)
    shapes: ShapeArrays = worlds._engine.contact_arrays.shapes
    assert len(shapes.table.numpy["shape_size"]) == 1
    worlds[box].shapes[0].size = np.linspace(0.5, 1.0, 8)[:, np.newaxis]
    lengths = {name: len(shapes.table.numpy[name]) for name in ("shape_size", "shape_path", "link_center")}
    assert lengths == {"shape_size": 8, "shape_path": 1, "link_center": 1}


def test_a_lone_world_is_drawn_and_saved_with_its_sizes(tmp_path: Path) -> None:
    world = World()
    box = world.add_box((0.2, 0.2, 0.2), name="crate")
    camera = Camera.with_field_of_view(48, 48, 40.0).look_at((3.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    before = int(world.image(camera).mask(box).sum())
    box.shapes[0].size = (0.4, 0.8, 0.8)
    larger = int(world.image(camera).mask(box).sum())
    assert larger > 3 * before
    fresh = World()
    other = fresh.add_box((0.2, 0.4, 0.4), name="crate")
    assert int(fresh.image(camera).mask(other).sum()) == larger
    world.save(tmp_path / "one.carom")
    (loaded,) = World().load_saved(tmp_path / "one.carom")
    np.testing.assert_array_equal(loaded.shapes[0].size, (0.4, 0.8, 0.8))
    hit = world.ray((0.0, -2.0, 0.3), (0.0, 2.0, 0.3))
    assert hit is not None
    assert hit.position[1] == pytest.approx(-0.4)


def test_a_set_margin_stays() -> None:
    def start(half: float) -> World:
        world = World()
        world.gravity = (0.0, 0.0, -10.0)
        world.add_plane()
        box = world.add_box((half, half, half), (0.0, 0.0, 1.0), mass=1.0)
        box.change_dynamics(-1, collision_margin=0.03, inertia=(0.1, 0.1, 0.1))
        world.add_sphere(0.25, (0.1, 0.0, 2.5))
        return world

    worlds = Worlds(start(0.25), 2)
    worlds["box"].shapes[0].size = [[0.5], [1.0]]
    lone = start(0.25)
    lone["box"].shapes[0].size = 1.0
    fresh = start(0.5)
    for each in (worlds, lone, fresh):
        each.step(300)
    for name in ("box", "sphere"):
        np.testing.assert_array_equal(lone[name].pose.position, fresh[name].pose.position)
        np.testing.assert_array_equal(worlds[name].pose.position[1], fresh[name].pose.position)
