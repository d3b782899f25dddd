"""What is said of packages that PyBullet has overwritten or removed, without installing it."""

from __future__ import annotations

import pytest

from carom import conflicts


@pytest.mark.parametrize(
    ("states", "said"),
    [
        ({"pybullet_data": "missing"}, "files are missing in pybullet_data."),
        ({"pybullet_envs": "foreign"}, "PyBullet has overwritten pybullet_envs."),
        (
            {"pybullet_data": "missing", "pybullet_envs": "missing", "pybullet_utils": "foreign"},
            "files are missing in pybullet_data, pybullet_envs; PyBullet has overwritten pybullet_utils.",
        ),
    ],
)
def test_each_package_is_named(monkeypatch: pytest.MonkeyPatch, states: dict[str, str], said: str):
    monkeypatch.setattr(conflicts, "_state", lambda path: states.get(path.rpartition("/")[2], "ours"))
    with pytest.raises(ImportError) as problem:
        conflicts.check()
    before, _, after = str(problem.value).partition(": ")
    assert before.endswith("is not complete, because PyBullet has been installed or uninstalled there")
    assert after == f"{said}\n{conflicts.cure()}"


def test_nothing_is_said_where_all_is_well(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(conflicts, "_state", lambda path: "ours")
    conflicts.check()
