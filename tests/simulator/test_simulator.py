"""The simulator without a browser: what files bring, what users change, and files that change."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from threading import Thread
from typing import Any

import numpy as np
import pytest
from tests.patience import until
from tests.simulator.files import SCENE, scene, xacro
from tests.viewer.watcher import Watcher

import pybullet_data
from carom import World
from carom.description import Box
from carom.description.keyframe import BodyKeyframe
from carom.errors import DescriptionError
from carom.simulator.loading import main_file
from carom.simulator.simulator import Simulator
from carom.world.robot_files import Choices

Simulate = Callable[..., Simulator]
DATA = Path(pybullet_data.getDataPath())


def told(page: Watcher, kind: str) -> dict[str, Any]:
    """The newest message of a kind that a page was sent; empty before the first one."""
    return page.shown.get((kind, None), {})


def levels(simulator: Simulator) -> list[str]:
    return [line.level for line in simulator.console.lines]


def test_options_are_those_of_the_file_and_it_steps_only_while_it_plays(simulate: Simulate, tmp_path: Path):
    simulator = simulate(scene(tmp_path))
    world = simulator.world
    assert world.gravity.tolist() == [0, 0, -9.81]
    assert world.time_step == 0.002
    assert simulator.viewer.held
    simulator.viewer.pause_control.let_through()
    assert simulator.turn()
    assert world.time == pytest.approx(0.002)
    simulator.viewer.pause(False)
    assert all(simulator.turn() for _ in range(9))
    assert world.time == pytest.approx(0.02)


def test_what_the_command_line_states_holds_also_after_a_reload(simulate: Simulate, tmp_path: Path):
    simulator = simulate(scene(tmp_path), settings={"gravity": (0.0, 0.0, -1.62), "contact": "rigid"})
    assert simulator.world.contact == "rigid"
    assert simulator.reload()
    assert simulator.world.gravity.tolist() == [0, 0, -1.62]
    assert (simulator.world.contact, simulator.world.time_step) == ("rigid", 0.002)


def test_a_page_changes_parameters_and_is_told_of_wrong_ones(simulate: Simulate, tmp_path: Path):
    simulator = simulate(scene(tmp_path))
    with Watcher(simulator.viewer.address) as page:
        page.wait_for(lambda: ("settings", None) in page.shown)
        page.tell("setting", name="gravity", value=[0, 0, -1])
        page.tell("setting", name="contact", value="rigid")
        page.tell("setting", name="split_impulse", value=False)
        page.tell("setting", name="solver_iterations", value=[20])
        until(lambda: len(simulator._tasks) == 4)
        simulator.work()
        parameters = simulator.world.parameters
        assert (parameters.gravity, parameters.contact) == ((0, 0, -1), "rigid")
        assert (parameters.split_impulse, parameters.solver_iterations) == (False, 20)
        for name, value in [
            ("gravity", [1]),
            ("contact", "soft"),
            ("time_step", [0]),
            ("sat", [1]),
            ("x", [1]),
        ]:
            page.tell("setting", name=name, value=value)
        until(lambda: len(simulator._tasks) == 5)
        simulator.work()
        assert levels(simulator) == ["error"] * 5
        texts = " ".join(line.text for line in simulator.console.lines)
        assert "Gravity needs 3 finite numbers, not [1]" in texts
        assert "Law of contact is one of bullet, rigid, compliant, not 'soft'" in texts
        page.wait_for(lambda: len(told(page, "console").get("lines", ())) == 5)
        shown = {it["name"]: it["value"] for it in page.shown["settings", None]["settings"]}
        assert shown["gravity"] == [0, 0, -1]


def test_keyframes_are_gone_to_saved_copied_and_dropped(simulate: Simulate, tmp_path: Path):
    simulator = simulate(scene(tmp_path))
    block = simulator.world["block"]
    with Watcher(simulator.viewer.address) as page:

        def ask(action: str, name: str) -> list[dict[str, object]]:
            before = page.shown.get(("keyframes", None))
            page.tell("keyframe", action=action, name=name)
            until(lambda: simulator._tasks)
            simulator.work()
            page.wait_for(lambda: page.shown["keyframes", None] is not before)
            return page.shown["keyframes", None]["keyframes"]

        page.wait_for(lambda: ("keyframes", None) in page.shown)
        ask("reset", "bent")
        assert simulator.world.time == 1.5
        assert block.joints["swing"].position == 0.25
        assert block.actuators["drive"].control == 0.25
        bent, mine = ask("save", "mine")
        assert (bent["own"], mine["own"], mine["time"]) == (False, True, 1.5)
        assert mine["text"] == str(bent["text"]).replace("bent", "mine")
        assert [it["name"] for it in ask("forget", "mine")] == ["bent"]
    simulator._tasks.append(lambda: simulator._keyframe(0, {"action": "save", "name": "bent"}))
    simulator.work()
    assert [line.text for line in simulator.console.lines] == ["there is a keyframe 'bent' already"]


def test_the_text_of_a_keyframe_is_what_the_file_states(simulate: Simulate, tmp_path: Path):
    simulator = simulate(scene(tmp_path))
    simulator._keyframe(0, {"action": "reset", "name": "bent"})
    simulator._keyframe(0, {"action": "save", "name": "again"})
    from carom.simulator.keyframe_texts import keyframe_text

    text = keyframe_text("again", simulator.files)
    other = World()
    loaded = other.load(scene(tmp_path, SCENE.replace("<keyframe>", f"<keyframe>{text}")))
    first, second = (loaded.keyframes[name].of(loaded["block"]) for name in ("bent", "again"))
    for field in ("time", "positions", "velocities", "linear_velocity", "angular_velocity", "controls"):
        assert np.array(getattr(second, field)) == pytest.approx(np.array(getattr(first, field)), abs=1e-8)
    assert second.pose is not None
    assert second.pose.position == pytest.approx((0.5, 0, 0.1))


def test_a_keyframe_without_a_pose_states_the_other_numbers_in_their_places(
    simulate: Simulate, tmp_path: Path
):
    simulator = simulate(scene(tmp_path))
    body = next(it for it in simulator.files[0].bodies if it.name == "block")
    (bent,) = body.spec.keyframes
    joints = BodyKeyframe("joints", positions=bent.positions, velocities=bent.velocities)
    body.spec = replace(body.spec, keyframes=(bent, joints))
    from carom.simulator.keyframe_texts import keyframe_text

    text = keyframe_text("joints", simulator.files)
    loaded = World().load(scene(tmp_path, SCENE.replace("<keyframe>", f"<keyframe>{text}")))
    found = loaded.keyframes["joints"].of(loaded["block"])
    assert found.positions == pytest.approx(bent.positions)
    assert found.velocities == pytest.approx(bent.velocities)
    assert bent.velocities is not None and any(bent.velocities)
    assert found.pose is not None and found.pose.position == (0, 0, 0)
    assert np.abs(found.pose.orientation) == pytest.approx((0, 0, 0, 1))


def test_the_text_of_a_keyframe_of_other_files_is_code(simulate: Simulate):
    simulator = simulate(DATA / "cartpole.urdf")
    body = simulator.files[0].bodies[0]
    body.joints[0].reset(0.25)
    simulator._keyframe(0, {"action": "save", "name": "left"})
    from carom.simulator.keyframe_texts import keyframe_text

    world = World()
    other = world.load(DATA / "cartpole.urdf")[0]
    exec(keyframe_text("left", simulator.files), {"world": world})
    other.reset("left")
    assert other.joints[0].position == 0.25


def test_a_file_that_changes_is_loaded_again_and_states_are_kept(simulate: Simulate, tmp_path: Path):
    file = scene(tmp_path)
    simulator = simulate(file)
    simulator._keyframe(0, {"action": "reset", "name": "bent"})
    simulator._keyframe(0, {"action": "save", "name": "mine"})
    simulator._set(0, {"name": "wind", "value": [1, 0, 0]})
    file.write_text(SCENE.replace('size=".1 .1 .1"', 'size=".2 .2 .1"').replace("<motor", "<position kp='3'"))
    until(lambda: simulator._tasks)
    simulator.work()
    block = simulator.world["block"]
    shape = block.spec.base.collisions[0].geometry
    assert isinstance(shape, Box)
    assert shape.half_extents == pytest.approx((0.2, 0.2, 0.1))
    assert simulator.world.time == 1.5
    assert block.pose.position == pytest.approx([0.5, 0, 0.1])
    assert block.links[-1].velocity.angular == pytest.approx([0, 0, 2])
    assert block.joints["swing"].position == pytest.approx(0.25)
    assert block.joints["wrist"].coordinates == pytest.approx([0.6, 0, 0, 0.8])
    assert block.actuators["drive"].control == 0.25
    assert simulator.world.parameters.wind == (1, 0, 0)
    assert [it.name for it in block.spec.keyframes] == ["bent", "mine"]
    assert levels(simulator) == ["info"]


def test_motors_that_the_user_has_set_go_on_after_a_reload(simulate: Simulate):
    simulator = simulate(DATA / "cartpole.urdf")
    body = simulator.files[0].bodies[0]
    row = body.velocity_index[0]
    body.joints[0].set_position_target(0.5, max_force=10.0)
    motor = simulator.world.motor[row].copy()
    assert motor.any() or simulator.world.pd[row].any()
    pd = simulator.world.pd[row].copy()
    assert simulator.reload()
    assert simulator.files[0].bodies[0] is not body
    assert np.array_equal(simulator.world.motor[row], motor)
    assert np.array_equal(simulator.world.pd[row], pd)


def test_a_broken_file_is_told_and_what_was_there_stays(simulate: Simulate, tmp_path: Path):
    file = scene(tmp_path)
    simulator = simulate(file)
    block = simulator.world["block"]
    file.write_text(SCENE.replace("hinge", "hinged"))
    until(lambda: simulator._tasks)
    simulator.work()
    assert levels(simulator) == ["error"]
    assert "scene.xml" in simulator.console.lines[0].text
    assert simulator.world["block"] is block
    file.write_text(SCENE)
    until(lambda: simulator._tasks)
    simulator.work()
    assert levels(simulator) == ["error", "info"]


def test_reset_after_a_reload_goes_to_where_the_new_file_begins(simulate: Simulate, tmp_path: Path):
    file = scene(tmp_path)
    simulator = simulate(file)
    simulator._keyframe(0, {"action": "reset", "name": "bent"})
    file.write_text(SCENE.replace('pos="0 0 0.1"', 'pos="0 0 0.7"'))
    assert simulator.reload()
    assert simulator.world["block"].pose.position[2] == pytest.approx(0.1)
    simulator.viewer._moments.reset()
    assert simulator.world["block"].pose.position[2] == pytest.approx(0.7)
    assert simulator.world.time == 0


def test_arguments_of_xacro_are_shown_and_changed(simulate: Simulate, tmp_path: Path):
    simulator = simulate(xacro(tmp_path))
    assert simulator.files[0].arguments == {"height": "1.5", "colour": "red"}
    with Watcher(simulator.viewer.address) as page:
        page.wait_for(lambda: ("arguments", None) in page.shown)
        page.tell("arguments", values={"height": "2.5"})
        until(lambda: simulator._tasks)
        simulator.work()
        assert simulator.files[0].arguments["height"] == "2.5"
        box = simulator.world["post"].spec.base.visuals[0].geometry
        assert isinstance(box, Box)
        assert box.half_extents[2] == pytest.approx(1.25)
        page.tell("arguments", values={"height": "tall"})
        until(lambda: simulator._tasks)
        simulator.work()
    assert levels(simulator) == ["info", "error"]
    assert simulator.files[0].arguments["height"] == "2.5"


def test_an_included_file_is_watched(simulate: Simulate, tmp_path: Path):
    simulator = simulate(xacro(tmp_path))
    names = {path.name for path in simulator._watch.paths}
    assert {"post.urdf.xacro", "colours.xacro"} <= names
    colours = tmp_path / "colours.xacro"
    colours.write_text(colours.read_text(encoding="utf-8").replace("red", "blue"), encoding="utf-8")
    until(lambda: simulator._tasks)
    simulator.work()
    assert simulator.files[0].arguments["colour"] == "blue"


def test_several_files_meshes_and_saved_worlds(simulate: Simulate, tmp_path: Path):
    saved = World(gravity=(0, 0, -3))
    saved.add_sphere(0.5, name="globe")
    saved.step(5)
    saved.save(tmp_path / "globe.carom")
    simulator = simulate(tmp_path / "globe.carom", DATA / "duck.obj", DATA / "cartpole.urdf")
    assert [it.format for it in simulator.files] == ["saved world", "mesh", "URDF"]
    assert simulator.world.gravity.tolist() == [0, 0, -3]
    duck = simulator.world["duck"]
    assert duck.fixed_base
    assert simulator.world["globe"]


def test_what_is_ignored_and_warned_of_is_in_the_console(simulate: Simulate, tmp_path: Path):
    simulator = simulate(scene(tmp_path, SCENE.replace("<option", '<option iterations="3" jacobian="dense"')))
    import logging

    logging.getLogger("carom.something").warning("careful: %d", 3)
    logging.getLogger("carom.something").warning("careful: %d", 3)
    line = simulator.console.lines[-1]
    assert (line.level, line.text, line.count) == ("warning", "careful: 3", 2)
    simulator.close()
    logging.getLogger("carom.something").warning("too late")
    assert simulator.console.lines[-1] == line


def test_errors_that_are_logged_are_errors_in_the_console(simulate: Simulate, tmp_path: Path):
    simulator = simulate(scene(tmp_path))
    import logging

    for level in (logging.INFO, logging.WARNING, logging.ERROR, logging.CRITICAL):
        logging.getLogger("carom.something").log(level, "%d", level)
    assert levels(simulator) == ["warning", "error", "error"]


def test_a_step_that_fails_is_told_and_pauses(simulate: Simulate, tmp_path: Path):
    simulator = simulate(scene(tmp_path), play=True)
    assert simulator.turn()
    simulator.world.velocity[:] = np.nan
    assert not simulator.turn()
    assert simulator.viewer.held
    assert levels(simulator)[-1] == "error"


def test_it_runs_until_its_page_is_closed(simulate: Simulate, tmp_path: Path):
    simulator = simulate(scene(tmp_path), play=True)

    def close_after_some_steps() -> None:
        until(lambda: simulator.world.time > 0.01)
        simulator.close()

    closing = Thread(target=close_after_some_steps)
    closing.start()
    simulator.run()
    closing.join()
    assert simulator.world.time > 0.01


def test_of_several_files_the_outermost_robot_is_shown_or_a_mesh(tmp_path: Path):
    mesh, text = tmp_path / "duck.obj", tmp_path / "about.txt"
    (tmp_path / "parts").mkdir()
    outer, inner = tmp_path / "outer.urdf", tmp_path / "parts" / "inner.urdf"
    for file in (outer, inner):
        file.write_text('<robot name="r"><link name="a"/></robot>', encoding="utf-8")
    for file in (mesh, text):
        file.write_text("v 0 0 0", encoding="utf-8")
    assert main_file([text]) is None
    assert main_file([text, mesh]) == mesh
    assert main_file([mesh, inner, text]) == inner
    assert main_file([mesh, inner, outer, text]) == outer


@pytest.mark.parametrize("file", ["missing.urdf", "nothing.sdf"])
def test_files_that_cannot_be_used_are_refused(file: str, simulate: Simulate, tmp_path: Path):
    (tmp_path / "nothing.sdf").write_text("<sdf version='1.6'/>")
    with pytest.raises(DescriptionError, match=file):
        simulate(tmp_path / file)


def test_an_argument_that_no_file_has_is_refused(simulate: Simulate, tmp_path: Path):
    with pytest.raises(ValueError, match="no file has the argument 'hight'; their arguments: colour, height"):
        simulate(xacro(tmp_path), choices=Choices(xacro_args={"hight": "3"}))


def test_a_pause_goes_on_when_no_page_is_left(
    simulate: Simulate, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setattr("carom.viewer.viewer._RECONNECTION", 0.01)
    simulator = simulate(scene(tmp_path))
    with Watcher(simulator.viewer.address) as page:
        page.wait_for(lambda: told(page, "pause").get("paused"))
    until(lambda: simulator.viewer.page_count == 0)
    simulator.viewer._go_on_unwatched()
    assert simulator.viewer.pause_control.closed


def test_what_is_dropped_is_shown_instead(simulate: Simulate, tmp_path: Path):
    from base64 import b64encode

    simulator = simulate(scene(tmp_path))
    with Watcher(simulator.viewer.address) as page:
        parts = [
            ("cart/meshes/note.txt", b"nothing"),
            ("cart/robot.urdf", (DATA / "cartpole.urdf").read_bytes()),
        ]
        for name, content in parts:
            half = len(content) // 2
            page.tell("upload", name=name, start=True, data=b64encode(content[:half]).decode())
            page.tell("upload", name=name, start=False, data=b64encode(content[half:]).decode())
        page.tell("open")
        until(lambda: len(simulator._tasks) == 5)
        simulator.work()
        assert [it.path.name for it in simulator.files] == ["robot.urdf"]
        page.wait_for(lambda: told(page, "simulation").get("files") == ["robot.urdf"])
        page.tell("upload", name="../out.urdf", start=True, data="")
        page.tell("open")
        until(lambda: len(simulator._tasks) == 2)
        simulator.work()
    assert levels(simulator) == ["info", "error", "error"]
    assert "'../out.urdf' is not the path of a file" in simulator.console.lines[1].text
    assert [it.path.name for it in simulator.files] == ["robot.urdf"]
