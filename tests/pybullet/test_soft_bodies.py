"""Functions of soft bodies refuse rigid ones, in PyBullet's words."""

import pytest

import pybullet as p
import pybullet_data


@pytest.mark.parametrize("body", [0, 99])
@pytest.mark.parametrize(
    ("name", "arguments", "problem"),
    [
        ("resetMeshData", ([[0, 0, 0]],), r"^resetMeshData failed"),
        ("getTetraMeshData", (), r"^getTetraMeshData failed"),
        ("createSoftBodyAnchor", (0, -1, -1), r"^createSoftBodyAnchor failed\."),
    ],
)
def test_no_body_is_soft(name: str, arguments: tuple, problem: str, body: int) -> None:
    p.connect(p.DIRECT)
    try:
        p.setAdditionalSearchPath(pybullet_data.getDataPath())
        p.loadURDF("cube_small.urdf")
        with pytest.raises(p.error, match=problem):
            getattr(p, name)(body, *arguments)
    finally:
        p.disconnect()
