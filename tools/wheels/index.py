"""An index in a folder, of what `make wheels` has built, and what pip finds and installs from there."""

from __future__ import annotations

import hashlib
import html
import json
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

from tools.wheels.environment import Environment
from tools.wheels.faults import Unfit

from carom.native.targets import TARGETS

_ROOT = Path(__file__).parents[2]
_FIRST_STEPS = _ROOT / "tools" / "packaging" / "first_steps.py"
# The versions of CPython that the wheels are for, which need not be installed here.
_PYTHON_VERSIONS = ("3.10", "3.11", "3.12", "3.13", "3.14", "3.15")


def make_index(files: Iterable[Path], folder: Path) -> Path:
    """Make an index with links to files, as PEP 503 wants it.

    Args:
        files: Wheels and source distributions of one project.
        folder: An empty folder.

    Returns:
        The folder that pip takes as an index.
    """
    simple = folder / "simple"
    project = simple / "carom"
    project.mkdir(parents=True)
    links: list[str] = []
    for file in sorted(files):
        digest = hashlib.sha256(file.read_bytes()).hexdigest()
        address = f"{file.resolve().as_uri()}#sha256={digest}"
        links.append(f'<a href="{html.escape(address)}" data-requires-python="&gt;=3.10">{file.name}</a>')
    (project / "index.html").write_text(_page(links))
    (simple / "index.html").write_text(_page(['<a href="carom/">carom</a>']))
    return simple


def _page(links: Iterable[str]) -> str:
    body = "<br>\n".join(links)
    return f"<!DOCTYPE html>\n<html><head><title>Index</title></head><body>\n{body}\n</body></html>\n"


def check_downloads(simple: Path) -> int:
    """Have pip choose a wheel for each platform and each version of Python.

    Args:
        simple: The index.

    Returns:
        For how many of them it did.

    Raises:
        Unfit: It found none, or one of another platform.
    """
    count = 0
    for target in TARGETS.values():
        for tag in target.wheel_tags:
            for version in _PYTHON_VERSIONS:
                found = _download(simple, tag, version)
                if tag not in found:
                    raise Unfit(f"for {tag} and Python {version} pip takes {found}")
                count += 1
    return count


def _download(simple: Path, platform: str, version: str) -> str:
    """The file name of what pip downloads for a platform and a version of CPython."""
    with tempfile.TemporaryDirectory() as folder:
        options = ("--no-deps", "--only-binary=:all:", "--implementation=cp", "--quiet", "--dest", folder)
        target = (f"--platform={platform}", f"--python-version={version}")
        command = [sys.executable, "-m", "pip", "download", *options, *target, "--isolated"]
        done = subprocess.run(
            [*command, "--index-url", simple.as_uri(), "carom"], capture_output=True, text=True, check=False
        )
        if done.returncode:
            raise Unfit(f"pip finds nothing for {platform} and Python {version}:\n{done.stderr}")
        return next(Path(folder).iterdir()).name


def check_installation(simple: Path, python: str) -> str:
    """Install from the index into bare environments: alone for the first steps, with all extras for the demo.

    Args:
        simple: The index; what Carom requires comes from that which pip uses anyway.
        python: The Python to install for.

    Returns:
        What the first steps say.

    Raises:
        Unfit: Something else was installed, or does not run.
    """
    with tempfile.TemporaryDirectory(prefix="carom-index-") as name:
        folder = Path(name)
        alone = _installed(folder / "alone", simple, python, "carom")
        said = _run(folder, alone, "-I", _FIRST_STEPS)
        whole = _installed(folder / "all", simple, python, "carom[all]")
        shutil.copytree(_ROOT / "examples", folder / "examples")
        print(_run(folder, whole, folder / "examples" / "demo.py"), flush=True)
        if not (folder / "demo-output" / "trajectories.png").exists():
            raise Unfit("the demo has drawn nothing")
        return said.strip()


def _installed(folder: Path, simple: Path, python: str, requirement: str) -> Path:
    """A Python in a new environment where a requirement is installed, Carom from the index."""
    subprocess.run([python, "-m", "venv", "--without-pip", folder], check=True)
    environment = Environment(folder)
    report = folder / "report.json"
    environment.install("--extra-index-url", simple.as_uri(), "--report", str(report), requirement)
    installed = json.loads(report.read_text("utf-8"))["install"]
    (address,) = (
        one["download_info"]["url"] for one in installed if one["metadata"]["name"].lower() == "carom"
    )
    if not address.startswith("file:"):
        raise Unfit(f"pip took Carom from {address}")
    return environment.python


def _run(folder: Path, python: Path, *arguments: str | Path) -> str:
    """Run a script in a folder, without anything of this environment; what it printed."""
    kept = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "CAROM_"))}
    done = subprocess.run(
        [python, *arguments], cwd=folder, env=kept, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise Unfit(f"{arguments[-1]} failed:\n{done.stdout}{done.stderr}")
    return done.stdout
