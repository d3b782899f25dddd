"""SDF files have at most as many bodies as PyBullet has room for."""

from pathlib import Path

import pytest

import pybullet as p


@pytest.mark.parametrize(("count", "loaded"), [(512, True), (513, False)])
def test_the_capacity_is_512_bodies(count: int, loaded: bool, tmp_path: Path) -> None:
    models = "".join(f'<model name="m{number}"><link name="a"/></model>' for number in range(count))
    file = tmp_path / "many.sdf"
    file.write_text(f'<sdf version="1.6"><world name="w">{models}</world></sdf>')
    p.connect(p.DIRECT)
    try:
        if loaded:
            assert len(p.loadSDF(str(file))) == count
        else:
            with pytest.raises(p.error):
                p.loadSDF(str(file))
            assert p.getNumBodies() == 0
    finally:
        p.disconnect()
