"""renderImage: which camera each list of arguments means was found out from PyBullet's images."""

from collections.abc import Iterator

import numpy as np
import pytest

import pybullet as p

WIDTH, HEIGHT = 40, 24
EYE, TARGET, UP = [2, 1, 1], [0, 0, 0], [0, 0, 1]


@pytest.fixture(autouse=True)
def scene() -> Iterator[None]:
    p.connect(p.DIRECT)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.5, 0.3, 0.2]))
    yield
    p.disconnect()


def same(image: tuple, view: list | tuple | None = None, projection: list | tuple | None = None) -> bool:
    expected = p.getCameraImage(WIDTH, HEIGHT, view, projection)
    return image[:2] == (WIDTH, HEIGHT) and all(
        np.array_equal(one, other) for one, other in zip(image[2:], expected[2:], strict=True)
    )


def test_the_five_lists_of_arguments() -> None:
    view = p.computeViewMatrix(EYE, TARGET, UP)
    wide, narrow = (p.computeProjectionMatrixFOV(angle, 1, 0.1, 10) for angle in (90, 50))
    turned = p.computeViewMatrixFromYawPitchRoll(TARGET, 2.5, 30, -20, 5, 2)
    assert same(p.renderImage(WIDTH, HEIGHT))
    assert same(p.renderImage(WIDTH, HEIGHT, view, narrow), view, narrow)
    assert same(p.renderImage(WIDTH, HEIGHT, EYE, TARGET, UP, 0.1, 10), view, wide)
    assert same(p.renderImage(WIDTH, HEIGHT, EYE, TARGET, UP, 0.1, 10, 50), view, narrow)
    assert same(p.renderImage(WIDTH, HEIGHT, TARGET, 2.5, 30, -20, 5, 2, 0.1, 10, 50), turned, narrow)


@pytest.mark.parametrize(
    ("arguments", "problem"),
    [
        ((), r"^Invalid number of args passed to renderImage\."),
        ((1, 2, 3), r"^Invalid number of args passed to renderImage\."),
        ((40, 24, "x", "y"), r"^Error parsing view or projection matrix\."),
        ((40, 24, [1], [2]), r"^Error parsing view or projection matrix\."),
        ((40, 24, [2, 1, 1], [0, 0], [0, 0, 1], 0.1, 10), r"^Error parsing camera position, target or up\."),
        ((40, 24, [0, 0], 2.5, 30, -20, 5, 2, 0.1, 10, 60), r"^Error parsing camera target pos"),
    ],
)
def test_refusals(arguments: tuple, problem: str) -> None:
    with pytest.raises(p.error, match=problem):
        p.renderImage(*arguments)
