"""Random calls from several threads, with signals, garbage and tracers among them.

`python -m tests.interrupts.storm --seconds 60 --seed 7 --threads 3` ends well, or says what went wrong. Calls
may raise `pybullet.error`, because another thread may have removed its body; nothing else, no crash, no hang.
What a thread is told of its own body has to fit: it alone changes that.
"""

from __future__ import annotations

import argparse
import contextlib
import faulthandler
import gc
import signal
import sys
import threading
from collections.abc import Callable
from random import Random
from time import monotonic
from typing import Any

import pybullet as p
import pybullet_data

# Scenes are small, so that a step is short and calls meet often.
MAX_BODIES = 12
_HANG = 60.0
# A restored state takes the bodies of all threads back to where they were: not while one looks at its own.
_WHERE_BODIES_ARE = threading.RLock()


class Own:
    """A body of one thread, which knows what it told of it."""

    def __init__(self, random: Random) -> None:
        self._random = random
        self.body = p.loadURDF("r2d2.urdf", self._place(), useFixedBase=True)

    def _place(self) -> list[float]:
        return [self._random.uniform(-9.0, 9.0), self._random.uniform(-9.0, 9.0), 2.0]

    def renew(self) -> None:
        """Removes it and loads another."""
        p.removeBody(self.body)
        self.body = p.loadURDF("r2d2.urdf", self._place(), useFixedBase=True)

    def check(self) -> None:
        """Sets a joint and a place, and reads them back."""
        angle, joint = self._random.uniform(-1.0, 1.0), 13
        place = self._place()
        with _WHERE_BODIES_ARE:
            p.resetBasePositionAndOrientation(self.body, place, [0, 0, 0, 1])
            found, _ = p.getBasePositionAndOrientation(self.body)
        assert found == tuple(place), (found, place)
        p.changeDynamics(self.body, joint, lateralFriction=abs(angle))
        assert p.getDynamicsInfo(self.body, joint)[1] == abs(angle)
        info = p.getJointInfo(self.body, joint)
        assert (info[0], info[1]) == (joint, b"head_swivel"), info
        p.setJointMotorControl2(self.body, joint, p.POSITION_CONTROL, targetPosition=angle)
        states = p.getJointStates(self.body, range(p.getNumJoints(self.body)))
        assert states is not None
        assert len(states) == 15


def _calls(random: Random) -> dict[str, Callable[[], object]]:
    """Calls about anything that is there."""

    def some() -> int:
        return p.getBodyUniqueId(random.randrange(p.getNumBodies()))

    def tied() -> None:
        tie = p.createConstraint(some(), -1, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0, 0, 0], [0, 0, 1])
        p.changeConstraint(tie, maxForce=3.0)
        p.removeConstraint(tie)

    def shaped() -> None:
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
        p.removeBody(p.createMultiBody(1.0, shape, basePosition=[0, 0, random.uniform(1.0, 5.0)]))

    def saved() -> None:
        # A signal handler must not wait: another thread may wait for the call that it interrupts.
        if not _WHERE_BODIES_ARE.acquire(blocking=False):
            return
        try:
            state = p.saveState()
            p.stepSimulation()
            with contextlib.suppress(p.error):
                p.restoreState(state)
            p.removeState(state)
        finally:
            _WHERE_BODIES_ARE.release()

    return {
        "step": p.stepSimulation,
        "detect": p.performCollisionDetection,
        "contacts": p.getContactPoints,
        "links": lambda: p.getLinkStates(some(), [0, 1, 2], 1, 1),
        "closest": lambda: p.getClosestPoints(some(), some(), 1.0),
        "box": lambda: p.getAABB(some()),
        "visuals": lambda: p.getVisualShapeData(some()),
        "ray": lambda: p.rayTestBatch([[0, 0, 5]] * 4, [[x, 0, -1] for x in range(4)]),
        "image": lambda: p.getCameraImage(8, 8),
        "dynamics": lambda: p.calculateMassMatrix(some(), [0.1] * 14),
        "kinematics": lambda: p.calculateInverseKinematics(some(), 5, [0.1, 0.2, 0.3]),
        "tied": tied,
        "shaped": shaped,
        "saved": saved,
        "gravity": lambda: p.setGravity(0, 0, random.uniform(-10.0, 0.0)),
        "garbage": gc.collect,
    }


class Storm:
    """Threads and signals that call for so long.

    Attributes:
        count: Calls that were made.
        failures: What went wrong.
    """

    def __init__(self, seconds: float) -> None:
        self._until = monotonic() + seconds
        self.count = 0
        self.failures: list[BaseException] = []
        self._rings = False

    def blow(self, seed: int) -> None:
        """Calls at random."""
        random = Random(seed)
        calls = _calls(random)
        try:
            own = Own(random)
            while monotonic() < self._until and not self.failures:
                self.count += 1
                if p.getNumBodies() < MAX_BODIES and random.random() < 0.1:
                    own.renew()
                elif random.random() < 0.3:
                    own.check()
                else:
                    with contextlib.suppress(p.error):
                        calls[random.choice(list(calls))]()
            p.removeBody(own.body)
        except BaseException as problem:
            self.failures.append(problem)

    def ring(self, seed: int) -> None:
        """Calls at random from signal handlers, too."""
        random = Random(seed)
        calls = _calls(random)

        def handle(_number: int, _frame: object) -> None:
            if self._rings:
                return
            self._rings = True
            try:
                with contextlib.suppress(p.error):
                    calls[random.choice(list(calls))]()
            except BaseException as problem:
                self.failures.append(problem)
            self._rings = False
            signal.setitimer(signal.ITIMER_REAL, random.uniform(5e-5, 5e-3))

        signal.signal(signal.SIGALRM, handle)
        signal.setitimer(signal.ITIMER_REAL, 1e-3)

    def stop(self) -> None:
        """Lets no signal come any more."""
        self._rings = True
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def _beat(end: threading.Event) -> None:
    """Ask for Python's lock all the time, as a script with more threads does.

    Python 3.11 needs it: if a signal has come for the main thread while that waits, a thread that is traced
    tries to handle it at every function that it enters, for ever, until another thread asks for the lock.
    """
    while not end.wait(0.01):
        pass


def _slow_tracer(frame: Any, event: str, argument: object) -> Any:
    return _slow_tracer


def main() -> None:
    """Does what the command line says."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--threads", type=int, default=3)
    asked = parser.parse_args()
    faulthandler.enable()
    faulthandler.dump_traceback_later(asked.seconds + _HANG, exit=True)
    p.connect(p.DIRECT)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.loadURDF("plane.urdf")
    storm = Storm(asked.seconds)
    end = threading.Event()
    threading.Thread(target=_beat, args=(end,), daemon=True).start()
    if asked.seed % 3 == 0:
        threading.settrace(_slow_tracer)
    if hasattr(signal, "setitimer"):
        storm.ring(1000 * asked.seed)
    threads = [
        threading.Thread(target=storm.blow, args=(1000 * asked.seed + number,))
        for number in range(1, asked.threads)
    ]
    for thread in threads:
        thread.start()
    storm.blow(1000 * asked.seed + 999)
    for thread in threads:
        thread.join()
    end.set()
    storm.stop()
    if storm.failures:
        raise storm.failures[0]
    assert p.getNumBodies() == 1
    print(f"{storm.count} calls by {asked.threads} threads with seed {asked.seed}: well")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
