"""Setters of the state of a body: one call, which reads the numbers and then looks for the rows."""

from __future__ import annotations

import sys
import threading
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from carom import World
from carom.scene.body import Body
from carom.scene.core.state_writer import StateWriter, write_state

_MODEL = """<mujoco><worldbody><body name="a" pos="0 0 1"><freejoint/><geom name="g" size="0.1"/>
<body name="b" pos="0 0 .3"><joint name="i"/><geom name="h" size="0.1"/>
<body name="c" pos="0 0 .3"><joint name="k" type="ball"/><geom name="o" size="0.1"/>
<body name="d" pos="0 0 .3"><geom name="p" size="0.1"/></body></body></body></body></worldbody></mujoco>"""
_TURN = (0.0, 0.6, 0.0, 0.8)

# What each changes, apart from poses of links.
SETTERS: dict[str, tuple[Callable[[Any], None], set[str]]] = {
    "pose": (
        lambda body: body.set_inertial_pose((1.0, 2, np.float32(3)), (0.0, 3.0, 0.0, 4.0)),
        {"position", "warm"},
    ),
    "pose in arrays": (
        lambda body: body.set_inertial_pose(np.ones(3), np.array(_TURN)),
        {"position", "warm"},
    ),
    "velocity": (lambda body: body.set_base_velocity((1.0, 2.0, 3.0), [4, 5, 6]), {"dof_velocity"}),
    "joint": (lambda body: body.set_joint_state(0, [0.3], [0.4]), {"position", "dof_velocity"}),
    "joint with a quaternion": (
        lambda body: body.set_joint_state(-2, (0.0, 3.0, 0.0, 4.0), np.ones(3)),
        {"position", "dof_velocity"},
    ),
    "position": (lambda body: body.set_joint_state(0, iter([0.3]), None), {"position"}),
    "rates": (lambda body: body.set_joint_state(np.int64(1), None, (1.0, 2.0, 3.0)), {"dof_velocity"}),
    "fixed joint": (lambda body: body.set_joint_state(2, [0.3], [0.4]), set()),
}


@pytest.fixture
def load(tmp_path: Path) -> Callable[[], Body]:
    path = tmp_path / "model.xml"
    path.write_text(_MODEL)

    def loaded() -> Body:
        """A body behind another one, which touches the ground."""
        world = World()
        world.load_urdf("plane.urdf", as_pybullet=True)
        world.load_urdf("cube_small.urdf", (3.0, 0.0, 0.024), as_pybullet=True)
        world.load(path)
        world.step(3)
        world.contact_arrays.contacts.numpy["contact_warm_start"][0, :3] = 2.0
        return world.bodies[2]

    return loaded


def _state(body: Body) -> dict[str, Any]:
    world = body.world
    seen = {name: world.arrays.state.numpy[name].copy() for name in ("position", "dof_velocity", "link_pose")}
    seen["warm"] = world.contact_arrays.contacts.numpy["contact_warm_start"].copy()
    return {name: array.tobytes() for name, array in seen.items()}


def _velocity(body: Body) -> list[float]:
    return body.world.velocity[body.first_velocity : body.first_velocity + 6].tolist()


@pytest.mark.parametrize("name", SETTERS)
def test_the_library_and_python_write_the_same_bits(
    name: str, load: Callable[[], Body], monkeypatch: pytest.MonkeyPatch
) -> None:
    natively, in_python, (setter, changes) = load(), load(), SETTERS[name]
    before = _state(natively)
    assert before == _state(in_python)
    setter(natively)
    monkeypatch.setattr(StateWriter, "write", write_state)
    setter(in_python)
    after = _state(natively)
    assert after == _state(in_python)
    assert {field for field in before if after[field] != before[field]} - {"link_pose"} == changes


class _Number:
    """A number that removes the body in front when it is asked for its value."""

    def __init__(self, world: World, value: float) -> None:
        self._world, self._value = world, value

    def __float__(self) -> float:
        if 1 in self._world.bodies:
            self._world.remove(1)
        return self._value


def test_rows_that_move_while_numbers_are_read_are_found(load: Callable[[], Body]) -> None:
    for known in (False, True):
        body = load()
        if known:
            body.set_base_velocity((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
        number: Any = _Number(body.world, 5.0)
        before = body.first_velocity, body.velocity_index[0]
        body.set_base_velocity((1.0, 2.0, number), (3.0, 4.0, 5.0))
        assert (body.first_velocity, body.velocity_index[0]) == (before[0] - 6, before[1] - 6)
        assert _velocity(body) == [3.0, 4.0, 5.0, 1.0, 2.0, 5.0]
        body = load()
        number = _Number(body.world, 0.25)
        body.set_joint_state(0, [number], [0.5])
        assert (body.joints[0].position, body.joints[0].velocity) == (0.25, 0.5)


def test_nothing_changes_for_what_is_no_number_and_for_a_body_that_is_gone(load: Callable[[], Body]) -> None:
    body: Any = load()
    before = _state(body)
    for call in (
        lambda: body.set_base_velocity((1.0, 2.0, 3.0), (4.0, 5.0, "6")),
        lambda: body.set_inertial_pose((1.0, 2.0, None), _TURN),
        lambda: body.set_joint_state(0, [0.3], ["0.4"]),
    ):
        with pytest.raises(TypeError):
            call()
    with pytest.raises(IndexError):
        body.set_joint_state(3, [0.3], [0.4])
    assert _state(body) == before
    body.world.remove(body.id)
    for setter, _ in SETTERS.values():
        with pytest.raises(ValueError, match="no longer in its world"):
            setter(body)


@pytest.mark.parametrize("name", ["pose", "velocity", "rates"])
def test_a_setter_is_one_call_without_any_other_of_python(name: str, load: Callable[[], Body]) -> None:
    if StateWriter.write is write_state:
        pytest.skip("Python writes here")
    body = load()
    SETTERS[name][0](body)
    called: list[str] = []
    sys.setprofile(lambda frame, event, _: called.append(frame.f_code.co_name) if event == "call" else None)
    try:
        SETTERS[name][0](body)
    finally:
        sys.setprofile(None)
    assert [it for it in called if it not in ("<lambda>", "_state_of")] == [
        {"pose": "set_inertial_pose", "velocity": "set_base_velocity", "rates": "set_joint_state"}[name]
    ]


def test_a_setter_waits_for_the_thread_that_has_the_world(load: Callable[[], Body]) -> None:
    body = load()
    with body.world.lock:
        thread = threading.Thread(target=body.set_base_velocity, args=((1.0, 2.0, 3.0), (4.0, 5.0, 6.0)))
        thread.start()
        thread.join(0.1)
        assert thread.is_alive()
        assert _velocity(body) != [4.0, 5.0, 6.0, 1.0, 2.0, 3.0]
    thread.join()
    assert _velocity(body) == [4.0, 5.0, 6.0, 1.0, 2.0, 3.0]
