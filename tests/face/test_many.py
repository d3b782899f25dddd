"""What a `World` is asked, logs and keeps, `Worlds` are asked, log and keep under the same names."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.face.scene import made

from carom import Pose, World, Worlds
from carom.errors import DescriptionError, StateError
from carom.world_files.container import Blocks, packed, unpacked

COUNT = 3


def differing() -> Worlds:
    """Worlds that differ in states, parameters, colours and textures."""
    world, arm, box = made()
    hook = world.constrain(arm.links["hand"], None, "point", name="hook")
    worlds = Worlds(world, COUNT)
    worlds[box].pose = Pose([(1.0, 0.0, 0.5), (1.0, 0.0, 2.0), (0.0, 0.0, 3.0)])
    worlds["box"].shapes["cube"].friction = [0.1, 0.2, 0.3]
    worlds["box"].shapes["cube"].colour = [(1, 0, 0), (0, 1, 0), (0, 0, 1)]
    worlds["box"].shapes["cube"].texture = [None, np.zeros((4, 4, 3), np.uint8), None]
    worlds["arm"].actuators["bend"].kp = [10.0, 20.0, 30.0]
    worlds["arm"].change_dynamics("hand", mass=[0.1, 0.2, 0.3])
    worlds.constraints[hook].enable(False, where=[1, 2])
    worlds.gravity = [(0, 0, -1), (0, 0, -9), (0, 0, -3)]
    worlds.controls = 0.3
    return worlds


def test_worlds_that_were_saved_go_on_bit_for_bit(tmp_path: Path) -> None:
    worlds = differing()
    worlds.step(60)
    worlds.halted[2] = True
    worlds.sensor_seeds[:] = (7, 8, 9)
    worlds.save(tmp_path / "worlds.carom")
    again = Worlds.load(tmp_path / "worlds.carom", threads=1)
    assert (again.count, again.time_step) == (COUNT, worlds.time_step)
    assert again.time.tolist() == worlds.time.tolist()
    assert again.halted.tolist() == [False, False, True]
    assert again.sensor_seeds.tolist() == [7, 8, 9]
    assert again["box"].shapes["cube"].friction.tolist() == [0.1, 0.2, 0.3]
    assert again.constraints["hook"].enabled.tolist() == [True, False, False]
    for each in (worlds, again):
        each.halted[:] = False
    for name in ("colour", "texture"):
        for one, other in zip(
            *(getattr(it["box"].shapes["cube"], name) for it in (worlds, again)), strict=True
        ):
            assert (one is None) == (other is None)
            assert one is None or (one == other).all()
    for _ in range(3):
        worlds.step(20)
        again.step(20)
        for name in ("position", "velocity", "motor_impulse"):
            assert (getattr(again.state, name) == getattr(worlds.state, name)).all()
    assert len(np.unique(worlds.state.position[:, -5])) == COUNT
    again.reset()
    assert again.time.tolist() == pytest.approx([60 * 0.004] * COUNT)


def test_files_of_one_and_of_many_are_told_apart(tmp_path: Path) -> None:
    world, _, _ = made()
    one, many = tmp_path / "one.carom", tmp_path / "many.carom"
    world.save(one)
    Worlds(world, 2).save(many)
    with pytest.raises(DescriptionError, match=r"many worlds: carom\.Worlds\.load\(path\)"):
        World().load(many)
    with pytest.raises(DescriptionError, match=r"many worlds: carom\.Worlds\.load\(path\)"):
        world.restore(many)
    with pytest.raises(DescriptionError, match=r"one world, and not many: world\.load\(path\)"):
        Worlds.load(one)


def test_what_could_not_be_loaded_is_not_saved(tmp_path: Path) -> None:
    worlds = differing()
    worlds["box"].velocity = ((1e300, 0.0, 0.0), (0.0, 0.0, 0.0))
    with pytest.raises(StateError, match="very large"):
        worlds.save(tmp_path / "worlds.carom")
    assert not list(tmp_path.iterdir())


def test_endings_of_files_of_robots_are_refused(tmp_path: Path) -> None:
    world, _, _ = made()
    for it in (world, Worlds(world, 2)):
        for name in ("x.xml", "x.URDF", "x.usda"):
            with pytest.raises(ValueError, match=r"end its name in \.carom, as x\.carom.*description\.write"):
                it.save(tmp_path / name)
    assert not list(tmp_path.iterdir())


def _count(many: dict[str, Any]) -> None:
    many["count"] = 4


def _missing(many: dict[str, Any]) -> None:
    del many["state"]["position"]


def _structure(many: dict[str, Any]) -> None:
    many["parameters"]["shapes"]["shape_kind"] = many["parameters"]["shapes"]["shape_lateral_friction"]


def _counts(many: dict[str, Any]) -> None:
    many["contacts"]["count_contacts"]["at"] += 8


def _looks(many: dict[str, Any]) -> None:
    many["looks"]["colours"][0][0][2] = 99


def _image(many: dict[str, Any]) -> None:
    many["looks"]["images"] = []


def _seeds(many: dict[str, Any]) -> None:
    many["sensor_seeds"] = [1]


@pytest.mark.parametrize("spoil", [_count, _missing, _structure, _counts, _looks, _image, _seeds])
def test_files_that_make_no_sense_are_refused(spoil: Any, tmp_path: Path) -> None:
    worlds = differing()
    worlds.step(100)
    path = tmp_path / "worlds.carom"
    worlds.save(path)
    document, blocks = unpacked(path.read_bytes(), path)
    document = json.loads(json.dumps(document))
    spoil(document["worlds"])
    kept = Blocks()
    kept.add(bytes(blocks))
    path.write_bytes(packed(document, kept))
    with pytest.raises(DescriptionError):
        Worlds.load(path)


def test_a_ray_and_overlaps_are_those_of_each_world() -> None:
    worlds = differing()
    starts = np.array([(1.0, 0.0, 5.0), (1.0, 0.0, 6.0), (9.0, 9.0, 5.0)])
    ends = np.array([(1.0, 0.0, -1.0), (1.0, 0.0, -1.0), (9.0, 9.0, 1.0)])
    hits = worlds.ray(starts, ends)
    lower, upper = (0.5, -0.5, -1.0), np.array([(2, 2, 1.2), (2, 2, 3.0), (2, 2, 1.2)])
    found = worlds.overlapping(lower, upper)
    for number in range(COUNT):
        lone = worlds.extract(number)
        hit = lone.ray(starts[number], ends[number])
        assert (hit is None) == (not hits.found[number])
        if hit is not None:
            assert (hits.bodies[number], hits.links[number]) == (hit.body.id, hit.link.index)
            np.testing.assert_allclose(hits.position[number], hit.position, atol=1e-12)
            assert hits.distance[number] == pytest.approx(hit.distance)
        names = [(link.body.name, link.name) for link in lone.overlapping(lower, upper[number])]
        assert [(link._batch.name, link.name) for link in found[number]] == names
    assert np.isinf(hits.distance[2])
    assert np.isnan(hits.position[2]).all()
    assert not worlds.ray((9, 9, 5), (9, 9, 4)).found.any()
    with pytest.raises(ValueError, match=r"lower must have shape \(3,\) or \(3, 3\), not \(2,\)"):
        worlds.overlapping((0, 0), (1, 1))
    with pytest.raises(ValueError, match="start must have shape"):
        worlds.ray(np.zeros((2, 3)), (0, 0, 0))


def test_logs_have_the_world_behind_the_step() -> None:
    worlds = differing()
    lone = worlds.extract(1)
    with worlds.log("position", "velocity", every=2) as log, lone.log("position", every=2) as own:
        worlds.step(10)
        lone.step(10)
    worlds.step()
    assert log["position"].shape == (5, COUNT, lone.state.position.size)
    assert (log["position"][:, 1] == own["position"]).all()
    assert log["time"].shape == (5, COUNT)
    assert log["time"][:, 1].tolist() == own["time"].tolist()
    assert repr(log) == "<WorldsLog of position, velocity, time: 5 steps recorded>"
    for names, every, words in (
        (("speed",), 1, "there is no array 'speed'; there are position"),
        ((), 0, "every"),
    ):
        for it in (worlds, lone):
            with pytest.raises(ValueError, match=words):
                it.log(*names, every=every)


def test_the_state_of_many_is_that_of_each_with_the_world_in_front() -> None:
    worlds = differing()
    worlds.step(3)
    lone = worlds.extract(2)
    for name in ("position", "velocity", "link_pose", "joint_torque"):
        own = getattr(lone.state, name)
        assert getattr(worlds.state, name).shape == (COUNT, *own.shape)
        assert (getattr(worlds.state, name)[2] == own).all()
    worlds.state.velocity[:] = 0.0
    assert not worlds["box"].velocity.linear.any()


def test_parameters_of_worlds_are_set_by_their_names_in_a_world() -> None:
    worlds = differing()
    worlds.change_parameters(gravity=(0, 0, -5), where=[0])
    worlds.change_parameters(gravity=[(0, 0, -6), (0, 0, -7)], where=[False, True, True])
    assert worlds.gravity[:, 2].tolist() == [-5, -6, -7]
    with pytest.raises(
        TypeError, match="no parameter 'time_step' can differ between worlds; those that can are"
    ):
        worlds.change_parameters(time_step=0.1)
    with pytest.raises(ValueError, match="wind"):
        worlds.change_parameters(gravity=(0, 0, 0), wind=(1, 2))
    assert worlds.gravity[:, 2].tolist() == [-5, -6, -7]
    copied = worlds.parameters
    assert copied.time_step == worlds.time_step
    copied.time_step = 1.0
    assert worlds.time_step != 1.0


def test_bodies_are_in_worlds_as_in_a_world() -> None:
    world, arm, box = made()
    worlds = Worlds(world, 2)
    for it in (world, worlds):
        assert "arm" in it
        assert arm in it
        assert 2 in it
        assert "hand" not in it
        assert -1 not in it
        assert [body.name for body in it] == ["world", "arm", "box"]
        # A number is that of a body, and not of a world: `extract(number)` is one of the worlds.
        assert [it[number].name for number in (0, 1, -1)] == ["world", "arm", "box"]
        assert it.bodies[-1].name == "box"
        with pytest.raises(KeyError, match="there is no body -4"):
            it[-4]
        with pytest.raises(TypeError, match=r"has no len\(\)"):
            len(it)  # type: ignore[arg-type]
    assert worlds[box] in worlds


def test_some_worlds_are_chosen_by_a_slice_as_well() -> None:
    worlds = differing()
    worlds["arm"].joints.reset(0.5, where=slice(1, None))
    assert worlds["arm"].joints.positions[:, 0].tolist() == [0.0, 0.5, 0.5]
    worlds["box"].shapes["cube"].change(friction=0.9, where=slice(None, None, 2))
    assert worlds["box"].shapes["cube"].friction.tolist() == [0.9, 0.2, 0.9]
    worlds.step(2, where=slice(0, 1))
    assert worlds.time.tolist() == [0.008, 0.0, 0.0]
    worlds.reset(where=slice(-2, None))
    assert worlds["arm"].joints.positions[1:].tolist() == [[0.0, 0.0]] * 2
    with pytest.raises(ValueError, match=r"a mask, numbers of worlds or a slice, not 1\.5"):
        worlds.step(where=1.5)


def test_times_are_written_and_what_is_for_good_is_refused() -> None:
    worlds = differing()
    own = worlds.time
    worlds.time = np.array(2.0)
    assert worlds.time is own
    worlds.step(where=[1])
    worlds.reset(where=2)
    assert worlds.time.tolist() == [2.0, 2.004, 0.0]
    for name in ("count", "device"):
        with pytest.raises(AttributeError, match=f"{name} of Worlds stays what it is"):
            setattr(worlds, name, 3)
    for wrong in (worlds, "scene.carom"):
        make: Any = Worlds
        with pytest.raises(TypeError, match=r"Worlds are copies of a World.*carom\.Worlds\.load"):
            make(wrong, 2)
