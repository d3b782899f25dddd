"""Programs in which something runs in the middle of calls: `python -m tests.interrupts.programs NAME`.

On PyBullet, whose calls are atomic, all of them end well. Each is a process of its own, because it guards
against crashes and deadlocks.
"""

from __future__ import annotations

import contextlib
import ctypes
import faulthandler
import gc
import os
import signal
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import carom
import pybullet as p
import pybullet_data

SECONDS = 1.0
ENOUGH = 10
PROGRAMS: dict[str, Callable[[], None]] = {}


def program(function: Callable[[], None]) -> Callable[[], None]:
    """One of the programs."""
    PROGRAMS[function.__name__] = function
    return function


def arm(place: float = 0.0) -> int:
    return p.loadURDF("r2d2.urdf", [place, 0.0, 1.0])


def read_all() -> None:
    """Reads in every way, of the bodies that are there at the beginning."""
    for body in [p.getBodyUniqueId(place) for place in range(p.getNumBodies())]:
        with contextlib.suppress(p.error):
            p.getBasePositionAndOrientation(body)
            joints = range(p.getNumJoints(body))
            for joint in joints:
                name = p.getJointInfo(body, joint)[12]
                assert name, (body, joint)
                p.getDynamicsInfo(body, joint)
            if joints:
                assert len(p.getLinkStates(body, list(joints), 1, 1)) == len(joints)
                p.getJointStates(body, joints)
            p.getAABB(body)
            p.getVisualShapeData(body)
            p.getContactPoints(body)
            p.getClosestPoints(body, 0, 0.1)
            p.rayTest([0, 0, 3], [0, 0, -1])


def change_all() -> None:
    """Adds a body, changes it and what is about it, and removes it."""
    body = arm(2.0)
    p.changeDynamics(body, 3, mass=2.0)
    p.setJointMotorControl2(body, 2, p.POSITION_CONTROL, targetPosition=0.3, force=10.0)
    tie = p.createConstraint(body, -1, -1, -1, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [2, 0, 1])
    p.resetBasePositionAndOrientation(body, [2.0, 1.0, 1.0], [0, 0, 0, 1])
    p.stepSimulation()
    p.removeConstraint(tie)
    p.removeBody(body)


def answers() -> list[Any]:
    """What comes of the first two bodies in a world whose first body is the plane."""
    found: list[Any] = []
    for _ in range(20):
        p.stepSimulation()
        found.append(p.getBasePositionAndOrientation(1))
        found.append(p.getJointStates(1, range(p.getNumJoints(1))))
    return found


@contextlib.contextmanager
def ringing(handler: Callable[[], object], every: float = 3e-4) -> Iterator[list[int]]:
    """Calls a handler from signals, again and again; gives the number of times."""
    rings, within = [0], [False]

    def ring(_number: int, _frame: object) -> None:
        # The next signal may come before the handler has returned.
        if within[0]:
            return
        within[0] = True
        rings[0] += 1
        try:
            handler()
        finally:
            within[0] = False

    signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, every, every)
    try:
        yield rings
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)


def busy(work: Callable[[], object], seconds: float = SECONDS, rings: Sequence[int] = (ENOUGH,)) -> None:
    """Works for so long, and until it was interrupted often enough."""
    until = time.monotonic() + seconds
    while time.monotonic() < until or rings[0] < ENOUGH:
        work()


@program
def handlers_read() -> None:
    with ringing(read_all, 2e-3) as rings:
        busy(change_all, rings=rings)


@program
def handlers_change() -> None:
    with ringing(change_all, 2e-3) as rings:
        busy(change_all, rings=rings)
        busy(read_all)
    assert p.getNumBodies() == 2


@program
def handlers_step() -> None:
    with ringing(p.stepSimulation) as rings:
        busy(change_all, rings=rings)
        busy(read_all)


@program
def handlers_save_and_restore() -> None:
    def handle() -> None:
        state = p.saveState()
        p.stepSimulation()
        p.restoreState(state)
        p.removeState(state)

    def work() -> None:
        for _ in range(5):
            p.stepSimulation()
        for joint in range(p.getNumJoints(1)):
            p.resetJointState(1, joint, 0.1)

    with ringing(handle, 1e-3) as rings:
        busy(work, rings=rings)


@program
def handlers_raise() -> None:
    class Alarm(Exception):
        pass

    armed = [False]

    def handle() -> None:
        if armed[0]:
            armed[0] = False
            raise Alarm

    def tidy() -> None:
        for body in [p.getBodyUniqueId(place) for place in range(2, p.getNumBodies())]:
            p.removeBody(body)

    with ringing(handle, 1e-3) as rings:
        while rings[0] < 200:
            with contextlib.suppress(Alarm):
                armed[0] = True
                tidy()
                change_all()
                read_all()
                armed[0] = False
    tidy()
    p.stepSimulation()
    read_all()


@program
def threads_read_while_one_changes() -> None:
    _all_at_once([change_all, read_all, read_all, p.stepSimulation])


@program
def threads_change() -> None:
    _all_at_once([change_all, change_all, change_all, read_all])
    assert p.getNumBodies() == 2


@program
def threads_get_the_answers_of_one() -> None:
    state = p.saveState()
    want = answers()
    for count in (1, 3):
        p.restoreState(state)
        watched = [True]
        threads = [threading.Thread(target=_watch, args=(watched,)) for _ in range(count)]
        for thread in threads:
            thread.start()
        got = answers()
        watched[0] = False
        for thread in threads:
            thread.join()
        assert got == want


def _watch(watched: list[bool]) -> None:
    while watched[0]:
        p.getLinkStates(1, list(range(p.getNumJoints(1))), 1, 1)
        p.getContactPoints(1)
        p.getDynamicsInfo(1, 3)
        p.calculateMassMatrix(1, [0.1] * 14)
        p.getClosestPoints(1, 0, 0.2)


@program
def threads_command_robots_of_their_own() -> None:
    robots = [arm(place) for place in range(3, 7)]
    missed: list[Any] = []

    def command(robot: int, torque: float) -> Callable[[], None]:
        targets = [torque] * p.getNumJoints(robot)

        def work() -> None:
            p.setJointMotorControlArray(robot, range(len(targets)), p.POSITION_CONTROL, targets)
            matrix = p.calculateMassMatrix(robot, [0.0] * 14)
            if matrix != want[robot]:
                missed.append(robot)

        return work

    want = {robot: p.calculateMassMatrix(robot, [0.0] * 14) for robot in robots}
    _all_at_once([command(robot, 0.1 * robot) for robot in robots])
    assert not missed


def _all_at_once(works: list[Callable[[], object]]) -> None:
    failed: list[BaseException] = []

    def run(work: Callable[[], object]) -> None:
        try:
            busy(work)
        except BaseException as problem:
            failed.append(problem)

    threads = [threading.Thread(target=run, args=(work,)) for work in works]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if failed:
        raise failed[0]


@program
def a_tracer_reads_and_changes() -> None:
    events = [0]

    def trace(frame: Any, event: str, argument: object) -> Any:
        events[0] += 1
        if events[0] % 500 == 0:
            # Python calls no trace function while one runs.
            p.getLinkStates(1, [1, 2, 3], 1, 1)
            body = arm(5.0)
            p.stepSimulation()
            p.removeBody(body)
        return trace

    sys.settrace(trace)
    try:
        busy(change_all)
        busy(read_all)
    finally:
        sys.settrace(None)
    assert events[0] > 100


@program
def finalizers_change() -> None:
    class Owner:
        def __init__(self) -> None:
            self.body = arm(6.0)
            self.me = self

        def __del__(self) -> None:
            p.removeBody(self.body)
            p.stepSimulation()

    gc.set_threshold(50, 2, 2)

    def work() -> None:
        Owner()
        change_all()
        read_all()

    busy(work)
    gc.collect()
    assert p.getNumBodies() == 2


@program
def a_thread_is_killed() -> None:
    for _ in range(20):
        thread = threading.Thread(target=lambda: busy(change_all, 60.0), daemon=True)
        thread.excepthook = None  # type: ignore[attr-defined]
        thread.start()
        time.sleep(0.02)
        for _ in range(1000):
            ctypes.pythonapi.PyThreadState_SetAsyncExc(
                ctypes.c_ulong(thread.ident or 0), ctypes.py_object(SystemExit)
            )
            thread.join(0.01)
            if not thread.is_alive():
                break
        assert not thread.is_alive()
        p.stepSimulation()
        read_all()


@program
def forks_while_another_thread_loads() -> None:
    going = [True]

    def load() -> None:
        while going[0]:
            change_all()

    thread = threading.Thread(target=load)
    thread.start()
    try:
        for _ in range(12):
            child = os.fork()
            if not child:
                signal.alarm(20)
                change_all()
                p.stepSimulation()
                other = p.connect(p.DIRECT)
                p.loadURDF("plane.urdf", physicsClientId=other)
                os._exit(0 if p.getNumBodies(physicsClientId=other) == 1 else 1)
            assert os.waitpid(child, 0)[1] == 0
    finally:
        going[0] = False
        thread.join()


@program
def forks_while_another_thread_steps_worlds() -> None:
    world = carom.World()
    world.load_urdf("r2d2.urdf", (0.0, 0.0, 1.0), as_pybullet=True)
    worlds, going = carom.Worlds(world, 64, threads=2), [True]
    worlds.step()

    def step() -> None:
        while going[0]:
            worlds.step()

    thread = threading.Thread(target=step, daemon=True)
    thread.start()
    for _ in range(3):
        time.sleep(0.02)
        child = os.fork()
        if not child:
            signal.alarm(20)
            times = worlds.time.copy()
            worlds.step(2)
            os._exit(not (worlds.time > times).all())
        assert os.waitpid(child, 0)[1] == 0
    going[0] = False
    thread.join()


@program
def threads_connect_at_once() -> None:
    for _ in range(50):
        numbers: list[int] = []
        start = threading.Barrier(8)
        threads = [threading.Thread(target=_connect, args=(start, numbers)) for _ in range(8)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert len(set(numbers)) == 8
        for number in numbers:
            p.disconnect(number)


def _connect(start: threading.Barrier, numbers: list[int]) -> None:
    start.wait()
    numbers.append(p.connect(p.DIRECT))


def main() -> None:
    """Runs the program that the command line names."""
    faulthandler.enable()
    faulthandler.dump_traceback_later(40.0, exit=True)
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        p.connect(p.DIRECT)
        p.setAdditionalSearchPath(pybullet_data.getDataPath())
        p.setGravity(0, 0, -9.8)
        p.loadURDF("plane.urdf")
        arm()
        p.stepSimulation()
        PROGRAMS[sys.argv[1]]()
        os.chdir(Path(folder).parent)
    print("well")


if __name__ == "__main__":
    main()
