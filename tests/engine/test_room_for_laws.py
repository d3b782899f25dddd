"""Workspaces of the converged solver and of integrators are as long as the arrays of a world."""

from __future__ import annotations

from pathlib import Path

import pytest

from carom import World

_BALLS = "".join(
    f'<body name="a{k}" pos="{k} 0 1"><joint name="j{k}"/><geom size=".1" pos=".1 0 0"/></body>'
    for k in range(150)
)


def assert_room(world: World) -> None:
    # As the first step does: later ones would hide it, as arrays grow with them.
    world.engine.update_settings(world.parameters)
    world.engine.prepare()
    work, used = world.engine.workspace, world.arrays.used
    if world.contact != "bullet":
        assert work.newton_work.capacity["tree"] >= used["tree"]
        assert work.newton_work.capacity["vector"] >= used["dof"]
    if world.integrator != "discrete":
        assert work.stage_work.capacity["dof"] >= used["dof"]
        assert work.stage_work.capacity["position"] >= used["position"]


@pytest.mark.parametrize("integrator", ["", "Euler", "implicitfast", "RK4"])
@pytest.mark.parametrize("contact", ["compliant", "bullet"])
def test_a_file_that_was_reset_to_a_keyframe_has_room(tmp_path: Path, contact: str, integrator: str) -> None:
    named = f'<option integrator="{integrator}"/>' if integrator else ""
    key = f'<keyframe><key qpos="{".1 " * 150}"/></keyframe>'
    (tmp_path / "file.xml").write_text(f"<mujoco>{named}<worldbody>{_BALLS}</worldbody>{key}</mujoco>")
    world = World(contact=contact)
    world.load(tmp_path / "file.xml").reset("0")
    # Which asks the engine for its structs before any step is prepared.
    assert world["a3"].links[0].velocity.linear[0] == 0.0
    assert_room(world)
    world.step()


@pytest.mark.parametrize("contact", ["rigid", "compliant"])
@pytest.mark.parametrize("integrator", [None, "midpoint"])
def test_a_world_that_gets_another_law_has_room(contact: str, integrator: str | None) -> None:
    world = World(contact="bullet")
    world.add_plane()
    for k in range(150):
        world.add_box((0.1, 0.1, 0.1), (k, 0.0, 0.1), mass=1.0)
    world.step()
    world.contact = contact
    assert_room(world)
    world.step()
    if integrator:
        world.integrator = integrator
        assert_room(world)
        world.step()
