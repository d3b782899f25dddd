"""Questions that a trace function asks in the middle of others: all have the answers they have alone."""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import Any

import pytest
from tests.rings import few

import pybullet as p

RAYS = [[0.02 * i - 1.0, 0.1, 3.0] for i in range(100)]
ENDS = [[0.02 * i - 1.0, 0.1, -1.0] for i in range(100)]
QUESTIONS: dict[str, Callable[[], Any]] = {
    "two robots": lambda: p.getClosestPoints(1, 2, 5.0),
    "robot and plane": lambda: p.getClosestPoints(1, 0, 5.0),
    "many rays": lambda: p.rayTestBatch(RAYS, ENDS),
    "a ray": lambda: p.rayTest(RAYS[50], ENDS[50]),
    "contacts": p.getContactPoints,
    "contacts of one": lambda: p.getContactPoints(2),
}


def begin() -> None:
    """A scene whose queries have no memory yet."""
    p.resetSimulation()
    p.setGravity(0, 0, -9.81)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    for place in range(2):
        links = range(9)
        p.createMultiBody(
            1.0,
            ball,
            -1,
            [0.4 * place, 0.0, 0.099],
            linkMasses=[1.0 for _ in links],
            linkCollisionShapeIndices=[ball for _ in links],
            linkVisualShapeIndices=[-1 for _ in links],
            linkPositions=[[0.0, 0.3, 0.0] for _ in links],
            linkOrientations=[[0.0, 0.0, 0.0, 1.0] for _ in links],
            linkInertialFramePositions=[[0.0, 0.0, 0.0] for _ in links],
            linkInertialFrameOrientations=[[0.0, 0.0, 0.0, 1.0] for _ in links],
            linkParentIndices=list(links),
            linkJointTypes=[p.JOINT_FIXED for _ in links],
            linkJointAxis=[[0.0, 0.0, 1.0] for _ in links],
        )
    p.stepSimulation()


class Asker:
    """Asks when a line of the code of queries is reached, and notes all of these lines."""

    def __init__(self, at: tuple[str, int] | None, question: Callable[[], Any]) -> None:
        self.at, self.question = at, question
        self.lines: dict[tuple[str, int], None] = {}
        self.answer: Any = self

    def __call__(self, frame: Any, event: str, _argument: object) -> Any:
        file = frame.f_code.co_filename.replace("\\", "/")
        if "/carom/engine/queries/" not in file:
            return None
        if event == "line":
            place = file, frame.f_lineno
            if place == self.at and place not in self.lines:
                self.answer = self.question()
            self.lines[place] = None
        return self


def asked(outer: str, asker: Asker) -> list[Any]:
    """Answers to a question in a world whose queries have no memory yet, with another one in the middle."""
    begin()
    sys.settrace(asker)
    try:
        return [QUESTIONS[outer]() for _ in range(2)]
    finally:
        sys.settrace(None)


@pytest.mark.parametrize("outer", few(QUESTIONS, 1))
def test_questions_within_questions(outer: str) -> None:
    p.connect(p.DIRECT)
    try:
        begin()
        expected = {name: question() for name, question in QUESTIONS.items()}
        watcher = Asker(None, QUESTIONS["a ray"])
        asked(outer, watcher)
        assert len(watcher.lines) > 10
        # Of the lines some, the same ones each time.
        for place in list(watcher.lines)[::3]:
            for inner in ("two robots", "contacts", "many rays"):
                asker = Asker(place, QUESTIONS[inner])
                assert asked(outer, asker) == [expected[outer]] * 2, (place, inner)
                assert asker.answer in (asker, expected[inner])
                assert QUESTIONS[outer]() == expected[outer]
                assert QUESTIONS[inner]() == expected[inner]
    finally:
        p.disconnect()
