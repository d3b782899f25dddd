"""What Carom says if PyBullet is, or has been, in the same environment."""

from __future__ import annotations

import json
import subprocess
import zipfile
from pathlib import Path

import pytest
from tests.installation.site_packages import EXTENSION_MODULE, FOREIGN, SOURCE, carom_in, replace, run

from carom import conflicts
from carom.conflicts import SHARED

IMPORTS = ["import pybullet", "import carom", "import pybullet_data, pybullet"]
UNINSTALL = "    pip uninstall -y pybullet\n"
REINSTALL = "    pip install --force-reinstall --no-deps carom\n"


@pytest.fixture
def site(tmp_path: Path) -> Path:
    return carom_in(tmp_path / "site")


def silent(done: subprocess.CompletedProcess[str]) -> bool:
    """Whether a script has come to its end without a word."""
    return (done.returncode, done.stdout, done.stderr) == (0, "", "")


def complaint(done: subprocess.CompletedProcess[str]) -> str:
    """The only error of a script, which is an `ImportError` with both commands."""
    assert done.returncode == 1
    assert done.stderr.count("Error: ") == 1
    return with_cure(done.stderr.partition("ImportError: ")[2])


def warning(done: subprocess.CompletedProcess[str]) -> str:
    """The only warning of a script, which has both commands."""
    assert done.returncode == 0
    assert done.stderr.count("Warning: ") == 1
    return with_cure(done.stderr.partition("RuntimeWarning: ")[2])


def with_cure(message: str) -> str:
    assert (message.count(UNINSTALL), message.count(REINSTALL)) == (1, 1)
    return message


@pytest.mark.parametrize("statement", IMPORTS)
def test_nothing_is_said_without_pybullet(site, statement):
    assert silent(run(statement, site))


def test_nothing_is_said_about_the_stand_in(site):
    metadata = site / "pybullet-3.2.7+carom.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: pybullet\nVersion: 3.2.7+carom\n")
    assert silent(run("import pybullet", site))


@pytest.mark.parametrize("statement", IMPORTS)
def test_an_extension_module_beside_complete_packages_is_a_warning(site, statement):
    (site / EXTENSION_MODULE).touch()
    assert "both installed" in warning(run(statement, site))


@pytest.mark.parametrize("statement", IMPORTS)
def test_pybullet_data_without_its_code_is_an_error(site, statement):
    replace(site, "pybullet_data", None)
    assert "missing in pybullet_data." in complaint(run(statement, site))


@pytest.mark.parametrize("package", SHARED)
def test_a_package_without_its_code_is_an_error(site, package):
    replace(site, package, None)
    assert f"missing in {package}." in complaint(run("import carom", site))


@pytest.mark.parametrize("package", SHARED)
def test_a_package_of_pybullet_is_an_error(site, package):
    replace(site, package, FOREIGN)
    assert f"overwritten {package}." in complaint(run("import carom", site))


def test_all_that_is_wrong_is_one_error(site):
    (site / EXTENSION_MODULE).touch()
    replace(site, "pybullet_data", FOREIGN)
    replace(site, "pybullet_envs", FOREIGN)
    replace(site, "pybullet_utils", None)
    message = complaint(run("import pybullet", site))
    assert "missing in pybullet_utils; PyBullet has overwritten pybullet_data, pybullet_envs." in message


def test_a_package_that_was_left_out_is_no_error(site):
    (site / "pybullet_examples").unlink()
    assert silent(run("import pybullet", site))


@pytest.mark.parametrize("package", SHARED)
def test_packages_name_carom_where_it_is_looked_for(package):
    assert b"Carom" in (SOURCE / package / "__init__.py").read_bytes()[:512]


def test_an_extension_module_that_is_found_before_carom_is_a_warning(site, tmp_path):
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / EXTENSION_MODULE).touch()
    assert str(elsewhere / EXTENSION_MODULE) in warning(run("import carom", elsewhere, site))
    assert silent(run("import carom", site, elsewhere))
    assert silent(run("import pybullet", site, elsewhere))


def test_an_extension_module_that_is_loaded_is_a_warning(site):
    load = "import sys; from types import ModuleType; p = sys.modules['pybullet'] = ModuleType('pybullet')"
    name = f"p.__file__ = '/elsewhere/{EXTENSION_MODULE}'"
    assert "/elsewhere/" in warning(run(f"{load}; {name}; import carom", site))


@pytest.mark.parametrize(
    "statement", ["import carom", "import pybullet", "import pybullet_utils.bullet_client"]
)
def test_the_warning_names_the_line_that_imports_carom(site, tmp_path, statement):
    (site / EXTENSION_MODULE).touch()
    (tmp_path / "script.py").write_text(f"\n\n{statement}\n")
    assert "script.py:3: RuntimeWarning" in run("import script", site, tmp_path).stderr


def test_programs_that_were_frozen_have_no_files_to_look_at(site):
    replace(site, "pybullet_data", None)
    assert silent(run("import sys; sys.frozen = True; import carom", site))


def test_archives_have_no_files_to_look_at(tmp_path):
    archive = tmp_path / "carom.zip"
    with zipfile.ZipFile(archive, "w") as file:
        for path in (SOURCE / "carom").glob("*.py"):
            file.write(path, f"carom/{path.name}")
        file.writestr("pybullet_data/py.typed", "")
    assert silent(run("import carom", archive))


@pytest.mark.parametrize("name", ["conflicts.pyc", "compiled_into_the_program.py"])
def test_programs_without_source_files_have_none_to_look_at(site, name, monkeypatch):
    replace(site, "pybullet_data", None)
    (site / "carom").unlink()
    (site / "carom").mkdir()
    for there in ("conflicts.py", "conflicts.pyc"):
        (site / "carom" / there).touch()
    monkeypatch.setattr(conflicts, "__file__", str(site / "carom" / "conflicts.py"))
    with pytest.raises(ImportError, match="pybullet_data"):
        conflicts.check()
    monkeypatch.setattr(conflicts, "__file__", str(site / "carom" / name))
    conflicts.check()


@pytest.mark.parametrize(
    ("record", "requirement"),
    [
        ({"url": "file:///wheels/carom.whl", "archive_info": {}}, "file:///wheels/carom.whl"),
        ({"url": "file:///clone", "dir_info": {}}, "file:///clone"),
        ({"url": "file:///clone", "dir_info": {"editable": True}}, "--editable file:///clone"),
        ({"url": "https://example.org/carom.git", "vcs_info": {"vcs": "git"}}, "carom"),
        (None, "carom"),
    ],
)
def test_carom_is_installed_again_from_where_it_came(site, record, requirement):
    metadata = site / "carom-0.1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: carom\nVersion: 0.1.0\n")
    if record is not None:
        (metadata / "direct_url.json").write_text(json.dumps(record))
    (site / EXTENSION_MODULE).touch()
    assert f"--no-deps {requirement}\n" in run("import carom", site).stderr


def test_a_sound_installation_needs_no_metadata(site):
    assert run("import pybullet, sys; print('importlib.metadata' in sys.modules)", site).stdout == "False\n"
