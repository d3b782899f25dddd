"""Sharing out tasks to threads."""

import multiprocessing
import os
import threading

import pytest
from drawing import add_shape, draw

from carom.description import Box
from carom.render import parallel
from carom.world import World


@pytest.mark.parametrize("workers", [1, 2, 5])
def test_every_task_runs_once(monkeypatch, workers):
    monkeypatch.setattr(parallel, "worker_count", lambda: workers)
    lock, done = threading.Lock(), []

    def task(number):
        def run():
            with lock:
                done.append(number)

        return run

    parallel.run_all([task(number) for number in range(100)])
    assert sorted(done) == list(range(100))
    parallel.run_all([])


@pytest.mark.parametrize("workers", [1, 3])
def test_an_error_of_a_task_arrives(monkeypatch, workers):
    monkeypatch.setattr(parallel, "worker_count", lambda: workers)

    def fail():
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        parallel.run_all([fail] * 4)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there are no forks on this system")
def test_a_fork_draws_as_well(monkeypatch):
    monkeypatch.setattr(parallel, "worker_count", lambda: 2)
    world = World()
    add_shape(world, Box((1.0, 1.0, 1.0)))
    expected = int((draw(world).label == 0).sum())
    context = multiprocessing.get_context("fork")
    answers = context.SimpleQueue()
    process = context.Process(target=lambda: answers.put(int((draw(world).label == 0).sum())))
    process.start()
    process.join(timeout=60)
    alive = process.is_alive()
    if alive:
        process.kill()
    assert not alive
    assert answers.get() == expected
