"""Modules that come from one file are those that Python would have imported, and it is never in the way."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from carom import code_bundle

NAMES = ("part", "rooms", "rooms.first", "rooms.second")


class Packages:
    """A package of a few modules, which are imported, kept in a file and imported again."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.place = str(folder / "bundled.pyc")
        for name in NAMES:
            path = self.source(name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(
                f'"""Room {name}."""\n\nVALUE = {name!r}\n\n\ndef fail():\n    raise KeyError({name!r})\n'
            )

    def source(self, name: str) -> Path:
        path = self.folder.joinpath("house", *name.split("."))
        return path / "__init__.py" if name == "rooms" else path.with_suffix(".py")

    def use(self) -> dict[str, Any]:
        """The modules, imported anew."""
        for name in list(sys.modules):
            if name.startswith("house"):
                del sys.modules[name]
        importlib.invalidate_caches()
        return {name: importlib.import_module(f"house.{name}") for name in NAMES}

    def keep(self, finder: Any = None) -> None:
        code_bundle._keep(self.place, finder)

    def find(self) -> Any:
        """Let modules be found in the file from now on."""
        finder = code_bundle._read(self.place)
        if finder is not None:
            sys.meta_path.insert(0, finder)
        return finder


@pytest.fixture
def house(tmp_path, monkeypatch):
    monkeypatch.setattr(sys, "meta_path", list(sys.meta_path))
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.setattr(code_bundle, "_FOLDER", str(tmp_path))
    monkeypatch.setattr(code_bundle, "_PACKAGES", ("house",))
    monkeypatch.setattr(code_bundle, "_PART", "house.part")
    monkeypatch.setattr(code_bundle, "_NEW_MODULES", 3)
    yield Packages(tmp_path)
    for name in list(sys.modules):
        if name.startswith("house"):
            del sys.modules[name]


def loaders(modules: dict[str, Any]) -> set[str]:
    return {type(module.__loader__).__name__ for module in modules.values()}


def test_modules_are_those_that_python_imports(house):
    usual = house.use()
    house.keep()
    assert house.find() is not None
    ours = house.use()
    assert loaders(usual) == {"SourceFileLoader"}
    assert loaders(ours) == {"_Loader"}
    for name in NAMES:
        for attribute in ("__file__", "__cached__", "__package__", "__name__", "__doc__", "VALUE"):
            assert getattr(ours[name], attribute) == getattr(usual[name], attribute)
        assert getattr(ours[name], "__path__", None) == getattr(usual[name], "__path__", None)
        assert ours[name].__spec__.origin == usual[name].__spec__.origin
        assert ours[name].__loader__.get_source(f"house.{name}") == house.source(name).read_text()
        with pytest.raises(KeyError) as error:
            ours[name].fail()
        assert error.traceback[-1].path == house.source(name)


def test_a_module_that_has_changed_is_read_anew(house):
    house.use()
    house.keep()
    house.find()
    house.source("rooms.first").write_text("VALUE = 'another, of another size'\n")
    ours = house.use()
    assert ours["rooms.first"].VALUE == "another, of another size"
    assert loaders({"first": ours["rooms.first"]}) == {"SourceFileLoader"}
    assert ours["rooms.second"].VALUE == "rooms.second"


def test_a_module_of_the_same_size_that_is_newer_is_read_anew(house):
    house.use()
    house.keep()
    house.find()
    source = house.source("part")
    source.write_text(source.read_text().replace("VALUE = 'part'", "VALUE = 'trap'"))
    os.utime(source, (1e9, 1e9))
    assert house.use()["part"].VALUE == "trap"


def test_a_module_that_is_gone_is_not_found(house):
    house.use()
    house.keep()
    house.find()
    house.source("rooms.second").unlink()
    with pytest.raises(ModuleNotFoundError, match=r"house\.rooms\.second"):
        house.use()


def test_later_processes_add_what_they_import(house):
    house.use()
    del sys.modules["house.rooms.first"]
    house.keep()
    finder = house.find()
    assert set(finder.index) == {"house.part", "house.rooms", "house.rooms.second"}
    house.use()
    content = Path(house.place).read_bytes()
    house.keep(finder)
    assert Path(house.place).read_bytes() == content, "one module is too little"
    sys.meta_path.remove(finder)
    house.use()
    house.keep(finder)
    found = code_bundle._read(house.place)
    assert found is not None
    assert set(found.index) == {f"house.{name}" for name in NAMES}


@pytest.mark.parametrize("length", [0, 1, 50, 300, -1])
def test_a_damaged_file_is_not_used(house, length):
    house.use()
    house.keep()
    content = Path(house.place).read_bytes()
    Path(house.place).write_bytes(content[:length])
    house.find()
    assert {name: module.VALUE for name, module in house.use().items()} == dict(
        zip(NAMES, NAMES, strict=True)
    )


@pytest.mark.parametrize("what", ["version", "_FOLDER", "_stamp"])
def test_the_file_of_another_python_place_or_form_is_not_used(house, monkeypatch, what):
    house.use()
    house.keep()
    assert code_bundle._read(house.place) is not None
    if what == "version":
        monkeypatch.setattr(sys, "version", "3.99")
    elif what == "_FOLDER":
        monkeypatch.setattr(code_bundle, "_FOLDER", "elsewhere")
    else:
        monkeypatch.setattr(code_bundle, "_stamp", lambda source: (1, 2))
    assert code_bundle._read(house.place) is None


def test_no_file_is_left_where_none_can_be_written(house, monkeypatch):
    house.use()
    house.place = str(house.folder / "missing" / "bundled.pyc")
    house.keep()
    monkeypatch.setattr(os, "replace", lambda *_: (_ for _ in ()).throw(PermissionError()))
    house.place = str(house.folder / "bundled.pyc")
    house.keep()
    assert not list(house.folder.glob("bundled*"))


SCRIPT = """
import sys
import pybullet as p
{connect}
print(type(sys.modules["carom.logger"].__loader__).__name__, "carom.bundled" in sys.modules)
"""


def run(script: str, prefix: Path, **variables: str) -> str:
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    environment |= {"PYTHONPYCACHEPREFIX": str(prefix), **variables}
    command = [sys.executable, "-c", script]
    return subprocess.run(command, env=environment, check=True, capture_output=True, text=True).stdout


def test_the_second_process_uses_what_the_first_has_left(tmp_path):
    plain, connected = SCRIPT.format(connect=""), SCRIPT.format(connect="p.connect(p.DIRECT)")
    assert run(plain, tmp_path) == "SourceFileLoader False\n"
    assert not list(tmp_path.rglob("bundled*")), "no world was made"
    assert run(connected, tmp_path, PYTHONDONTWRITEBYTECODE="1") == "SourceFileLoader False\n"
    assert not list(tmp_path.rglob("bundled*"))
    assert run(connected, tmp_path) == "SourceFileLoader False\n"
    (left,) = tmp_path.rglob("bundled*")
    content = left.read_bytes()
    assert run(connected, tmp_path) == run(plain, tmp_path) == "_Loader False\n"
    assert left.read_bytes() == content


def test_code_is_read_as_often_as_it_is_asked_for(house):
    house.use()
    house.keep()
    finder = house.find()
    ours = house.use()
    for name in (*NAMES, *NAMES):
        found: Any = {}
        exec(finder.code(f"house.{name}"), found)
        assert found["VALUE"] == ours[name].VALUE
    assert importlib.reload(ours["part"]).VALUE == "part"
