"""Sharing out tasks to threads."""

import multiprocessing
import threading

import pytest
from drawing import add_shape, draw

from carom.description import Box
from carom.render import parallel
from carom.world.world import World


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


def visible_pixels():
    world = World()
    add_shape(world, Box((1.0, 1.0, 1.0)))
    return int((draw(world).label == 0).sum())


def put_visible_pixels(answers):
    answers.put(visible_pixels())


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
def test_another_process_draws_as_well(monkeypatch, method):
    # The threads of this process have drawn before the other one starts: a fork has to do without them.
    monkeypatch.setattr(parallel, "worker_count", lambda: 2)
    expected = visible_pixels()
    context = multiprocessing.get_context(method)
    answers = context.SimpleQueue()
    process = context.Process(target=put_visible_pixels, args=(answers,))
    process.start()
    process.join(timeout=60)
    alive = process.is_alive()
    if alive:
        process.kill()
    assert not alive
    assert answers.get() == expected
