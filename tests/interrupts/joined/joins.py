"""Handlers that wait for a thread which makes calls: `python -m tests.interrupts.joined.joins pybullet`.

A signal comes at each line of a call, the first time that it is reached, and its handler lets a thread make
calls on the same world. If it runs in a call that holds a lock of ours, they wait for each other, and the
name of the function is printed. Each is called for the second time: the first time, modules are imported.
"""

from __future__ import annotations

import faulthandler
import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import Semaphore, Thread
from typing import Any

from tests.interrupts.test_prepared_changes import CHANGES, at_lines
from tests.interrupts.test_prepared_changes import made as made_world
from tests.interrupts.test_worlds_setters import SETTERS
from tests.interrupts.test_worlds_setters import _made as made_worlds
from tests.surface.call import Calls
from tests.surface.calls import CALLS
from tests.surface.perform import Places, prepare

import pybullet as p
from carom import Camera, World, Worlds
from carom.algorithms.inverse_dynamics import inverse_dynamics
from carom.algorithms.jacobian import jacobian
from carom.algorithms.mass_matrix import mass_matrix
from carom.profiling import profile

Run = Callable[[], Any]

# A handler that waits in vain waits for so long, and only once in each function.
_VAIN = 2.0
_LIMIT = 300.0
# These end the connection, or wait for something else than the world.
_OTHER = {"connect", "disconnect", "vhacd"}


class Other:
    """Another thread, which makes calls when a handler asks it to.

    Attributes:
        waited: How many handlers it has answered.
        is_stuck: It has not answered in time.
    """

    def __init__(self, work: Run) -> None:
        self.waited, self.is_stuck = 0, False
        self._work = work
        self._asked, self._answered = Semaphore(0), Semaphore(0)
        Thread(target=self._run, daemon=True).start()
        signal.signal(signal.SIGUSR1, self._handle)

    def is_stopped_by(self, call: Run) -> bool:
        """Whether a handler in the middle of a call waits for the thread in vain."""
        self.waited, self.is_stuck = 0, False
        with suppress(Exception):
            at_lines(call, self._ring, again=False)
        self._ring()
        if self.is_stuck:
            self._answered.acquire()
        return self.is_stuck

    def _ring(self) -> None:
        if not self.is_stuck:
            signal.raise_signal(signal.SIGUSR1)

    def _handle(self, _number: int, _frame: object) -> None:
        if self.is_stuck:
            return
        self.waited += 1
        self._asked.release()
        self.is_stuck = not self._answered.acquire(timeout=_VAIN)

    def _run(self) -> None:
        while True:
            self._asked.acquire()
            # The world may have been taken down.
            with suppress(Exception):
                self._work()
            self._answered.release()


def of_pybullet(folder: Path) -> Iterator[str]:
    """Functions of `pybullet` that a handler waits in for ever; whether they read, change or do neither."""
    places = Places(str(folder))

    def work() -> None:
        p.stepSimulation()
        p.getVisualShapeData(0)

    other = Other(work)
    for name, calls in CALLS.items():
        if name in _OTHER:
            continue
        for call in (_called, other.is_stopped_by):
            prepare(p, calls, places)
            try:
                if call(_needed(name, calls, places)):
                    yield name
            finally:
                for client in range(4):
                    if p.isConnected(client):
                        p.disconnect(client)


def _called(call: Run) -> None:
    with suppress(Exception):
        call()


def _must_be_called(name: str, call: Run) -> None:
    try:
        call()
    except Exception as problem:
        # Properties may have no value here, as the orientation of a joint that turns about an axis.
        if name[0].islower():
            print(f"{name} has not been called: {problem!r}")


def _needed(name: str, calls: Calls, places: Places) -> Run:
    needed = {key: places.real(value) for key, value in calls.needed.items()}
    return lambda: getattr(p, name)(**needed)


WORLD: dict[str, Callable[[World], Any]] = {
    "step": lambda world: world.step(3),
    "copy": lambda world: world.copy(),
    "snapshot": lambda world: world.snapshot(),
    "restore": lambda world: world.restore(world.snapshot()),
    "analytics": lambda world: world.analytics(),
    "profile": lambda world: profile(world, 2),
    "detect_collisions": lambda world: world.detect_collisions(),
    "linearize": lambda world: world.linearize(method="differences"),
    "cast_rays": lambda world: world.queries().cast_rays([(0, 0, 9)], [(0, 0, -9)]),
    "update_link_poses": lambda world: world.update_link_poses(world.bodies[1]),
    "capture": lambda world: Camera(8, 6, fx=6.0).look_at((2, 2, 1), (0, 0, 0)).capture(world),
    "save": lambda world: world.save("joins.world"),
    "set_inertial_pose": lambda world: world.bodies[1].set_inertial_pose((0, 0, 1), (0, 0, 0, 1)),
    "set_base_velocity": lambda world: world.bodies[1].set_base_velocity((0, 0, 1), (0, 0, 0)),
    "joints.reset": lambda world: world.bodies[1].joints.reset([0.1] * 8),
    "set_torques": lambda world: world.bodies[1].joints.set_torques(0.1),
    "apply_force": lambda world: world.bodies[1].links[0].apply_force((0, 0, 1)),
    "jacobian": lambda world: jacobian(world.bodies[1], 1, (0, 0, 0), _zeros(world)),
    "mass_matrix": lambda world: mass_matrix(world.bodies[1], _zeros(world)),
    "inverse_dynamics": lambda world: inverse_dynamics(
        world.bodies[1], [*[0.0] * 6, 1.0, *[0.0] * 8], [0.0] * 14, [0.0] * 14
    ),
}
WORLDS: dict[str, Callable[[Worlds], Any]] = {
    "step": lambda worlds: worlds.step(3),
    "save": lambda worlds: worlds.snapshot(),
    "restore": lambda worlds: worlds.restore(worlds.snapshot()),
    "resume": lambda worlds: worlds.resume(worlds.checkpoint()),
    "extract": lambda worlds: worlds.extract(1),
    "contacts": lambda worlds: worlds.contacts(1),
    "contact_list": lambda worlds: worlds.contact_list(1),
    "links_in_contact": lambda worlds: worlds.links_in_contact(1, 0),
    "contact_forces": lambda worlds: worlds.contact_forces(1),
    "rays": lambda worlds: worlds.rays([(0, 0, 9)], [(0, 0, -9)]),
    "change_parameters": lambda worlds: worlds.change_parameters(gravity=(0, 0, -1)),
    "images": lambda worlds: worlds.images(Camera(8, 6, fx=6.0)),
    "detect_collisions": lambda worlds: worlds.detect_collisions(),
    "mass_matrices": lambda worlds: worlds[1].mass_matrix(),
    "jacobians": lambda worlds: worlds[1].jacobian(1),
    "inverse_dynamics": lambda worlds: worlds[1].inverse_dynamics(0.0),
    "dynamics": lambda worlds: worlds[1].dynamics(3),
    **SETTERS,
}


def _zeros(world: World) -> list[float]:
    body = world.bodies[1]
    return [0.0] * sum(body.velocity_count[1:])


def _properties(*objects: object) -> Iterator[tuple[str, Run]]:
    for it in objects:
        kind = type(it)
        for name in dir(kind):
            if not name.startswith("_") and not callable(getattr(kind, name)):
                yield f"{kind.__name__}.{name}", lambda it=it, name=name: getattr(it, name)


def of_world(folder: Path) -> Iterator[str]:
    """The same of `carom.World`, its bodies, links and joints."""
    os.chdir(folder)
    world = made_world()

    def work() -> None:
        world.step()
        world.snapshot()

    other = Other(work)
    body = world.bodies[1]
    things = world, body, body.joints, next(iter(body.joints)), body.links[0]
    named = [(name, lambda call=call: call(world)) for name, call in WORLD.items()]
    for name, call in [*named, *_properties(*things)]:
        _must_be_called(name, call)
        if other.is_stopped_by(call):
            yield name
    for name, prepared in CHANGES.items():
        world = made_world()
        prepared(world, folder)()
        world = made_world()
        if other.is_stopped_by(prepared(world, folder)):
            yield name


def of_worlds(_folder: Path) -> Iterator[str]:
    """The same of `carom.Worlds` and of its bodies."""
    worlds = made_worlds()

    def work() -> None:
        worlds.step()
        worlds.snapshot()

    other = Other(work)
    named = [(name, lambda call=call: call(worlds)) for name, call in WORLDS.items()]
    for name, call in [*named, *_properties(worlds, worlds[1])]:
        _must_be_called(name, call)
        if other.is_stopped_by(call):
            yield name


def main() -> None:
    """Print the names."""
    faulthandler.dump_traceback_later(_LIMIT, exit=True)
    with TemporaryDirectory() as folder:
        for name in {"pybullet": of_pybullet, "World": of_world, "Worlds": of_worlds}[sys.argv[1]](
            Path(folder)
        ):
            print(name, flush=True)
        os.chdir("/")
    print("all have been called", flush=True)
    os._exit(0)


if __name__ == "__main__":
    main()
