"""The library that is loaded is that of this machine and these kernels, or there is a sentence that helps."""

import shutil
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from carom.errors import NativeLibraryError
from carom.native import cpu
from carom.native import library as loading
from carom.native.digest import source_digest
from carom.native.kernels import Kernel
from carom.native.library import Library, library

ROOT = Path(loading.__file__).parents[2]


def loaded_path() -> Path:
    return library().path


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """A copy of the library that is in use, with its manifest."""
    for name in (loaded_path().name, loading.MANIFEST):
        shutil.copy(loaded_path().with_name(name), tmp_path)
    return tmp_path / loaded_path().name


def test_the_library_is_made_from_the_kernels_that_are_here(copy):
    name, kind = Library(copy, source_digest(ROOT)).arguments("step_kernel")[0]
    assert (name, kind.rpartition(".")[2]) == ("settings", "Settings")


def test_one_that_is_made_from_other_kernels_is_refused(copy):
    with pytest.raises(NativeLibraryError, match=r"was built from other kernels than .* here\. .*install"):
        Library(copy, "0" * 32)


def test_an_installed_one_came_with_its_sources_which_are_not_read_again(copy, monkeypatch):
    def never(root: Path) -> str:
        raise AssertionError(f"{root} was read")

    monkeypatch.setattr(loading, "PACKAGED", copy.parent)
    monkeypatch.setattr(loading, "_is_clone", lambda: False)
    monkeypatch.setattr(loading, "source_digest", never)
    assert loading._library.__wrapped__().path == copy


def test_an_installed_one_with_the_manifest_of_another_is_refused(copy, monkeypatch):
    manifest = copy.with_name(loading.MANIFEST)
    manifest.write_text(manifest.read_text().replace(source_digest(ROOT), "0" * 32))
    monkeypatch.setattr(loading, "PACKAGED", copy.parent)
    monkeypatch.setattr(loading, "_is_clone", lambda: False)
    with pytest.raises(NativeLibraryError, match=r"other kernels than .* Install Carom again"):
        loading._library.__wrapped__()


@pytest.mark.parametrize("content", [b"", b"\x7fELF damaged"])
def test_a_damaged_one_is_refused(copy, content):
    copy.unlink()
    copy.write_bytes(content)
    with pytest.raises(NativeLibraryError, match=r"cannot be loaded: .*install"):
        Library(copy, source_digest(ROOT))


@pytest.mark.parametrize("content", ["", "{}", '{"kernels": '])
def test_one_without_its_manifest_is_refused(copy, content):
    copy.with_name(loading.MANIFEST).write_text(content)
    with pytest.raises(NativeLibraryError, match="cannot be loaded"):
        Library(copy, source_digest(ROOT))


def test_where_there_is_none_and_nothing_to_build_it_with_the_cure_is_said(monkeypatch, tmp_path):
    monkeypatch.setattr(loading, "PACKAGED", tmp_path)
    monkeypatch.setattr(loading, "_COMPILERS", ("no_such_compiler",))
    with pytest.raises(NativeLibraryError, match=r"Carom's native library is missing .*install"):
        loading._library.__wrapped__()


def test_levels_that_there_are_not_are_refused(monkeypatch):
    monkeypatch.setenv("CAROM_CPU_LEVEL", "v9")
    with pytest.raises(NativeLibraryError, match="CAROM_CPU_LEVEL is 'v9'; expected one of v"):
        loading._library.__wrapped__()


def test_a_kernel_that_there_is_not_is_named():
    with pytest.raises(NativeLibraryError, match="no kernel 'no_such_kernel'"):
        _ = Kernel("no_such_kernel").indices


@pytest.mark.parametrize(
    ("flags", "levels"),
    [
        ("sse4_2", ["v2"]),
        ("avx2 bmi2 fma f16c movbe", ["v3", "v2"]),
        ("avx2 bmi2 fma f16c movbe avx512bw avx512dq avx512vl", ["v4", "v3", "v2"]),
        ("avx512bw avx512dq avx512vl", ["v2"]),
    ],
)
def test_the_level_is_the_best_that_the_processor_has(monkeypatch, flags, levels):
    monkeypatch.delenv("CAROM_CPU_LEVEL", raising=False)
    monkeypatch.setattr(cpu.platform, "machine", lambda: "x86_64")
    monkeypatch.setattr(cpu.sys, "platform", "linux")
    monkeypatch.setattr(cpu, "_linux_flags", lambda: set(flags.split()))
    assert cpu.cpu_levels() == levels


TWO_THREADS = """
import threading
from carom import World

def fall(heights):
    with World() as world:
        world.gravity = (0, 0, -10)
        world.load_urdf("sphere2.urdf", position=(0, 0, 5))
        world.step(100)
        heights.append(float(world.position[2]))

ends = [[], []]
threads = [threading.Thread(target=fall, args=(heights,)) for heights in ends]
for thread in threads:
    thread.start()
for thread in threads:
    thread.join()
assert ends[0] == ends[1] and len(ends[0]) == 1, ends
"""


def test_two_threads_may_be_the_first_to_use_a_world():
    for _ in range(3):
        subprocess.run([sys.executable, "-c", TWO_THREADS], check=True)


def test_threads_that_ask_at_once_get_the_same_library():
    found: list[Library] = []
    threads = [threading.Thread(target=lambda: found.append(library())) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [one is found[0] for one in found] == [True] * 4


def test_nothing_of_the_compiler_is_imported_where_the_library_is_there():
    script = (
        "import sys; from carom import World; world = World(); world.load_urdf('r2d2.urdf'); world.step();"
        "print([name for name in sys.modules if name == 'warp' or name.startswith('carom.kernels.')])"
    )
    done = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert done.stdout.strip() == "[]"
