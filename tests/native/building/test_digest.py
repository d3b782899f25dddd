import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from tests.native.building.conftest import ROOT

from carom.native.digest import source_digest
from carom.native.kernel_modules import ARRAY_MODULES, KERNEL_MODULES, PARALLEL_MODULES


@pytest.fixture
def root(tmp_path: Path) -> Path:
    shutil.copytree(ROOT / "carom", tmp_path / "carom", ignore=shutil.ignore_patterns("__pycache__"))
    return tmp_path


def test_every_module_with_kernels_is_in_a_library():
    with_kernels = {
        ".".join(path.relative_to(ROOT).with_suffix("").parts)
        for path in (ROOT / "carom").rglob("*.py")
        if re.search(r"^@kernel$", path.read_text(encoding="utf-8"), re.MULTILINE)
    }
    # The processor needs no kernels for arithmetic with arrays.
    assert {*KERNEL_MODULES, *PARALLEL_MODULES, *ARRAY_MODULES} == with_kernels


def test_an_edit_of_what_a_kernel_imports_changes_it(root: Path):
    before = source_digest(root)
    with (root / "carom/kernels/maths/rotation.py").open("a") as file:
        file.write("# more\n")
    assert source_digest(root) != before


@pytest.mark.parametrize(
    "name", ["source/more.cpp", "building/prelude.h", "building/flags.py", "building/libm/math.h"]
)
def test_an_edit_of_what_else_is_compiled_changes_it(root: Path, name: str):
    before = source_digest(root)
    path = root / "carom/native" / name
    path.parent.mkdir(exist_ok=True)
    with path.open("a") as file:
        file.write("\n")
    assert source_digest(root) != before


def test_an_edit_of_host_code_does_not(root: Path):
    before = source_digest(root)
    (root / "carom/world/world.py").write_text("")
    assert source_digest(root) == before


def test_line_endings_do_not_count(root: Path):
    before = source_digest(root)
    for path in (root / "carom").rglob("*.py"):
        path.write_bytes(path.read_bytes().replace(b"\n", b"\r\n"))
    assert source_digest(root) == before


def test_it_needs_no_warp():
    code = (
        "import sys; from pathlib import Path; from carom.native.digest import source_digest; "
        f"source_digest(Path({str(ROOT)!r})); assert not {{'warp', 'numpy'}} & {{*sys.modules}}"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_missing_folder_is_an_error(root: Path):
    shutil.rmtree(root / "carom/layouts")
    with pytest.raises(FileNotFoundError):
        source_digest(root)
