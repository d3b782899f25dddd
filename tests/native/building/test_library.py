import ctypes
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from tests.native.building.conftest import ROOT, SMALL_MODULE
from tools.wheels.faults import faults
from tools.wheels.structure import read_library

from carom.native.building.cache import MANIFEST
from carom.native.building.headers import HEADER
from carom.native.building.library import build
from carom.native.building.link import remove_time
from carom.native.digest import source_digest
from carom.native.targets import TARGETS, Target

pytest.importorskip("warp", reason="kernels are made C++ of by Warp")
pytest.importorskip("ziglang", reason="kernels are compiled by Zig")


def _generate(folder: Path, hash_seed: str) -> dict[str, bytes]:
    folder.mkdir()
    command = [sys.executable, "-m", "carom.native.building.codegen", "digest", str(folder), SMALL_MODULE]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONHASHSEED": hash_seed}
    subprocess.run(command, env=environment, check=True)
    return {path.name: path.read_bytes() for path in folder.iterdir()}


def test_generated_code_is_the_same_every_time_and_has_no_paths(tmp_path: Path):
    first = _generate(tmp_path / "first", "1")
    assert first == _generate(tmp_path / "second", "2")
    assert set(first) == {f"{SMALL_MODULE}.cpp", MANIFEST, HEADER}
    source = first[f"{SMALL_MODULE}.cpp"].decode()
    assert "CAROM_EXPORT void report_contacts_kernel_cpu_forward(" in source
    assert not any(word in source for word in ("<L ", "#line", str(ROOT), "adj_report_contacts"))
    # Elements of arrays are accessed by the functions of `arrays.h` alone, and loops are those of `loops.h`.
    assert "carom::address(" in source
    assert "carom::array_store(" in source
    assert "carom::iter_next(" in source
    assert not re.search(r"wp::(address|index|array_store|range|iter_next)\(", source)


@pytest.mark.thorough
def test_generated_code_does_not_depend_on_the_number_of_cores(tmp_path: Path):
    # Both have a function `add_contact`, which Warp tells apart by numbers.
    modules = ["carom.kernels.linearization.solution", SMALL_MODULE]
    found = []
    for cores in 1, 2:
        folder = tmp_path / str(cores)
        folder.mkdir()
        program = (
            "from pathlib import Path; from carom.native.building import codegen; "
            f"codegen.core_count = lambda: {cores}; "
            f"codegen.generate({modules}, 'digest', Path({str(folder)!r}))"
        )
        environment = {**os.environ, "PYTHONPATH": str(ROOT)}
        subprocess.run([sys.executable, "-c", program], env=environment, check=True)
        found.append({path.name: path.read_bytes() for path in folder.iterdir()})
    assert found[0] == found[1]


def test_the_library_exports_its_kernels_and_digest_and_needs_nothing(library: Path, target: Target):
    found = read_library(library)
    assert faults(found, target, next(iter(target.levels))) == []
    assert {"report_contacts_kernel_cpu_forward", "carom_digest"} <= found.exported


def test_it_carries_the_digest_of_its_sources(library: Path):
    digest = source_digest(ROOT)
    assert (ctypes.c_char * 33).in_dll(ctypes.CDLL(str(library)), "carom_digest").value.decode() == digest
    assert json.loads((library.parent / MANIFEST).read_text())["digest"] == digest


def test_the_manifest_says_how_a_kernel_is_called(library: Path):
    manifest = json.loads((library.parent / MANIFEST).read_text())
    kernel = manifest["kernels"]["report_contacts_kernel"]
    assert kernel["symbol"] == "report_contacts_kernel_cpu_forward"
    assert kernel["module"] == SMALL_MODULE
    assert kernel["dimensions"] == 1
    assert kernel["arguments"][0][2] == 0
    assert manifest["structs"]["array"]["size"] == 56
    assert manifest["structs"]["bounds(1)"] == {
        "fields": [["shape", "uint32[1]", 0], ["size", "uint64", 8], ["coord_mult", "uint64", 16]],
        "size": 24,
    }
    contacts = manifest["structs"]["carom.kernels.warp_types.Contacts"]
    assert contacts["fields"][0][:2] == ["contact_shapes", "array(vector(4,int32),2)"]


def test_a_kernel_over_no_threads_can_be_called(library: Path):
    kernel = json.loads((library.parent / MANIFEST).read_text())["kernels"]["report_contacts_kernel"]
    bounds = np.zeros(3, dtype=np.int64)
    arguments = np.zeros(kernel["size"], dtype=np.uint8)
    function = getattr(ctypes.CDLL(str(library)), kernel["symbol"])
    function.argtypes = ctypes.c_void_p, ctypes.c_void_p
    function(bounds.ctypes.data, arguments.ctypes.data)
    assert not arguments.any()


def test_it_is_built_once(library: Path, target: Target, cache: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr("carom.native.building.library.find_zig", pytest.fail)
    level = next(iter(target.levels))
    assert build(ROOT, target, level, None, modules=[SMALL_MODULE], cache=cache) == library


@pytest.mark.parametrize(
    "name",
    [
        "aarch64-linux",
        # Zig compiles a minute's worth of macOS's own for it, where that is not in its cache.
        pytest.param("arm64-macos", marks=pytest.mark.thorough),
        "x86_64-windows",
        "aarch64-windows",
    ],
)
def test_it_is_built_for_another_platform(name: str, cache: Path):
    target = TARGETS[name]
    level = next(iter(target.levels))
    library = build(ROOT, target, level, None, modules=[SMALL_MODULE], cache=cache)
    assert faults(read_library(library), target, level) == []


def test_libraries_for_windows_have_no_time_in_them(tmp_path: Path):
    library, other = tmp_path / "some.dll", tmp_path / "some.so"
    header = b"MZ" + bytes(0x3A) + (0x40).to_bytes(4, "little") + b"PE\0\0" + b"\x64\x86\x05\0"
    library.write_bytes(header + b"time" + b"rest")
    other.write_bytes(b"\x7fELF" + header)
    remove_time(library)
    remove_time(other)
    assert library.read_bytes() == header + bytes(4) + b"rest"
    assert other.read_bytes() == b"\x7fELF" + header
