"""What an index shows of Carom, and what of others a wheel says that it contains."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from email.message import Message
from email.parser import Parser
from importlib import metadata, util
from pathlib import Path

import pytest
from tools.packaging.long_description import long_description
from tools.packaging.sbom import bill_of_materials

from carom.version import __version__

ROOT = Path(__file__).parents[2]
ASK = "import backend, sys; print(backend.prepare_metadata_for_build_wheel(sys.argv[1]))"

pytest.importorskip("hatchling", reason="it builds the wheels")
needs_compilers = pytest.mark.skipif(
    not all(map(util.find_spec, ("warp", "ziglang"))), reason="what compiles the library is not installed"
)


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> Message:
    """The metadata, asked for as pip asks: it must be there without a wheel."""
    folder = tmp_path_factory.mktemp("metadata")
    environment = {
        **os.environ,
        "PIP_BUILD_TRACKER": str(folder),
        "PYTHONPATH": str(ROOT / "tools" / "packaging"),
        # With no such platform nothing could be built.
        "CAROM_BUILD_TARGET": "no-such-platform",
    }
    command = [sys.executable, "-c", ASK, str(folder)]
    made = subprocess.run(command, cwd=ROOT, env=environment, check=True, capture_output=True, text=True)
    return Parser().parsestr((folder / made.stdout.strip() / "METADATA").read_text("utf-8"))


def test_metadata_have_one_version_and_the_readme_without_what_is_not_there(shown: Message):
    assert shown["Version"] == __version__
    assert shown.get_payload() == long_description((ROOT / "README.md").read_text("utf-8"))


def test_classifiers_are_known_and_name_the_systems_that_there_are_wheels_for(shown: Message):
    known = pytest.importorskip("trove_classifiers").classifiers
    named = shown.get_all("Classifier", [])
    assert set(named) <= known
    systems = [one.rpartition(" :: ")[2] for one in named if one.startswith("Operating System")]
    assert systems == ["MacOS", "Windows", "Linux"]


def test_licences_are_files_of_the_repository(shown: Message):
    named = shown.get_all("License-File", [])
    assert set(named) >= {"LICENSE", "licenses/musl.txt", "licenses/warp.txt", "licenses/zig.txt"}
    assert all((ROOT / name).is_file() for name in named)


@needs_compilers
@pytest.mark.parametrize(
    ("ours", "distribution", "theirs"),
    [
        ("musl.txt", "ziglang", "ziglang/lib/libc/musl/COPYRIGHT"),
        ("zig.txt", "ziglang", "ziglang/LICENSE"),
        ("warp.txt", "warp-lang", "licenses/LICENSE.md"),
    ],
)
def test_licences_are_those_of_what_is_compiled_in(ours: str, distribution: str, theirs: str):
    files = [file for file in metadata.files(distribution) or () if str(file).endswith(theirs)]
    assert (ROOT / "licenses" / ours).read_text("utf-8") in [file.read_text("utf-8") for file in files]


@needs_compilers
def test_the_bill_of_materials_names_the_versions_that_are_compiled_in():
    bill = json.loads(bill_of_materials("1.2.3"))
    assert (bill["bomFormat"], bill["metadata"]["component"]["version"]) == ("CycloneDX", "1.2.3")
    versions = {part["name"]: part["purl"].rpartition("@")[2] for part in bill["components"]}
    zig = metadata.version("ziglang")
    assert versions == {"warp": metadata.version("warp-lang"), "zig-compiler-rt": zig, "musl": zig}
