"""Timers whose handlers raise while bodies come and go: `python -m tests.interrupts.signals --seconds 60`.

In a process of its own: what rings at any moment rings in the middle of test runners and of loggers, too.
"""

from __future__ import annotations

import argparse
import faulthandler
import logging
import os
import signal
import sys
from pathlib import Path
from random import Random
from tempfile import TemporaryDirectory
from time import monotonic
from typing import Any

from tests.interrupts.scenes import CALLS, Scene, build, follow

import pybullet as p
from pybullet._clients.clients import clients

# Calls take from 50 µs to some milliseconds.
_SHORTEST, _LONGEST = 2e-5, 4e-3
_MAX_RINGS = 3
_SCENE_LASTS = 100
_MAX_BODIES = 60


class Alarm(Exception):
    """What the handler raises."""


class Bell:
    """Rings up to three times, at random moments.

    Attributes:
        left: How often it may still ring.
        rang: It has.
    """

    def __init__(self, random: Random) -> None:
        self._random = random
        self.left = 0
        self.rang = False
        signal.signal(signal.SIGALRM, self._ring)

    def wind_up(self) -> None:
        """Let it ring from now on."""
        self.rang = False
        self.left = self._random.randint(1, _MAX_RINGS)
        interval = self._random.uniform(_SHORTEST, _LONGEST)
        signal.setitimer(signal.ITIMER_REAL, self._random.uniform(_SHORTEST, _LONGEST), interval)

    def _ring(self, _number: int, _frame: Any) -> None:
        if self.left:
            self.left -= 1
            self.rang = True
            raise Alarm


def ring(seconds: float, seed: int, folder: Path) -> tuple[int, int]:
    """Makes calls for so long; returns how many, and how many were broken off."""
    random = Random(seed)
    bell = Bell(random)
    names = [name for name in CALLS if name != "resetSimulation"]
    scene, calls, broken_off = build(folder), 0, 0
    until = monotonic() + seconds
    while monotonic() < until:
        calls += 1
        if calls % _SCENE_LASTS == 0 or p.getNumBodies() > _MAX_BODIES:
            scene = build(folder)
        name = random.choice(names)
        try:
            broken_off += _is_broken_off(bell, name, scene)
        except Alarm:
            broken_off += 1
        assert not bell.left
        check_order()
        p.stepSimulation()
    build(folder)
    follows = follow()
    build(folder)
    assert follow() == follows, "what comes of the same scene is not the same"
    return calls, broken_off


def _is_broken_off(bell: Bell, name: str, scene: Scene) -> bool:
    try:
        bell.wind_up()
        CALLS[name](scene)
        p.stepSimulation()
    except Exception as problem:
        # NumPy's comparisons, for one, make another exception of whatever is raised within them.
        if not bell.rang and not isinstance(problem, p.error):
            raise
        return bell.rang
    finally:
        # It may ring at any of these instructions.
        while bell.left:
            try:
                bell.left = 0
            except Alarm:
                continue
    return False


def check_order() -> None:
    """See that bodies, rows and constraints of the world belong together."""
    world = clients[0].world
    bodies = sorted(world.bodies.values(), key=lambda body: body.rows.tree)
    first = dict.fromkeys(world.arrays.used, 0)
    for place, body in enumerate(bodies):
        assert body.rows.tree == place
        assert body.rows.first == {axis: first[axis] for axis in body.rows.first}
        assert body.first_link == first["link"]
        first |= {axis: start + body.rows.count[axis] for axis, start in body.rows.first.items()}
    for axis, count in first.items():
        assert axis in ("constraint", "row") or world.arrays.used[axis] == count
    ids = set(world.bodies.keys())
    assert ids.isdisjoint(world.free_ids)
    assert ids | set(world.free_ids) == set(range(world.next_id))
    assert {it.body.id for it in world.joint_constraints.all} <= ids
    assert {body for body, _ in world.joint_constraints.tags.links} == ids
    assert {it.user.id for it in world.joint_constraints.all if it.user} == set(world.user_constraints.rows)


def main() -> None:
    """Does what the command line says."""
    parser = argparse.ArgumentParser(description="Breaks calls off by timers.")
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    faulthandler.enable()
    logging.getLogger("pybullet").disabled = True
    # Exceptions in the callbacks of weak references go nowhere but to this hook.
    sys.unraisablehook = lambda _unraisable: None
    p.connect(p.DIRECT)
    with TemporaryDirectory() as folder:
        os.chdir(folder)
        try:
            calls, broken_off = ring(asked.seconds, asked.seed, Path(folder))
        finally:
            # What still rings when Python's handler is gone ends the process.
            signal.setitimer(signal.ITIMER_REAL, 0)
            os.chdir("/")
    print(f"{calls} calls, {broken_off} broken off")
    assert broken_off > calls // 20


if __name__ == "__main__":
    main()
