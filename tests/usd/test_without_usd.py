"""Without usd-core, errors say how to install it."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest

from carom import World
from carom.cli.convert import convert
from carom.errors import DescriptionError


@pytest.fixture
def without(monkeypatch: pytest.MonkeyPatch):
    for name in ("pxr", "pxr.Usd"):
        monkeypatch.setitem(sys.modules, name, None)


@pytest.mark.usefixtures("without")
def test_a_stage_says_what_to_install(tmp_path: Path):
    file = tmp_path / "stage.usda"
    file.write_text("#usda 1.0")
    with pytest.raises(DescriptionError, match=r"stage\.usda: .*pip install 'carom\[usd\]'"):
        World().load(file)
    with pytest.raises(DescriptionError, match=r"pip install 'carom\[usd\]'"):
        convert(Path("r2d2.urdf"), tmp_path / "r2d2.usd")


@pytest.mark.parametrize("choice", [{"fixed_base": True}, {"scale": 2.0}, {"xacro_args": {"a": 1}}])
def test_choices_for_other_formats_are_refused(tmp_path: Path, choice):
    file = tmp_path / "stage.usda"
    file.write_text("#usda 1.0")
    with pytest.raises(ValueError, match="for URDF"):
        World().load(file, **choice)
