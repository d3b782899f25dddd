"""A file that is loaded again: the body is a copy of rows made before, as long as no file has changed."""

import logging
import os
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import pybullet_data
from carom.errors import DescriptionError
from carom.layouts.flags import LoadFlags
from carom.native.tables import ArrayTable
from carom.scene import changes
from carom.scene.body import Body
from carom.world.world import World

DATA = Path(pybullet_data.getDataPath())
LONG_AGO = time.time() - 1000.0
SHORT_AGO = time.time() - 500.0

CUBE = """<robot name="{name}"><link name="base">
  <inertial><mass value="{mass}"/><inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial>
  <collision><geometry>{shape}</geometry></collision></link></robot>"""
BOX = '<box size="1 1 1"/>'
TETRAHEDRON = "v 0 0 0\nv {size} 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n"


def write(path: Path, text: str, modified: float = LONG_AGO) -> Path:
    """Write a file that seems to have been there for a while."""
    path.write_text(text)
    os.utime(path, (modified, modified))
    return path


def write_cube(path: Path, mass: int = 1, shape: str = BOX, modified: float = LONG_AGO) -> Path:
    return write(path, CUBE.format(name="cube", mass=mass, shape=shape), modified)


def tables(world: World) -> list[ArrayTable]:
    return [world.arrays.model, world.arrays.state, world.contact_arrays.shapes.table]


def content(world: World) -> dict[str, np.ndarray]:
    """All arrays; rows that are not in use have to be zero as well."""
    return {
        f"{n} {name}": array for n, table in enumerate(tables(world)) for name, array in table.numpy.items()
    }


def load_all(world: World, remove: int | None = None) -> World:
    world.parameters.contact_breaking_threshold = 0.03
    world.apply_parameters()
    world.load_urdf("plane.urdf")
    for number in range(3):
        for name in ("cube.urdf", "r2d2.urdf", "franka_panda/panda.urdf", "samurai.urdf"):
            world.load_urdf(name, (number, 0.1, 0.2), (0.0, 0.6, 0.0, 0.8), fixed_base="panda" in name)
        world.load_urdf("humanoid/humanoid.urdf", scale=0.25, flags=LoadFlags.USE_SELF_COLLISION)
    if remove is not None:
        world.remove(remove)
        world.load_urdf("r2d2.urdf", flags=LoadFlags.USE_INERTIA_FROM_FILE)
    return world


@pytest.mark.parametrize("remove", [None, 3, 9])
def test_the_arrays_are_as_without_copies(remove: int | None, monkeypatch: pytest.MonkeyPatch) -> None:
    load_all(World())
    copied = load_all(World(), remove)
    assert sum(body.spec.pattern is not None for body in copied.bodies.values()) >= 12
    monkeypatch.setattr(changes, "pattern_of", lambda spec: None)
    written = load_all(World(), remove)
    assert copied.arrays.used == written.arrays.used
    assert copied.contact_arrays.shapes.used == written.contact_arrays.shapes.used
    expected = content(written)
    for name, array in content(copied).items():
        np.testing.assert_array_equal(array, expected[name], err_msg=name)
    for body, other in zip(copied.bodies.values(), written.bodies.values(), strict=True):
        assert body.all_dynamics == other.all_dynamics
        assert (body.rows, body.position_index, body.velocity_index) == (
            other.rows,
            other.position_index,
            other.velocity_index,
        )
        for link in range(-1, body.joint_count):
            row = body.first_link + 1 + link
            assert copied.contact_arrays.shapes.bounds(row) == written.contact_arrays.shapes.bounds(row)


def test_what_is_changed_in_one_body_is_not_in_the_next(tmp_path: Path) -> None:
    path, world = write_cube(tmp_path / "cube.urdf"), World()
    for _ in range(3):
        body = world.load_urdf(path)
        assert body.dynamics(-1).lateral_friction == 0.5
        assert world.contact_arrays.shapes.table.numpy["shape_lateral_friction"][0, body.first_link] == 0.5
        body.change_dynamics(-1, lateral_friction=0.9, mass=7.0)


def mass_of(path: Path, world: World) -> float:
    return world.load_urdf(path).dynamics(-1).mass


def twice(path: Path, world: World) -> list[float]:
    """Load a file often enough for copies."""
    return [mass_of(path, world) for _ in range(3)]


def test_a_file_of_the_same_size_that_was_written_again(tmp_path: Path) -> None:
    path, world = write_cube(tmp_path / "cube.urdf"), World()
    assert twice(path, world) == [1.0] * 3
    write_cube(path, mass=2, modified=SHORT_AGO)
    assert twice(path, world) == [2.0] * 3


def test_a_file_that_is_written_while_it_is_new(tmp_path: Path) -> None:
    # Time stamps are too coarse to tell such contents apart.
    path, world, now = tmp_path / "cube.urdf", World(), time.time()
    for mass in (1, 2, 3):
        write_cube(path, mass=mass, modified=now)
        assert mass_of(path, world) == mass_of(path, world) == mass


def test_a_file_that_was_moved_to_the_place_of_another(tmp_path: Path) -> None:
    path, world = write_cube(tmp_path / "cube.urdf"), World()
    assert twice(path, world) == [1.0] * 3
    write_cube(tmp_path / "other.urdf", mass=2).replace(path)
    assert twice(path, world) == [2.0] * 3


def test_a_file_that_is_gone(tmp_path: Path) -> None:
    path, world = write_cube(tmp_path / "cube.urdf"), World()
    twice(path, world)
    path.unlink()
    with pytest.raises(DescriptionError, match="no such file"):
        world.load_urdf(path)
    assert len(world.bodies) == 3


def width(world: World, body: Body) -> float:
    return 2.0 * world.contact_arrays.shapes.bounds(body.first_link).half[0]


@pytest.fixture
def meshed(tmp_path: Path) -> Path:
    """A robot whose collision shape is the mesh `t.obj` beside it."""
    write(tmp_path / "t.obj", TETRAHEDRON.format(size=1))
    return write_cube(tmp_path / "cube.urdf", shape='<mesh filename="t.obj"/>')


def test_a_mesh_that_has_changed(meshed: Path) -> None:
    world = World()
    widths = [width(world, world.load_urdf(meshed)) for _ in range(3)]
    assert widths == [widths[0]] * 3
    write(meshed.with_name("t.obj"), TETRAHEDRON.format(size=2), SHORT_AGO)
    for _ in range(3):
        assert width(world, world.load_urdf(meshed)) == pytest.approx(widths[0] + 1.0, abs=1e-3)


def test_a_mesh_that_is_found_elsewhere_now(meshed: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    world = World()
    widths = [width(world, world.load_urdf(meshed)) for _ in range(3)]
    elsewhere = meshed.parent / "elsewhere"
    elsewhere.mkdir()
    write(elsewhere / "t.obj", TETRAHEDRON.format(size=3))
    # The working directory is searched first.
    monkeypatch.chdir(elsewhere)
    assert width(world, world.load_urdf(meshed)) == pytest.approx(widths[0] + 2.0, abs=1e-3)


@pytest.mark.parametrize(
    "spoil", [Path.unlink, lambda path: write(path, "v 0 0", SHORT_AGO)], ids=["gone", "bad"]
)
def test_a_mesh_that_cannot_be_used_any_more(meshed: Path, spoil: Callable[[Path], object]) -> None:
    world = World()
    for _ in range(3):
        world.load_urdf(meshed)
    spoil(meshed.with_name("t.obj"))
    with pytest.raises(DescriptionError, match=r"t\.obj"):
        world.load_urdf(meshed)
    assert len(world.bodies) == 3


def test_warnings_are_repeated(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    impossible = CUBE.replace('ixx="1"', 'ixx="9"').format(name="cube", mass=1, shape=BOX)
    path, world = write(tmp_path / "cube.urdf", impossible), World()
    for count in (1, 2, 3):
        world.load_urdf(path, flags=LoadFlags.USE_INERTIA_FROM_FILE)
        assert sum("inertia tensor" in record.message for record in caplog.records) == count


def test_the_outline_is_repeated(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    path, world = write_cube(tmp_path / "cube.urdf"), World()
    with caplog.at_level(logging.INFO):
        for _ in range(3):
            world.load_urdf(path, flags=LoadFlags.PRINT_URDF_INFO)
    assert len(caplog.records) == 3


def test_flags_and_fixed_bases_are_told_apart(tmp_path: Path) -> None:
    path, world = write_cube(tmp_path / "cube.urdf"), World()
    for _ in range(3):
        assert not world.load_urdf(path).fixed_base
        assert world.load_urdf(path, fixed_base=True).fixed_base
        bare = world.load_urdf(path, flags=LoadFlags.IGNORE_COLLISION_SHAPES)
        assert not bare.spec.base.collisions
        assert width(world, world.load_urdf(path, scale=3.0)) == pytest.approx(3.0)


def test_a_copy_of_the_world_gets_bodies_of_its_own(tmp_path: Path) -> None:
    path, world = write_cube(tmp_path / "cube.urdf"), World()
    first, *_ = [world.load_urdf(path, (float(number), 0.0, 0.0)) for number in range(3)]
    copy = world.copy()
    before = {name: array.copy() for name, array in content(world).items()}
    copy.remove(first.id)
    copy.load_urdf("r2d2.urdf")
    copy.load_urdf(path)
    for name, array in content(world).items():
        np.testing.assert_array_equal(array, before[name], err_msg=name)
    assert copy.arrays.used["link"] == sum(1 + body.joint_count for body in copy.bodies.values())
    for body in copy.bodies.values():
        assert copy.arrays.model.numpy["tree_first_link"][body.rows.tree] == body.first_link


def test_threads_load_the_same_file(tmp_path: Path) -> None:
    path = write_cube(tmp_path / "cube.urdf")

    def cycle(number: int) -> list[float]:
        world = World()
        for _ in range(60):
            world.load_urdf(path, (float(number), 0.0, 0.0))
            world.load_urdf(path, (0.0, float(number), 0.0), fixed_base=True)
            world.remove(next(iter(world.bodies)))
        return world.position[: world.arrays.used["position"]].tolist()

    with ThreadPoolExecutor(4) as threads:
        found = list(threads.map(cycle, range(8)))
    assert found == [cycle(number) for number in range(8)]
