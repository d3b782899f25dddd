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


def test_links_are_made_of_the_address_of_the_repository_once_there_is_one(shown: Message):
    from tools.packaging import addresses

    linked = dict(link.split(", ", 1) for link in shown.get_all("Project-URL", []))
    assert linked == addresses.project_urls()
    assert addresses.project_urls("", "") == {}
    made = addresses.project_urls("https://host.example/us/carom")
    assert set(made) == {"Homepage", "Source", "Issues", "Documentation", "Changelog"}
    assert made["Issues"] == "https://host.example/us/carom/issues"
    with_site = addresses.project_urls("https://host.example/us/carom", "https://carom.example")
    assert with_site["Homepage"] == with_site["Documentation"] == "https://carom.example"
    for wrong in ("http://host.example/carom", "https://host.example/carom/"):
        with pytest.raises(ValueError, match=r"addresses\.py has to begin with https://"):
            addresses.project_urls(wrong)


def test_links_that_are_filled_in_are_in_the_metadata(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.syspath_prepend(str(ROOT / "tools" / "packaging"))
    monkeypatch.syspath_prepend(str(ROOT))
    hook = __import__("hatch_build").DescriptionHook(str(ROOT), {})
    monkeypatch.setattr("addresses.project_urls", lambda: {"Source": "https://host.example/us/carom"})
    told: dict[str, object] = {}
    hook.update(told)
    assert told["urls"] == {"Source": "https://host.example/us/carom"}


def test_pages_name_the_versions_of_python_that_the_classifiers_name(shown: Message):
    named = [one.rpartition(" :: ")[2] for one in shown.get_all("Classifier", [])]
    versions = [one for one in named if one.startswith("3.")]
    said = f"{versions[0]} to {versions[-1]}"
    pages = ["README.md", "docs/index.md", "docs/install.md", "docs/releasing.md"]
    assert [page for page in pages if said not in (ROOT / page).read_text("utf-8")] == []
    assert shown["Requires-Python"] == f">={versions[0]}"


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
