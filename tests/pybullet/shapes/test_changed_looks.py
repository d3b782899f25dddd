"""Looks of one of several shapes of a link are changed, and read back."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import pybullet as p

RED, BLUE, GREEN = (1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0), (0.0, 1.0, 0.0, 1.0)


@pytest.fixture
def body() -> Iterator[int]:
    p.connect(p.DIRECT)
    look = p.createVisualShapeArray(
        shapeTypes=[p.GEOM_BOX, p.GEOM_SPHERE], halfExtents=[[0.1, 0.1, 0.1], [0, 0, 0]], radii=[0, 0.1]
    )
    yield p.createMultiBody(0, -1, look)
    p.disconnect()


def colours(body: int) -> list[tuple[float, ...]]:
    return [look[7] for look in p.getVisualShapeData(body)]


def test_one_shape_or_all_of_a_link_change(body: int) -> None:
    p.changeVisualShape(body, -1, rgbaColor=RED)
    assert colours(body) == [RED, RED]
    p.changeVisualShape(body, -1, 1, rgbaColor=BLUE)
    assert colours(body) == [RED, BLUE]
    p.changeVisualShape(body, -1, 0, rgbaColor=GREEN)
    assert colours(body) == [GREEN, BLUE]


def test_textures_are_told_only_if_asked_for(body: int) -> None:
    assert [len(look) for look in p.getVisualShapeData(body)] == [8, 8]
    flag = p.VISUAL_SHAPE_DATA_TEXTURE_UNIQUE_IDS
    assert [look[8] for look in p.getVisualShapeData(body, flag)] == [-1, -1]
