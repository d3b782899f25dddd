"""Every function says what it does to a world, and the lock of a world is held meanwhile."""

from __future__ import annotations

import threading

import pytest

import pybullet as p
from pybullet._calls.builtin import exports
from pybullet._calls.conduct import FREE, client_place, reads
from pybullet._clients.clients import clients


def test_what_is_free_exists() -> None:
    assert set(exports) >= FREE


def test_what_needs_a_world_names_its_connection() -> None:
    for name, export in exports.items():
        code = export.code
        names = code.co_varnames[: code.co_argcount + code.co_kwonlyargcount]
        takes_any = bool(code.co_flags & 0x08)
        if name not in FREE:
            assert takes_any or "physicsClientId" in names, name
        if client_place(code) >= 0:
            assert names[client_place(code)] == "physicsClientId"


@pytest.mark.parametrize("name", ["loadURDF", "setGravity", "stepSimulation", "restoreState", "saveState"])
def test_changes_are_no_reading(name: str) -> None:
    assert name in FREE or not reads(name)


@pytest.fixture
def client() -> int:
    return p.connect(p.DIRECT)


def test_a_call_waits_for_the_lock_of_its_world_only(client: int) -> None:
    other = p.connect(p.DIRECT)
    lock = clients[client].lock
    done: list[int] = []

    def call() -> None:
        p.setGravity(0, 0, -1, physicsClientId=other)
        done.append(other)
        p.setGravity(0, 0, -1, physicsClientId=client)
        done.append(client)

    thread = threading.Thread(target=call)
    with lock:
        thread.start()
        thread.join(0.3)
        assert done == [other]
    thread.join()
    assert done == [other, client]
    p.disconnect(other)
    p.disconnect(client)


def test_the_lock_is_that_of_python(client: int) -> None:
    lock = clients[client].lock
    taken: list[bool] = []

    def take() -> None:
        taken.append(lock.acquire(blocking=False))
        taken.append(lock.acquire(timeout=0.01))
        taken.append(lock.acquire(True, 0.01))

    with lock:
        assert lock.acquire()
        lock.release()
        thread = threading.Thread(target=take)
        thread.start()
        thread.join()
    assert taken == [False, False, False]
    assert lock.acquire(timeout=1.0)
    lock.release()
    p.disconnect(client)


def test_many_threads_pass_one_after_the_other(client: int) -> None:
    lock = clients[client].lock
    inside, most = [0], [0]

    def enter() -> None:
        for _ in range(300):
            with lock:
                inside[0] += 1
                most[0] = max(most[0], inside[0])
                p.getNumBodies(physicsClientId=client)
                inside[0] -= 1

    threads = [threading.Thread(target=enter) for _ in range(6)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most == [1]
    p.disconnect(client)
