"""Damaged scene files: each either loads, with finite numbers, or is refused by name."""

from __future__ import annotations

import math
import shutil
from pathlib import Path

import pytest
from hypothesis import given, settings
from scene_cases import DATA
from test_urdf_fuzz import MUTATIONS, PATIENT, mutated, numbers
from tests.thorough.profiles import cases

from carom.errors import DescriptionError
from carom.formats.mjcf import read_mjcf
from carom.formats.sdf import read_sdf
from carom.model.assemble import assemble
from carom.model.mjcf_inertia import set_mjcf_inertias

FILES = sorted([*(DATA / "sdf").glob("*.sdf"), *(DATA / "mjcf").glob("*.xml")])
READERS = {".sdf": read_sdf, ".xml": read_mjcf}


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the test data, for the damaged files to find what they refer to."""
    return Path(shutil.copytree(DATA, tmp_path_factory.mktemp("scenes") / "data"))


@pytest.mark.parametrize("file", FILES, ids=lambda file: file.name)
@settings(max_examples=cases(60), **PATIENT)
@given(MUTATIONS)
def test_damaged_scenes_load_or_are_refused(
    folder: Path, file: Path, mutations: list[tuple[str, float, float, bytes]]
) -> None:
    damaged = folder / file.parent.name / f"damaged{file.suffix}"
    damaged.write_bytes(mutated(file.read_bytes(), mutations))
    try:
        placed = READERS[file.suffix](damaged)
        bodies = [assemble(it.robot, fixed_base=it.fixed_base) for it in placed]
        if file.suffix == ".xml":
            for body in bodies:
                set_mjcf_inertias(body)
    except DescriptionError as error:
        assert error.file is not None
        assert error.reason
        return
    for body, it in zip(bodies, placed, strict=True):
        assert all(map(math.isfinite, numbers(body)))
        assert all(map(math.isfinite, (*it.pose.position, *it.pose.orientation)))
