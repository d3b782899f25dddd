"""A question that is asked within another one, as by a signal handler, which runs between two lines of it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

import pybullet as p
from pybullet._clients.clients import clients


@pytest.fixture
def client() -> Iterator[int]:
    connection = p.connect(p.DIRECT)
    yield connection
    p.disconnect(connection)


def test_nearest_points_are_those_of_the_bodies_that_were_asked_for(
    client: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.5, physicsClientId=client)
    balls = [
        p.createMultiBody(1, shape, basePosition=[0, y, 0], physicsClientId=client) for y in (0, 2, -5, 9, 11)
    ]
    expected = [p.getClosestPoints(a, b, 9, physicsClientId=client) for a, b in (balls[:2], balls[3:])]
    bodies = clients[client].world.bodies
    ours = [range(bodies[ball].first_link, bodies[ball].first_link + 1) for ball in balls[:2]]
    queries = clients[client].world.queries()
    search = queries._search
    question: Any = search._search
    within = []

    class Interrupted:
        room = question.room

        def __call__(self, count: int, reach: float) -> None:
            within.append(p.getClosestPoints(balls[3], balls[4], 9, physicsClientId=client))
            question(count, reach)

    monkeypatch.setattr(search, "_search", Interrupted())
    ((*_, on_a, on_b, normal, gap),) = queries.nearest(ours[0], ours[1], 9.0)
    assert within == expected[1:]
    assert (on_a, on_b, normal, gap) == expected[0][0][5:9]
