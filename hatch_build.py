"""What Hatchling needs help with: the native library, the text for package indices, what is compiled in.

`pip install .` and `python -m build --wheel` build it for this machine, for all its CPU levels. `make wheels`
names other platforms. `pip install --editable .` builds it for this processor, beside the Python files.
"""

from __future__ import annotations

import os
import shutil
import sys
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface
from hatchling.metadata.plugin.interface import MetadataHookInterface

if TYPE_CHECKING:
    from carom.native.targets import Target

# The platform to build for, as `carom.native.building` calls it; if not set, this one.
TARGET_VARIABLE = "CAROM_BUILD_TARGET"
_PLACE = "carom/native/libraries"
_ROOT = Path(__file__).parent
# Where `backend.py` is, too, with which pip and others build.
_TOOLS = str(_ROOT / "tools" / "packaging")
if _TOOLS not in sys.path:
    sys.path.append(_TOOLS)


class DescriptionHook(MetadataHookInterface):
    """Makes the text that an index shows of the readme, and the links beside it."""

    PLUGIN_NAME = "custom"

    def update(self, metadata: dict[str, Any]) -> None:
        """Add text and links to the project's metadata, which is changed in place."""
        from addresses import project_urls
        from long_description import long_description

        text = long_description((_ROOT / "README.md").read_text("utf-8"))
        metadata["readme"] = {"content-type": "text/markdown", "text": text}
        metadata["urls"] = project_urls()


class NativeLibraryHook(BuildHookInterface):
    """Builds the native library and puts it into the wheel, or into the clone."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build, and say which platform the wheel is for.

        Args:
            version: `standard` or `editable`.
            build_data: What the wheel is to be; changed in place.
        """
        root = Path(self.root) / "src"
        sys.path.insert(0, str(root))
        try:
            if version == "editable":
                _build_for_clone(root)
            else:
                _build_for_wheel(root, build_data)
        finally:
            sys.path.remove(str(root))
        build_data["sbom_files"].append(self._write_bill())

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove what is in the wheel by now."""
        shutil.rmtree(self._work)

    def _write_bill(self) -> str:
        from sbom import bill_of_materials

        self._work = tempfile.mkdtemp(prefix="carom-build-")
        bill = Path(self._work) / "carom.cdx.json"
        bill.write_text(bill_of_materials(self.metadata.version), encoding="utf-8", newline="\n")
        return str(bill)


def _build_for_wheel(root: Path, build_data: dict[str, Any]) -> None:
    from carom.native.targets import TARGETS

    name = os.environ.get(TARGET_VARIABLE)
    if name and name not in TARGETS:
        sys.exit(f"{TARGET_VARIABLE} is {name!r}; expected one of {', '.join(TARGETS)}")
    target = TARGETS[name] if name else _this_target()
    for library in _build(root, target, target.shipped):
        build_data["force_include"][str(library)] = f"{_PLACE}/{library.name}"
    for source, target_path in _manual_and_examples():
        build_data["force_include"][str(source)] = target_path
    build_data["pure_python"] = False
    build_data["tag"] = f"py3-none-{'.'.join(target.wheel_tags)}"


def _manual_and_examples() -> list[tuple[Path, str]]:
    """Files that `python -m carom docs` and `examples` show, and where they are in the wheel."""
    docs, examples = _ROOT / "docs", _ROOT / "examples"
    pages = [*sorted(docs.rglob("*.md")), docs / "llms.txt"]
    found = [(page, f"carom/manual/{page.relative_to(docs).as_posix()}") for page in pages]
    return found + [
        (script, f"carom/examples/scripts/{script.name}") for script in sorted(examples.glob("*.py"))
    ]


def _build_for_clone(root: Path) -> None:
    from carom.native.cpu import cpu_levels

    target = _this_target()
    levels = target.usable_levels(cpu_levels())
    if not levels:
        sys.exit(f"CAROM_CPU_LEVEL has to be one of {', '.join(target.levels)}")
    folder = root / _PLACE
    folder.mkdir(exist_ok=True)
    for built in _build(root, target, levels[:1]):
        # Beside it first: the one of before may be loaded by a process that runs.
        copy = folder / f"{built.name}.new"
        shutil.copyfile(built, copy)
        copy.replace(folder / built.name)


def _build(root: Path, target: Target, levels: Sequence[str]) -> list[Path]:
    """The libraries for some levels, and their manifest."""
    from carom.native.building.library import build_all
    from carom.native.building.zig import BuildError

    began = time.monotonic()
    _say(
        f"compiling the physics kernels for {target.name} ({', '.join(levels)}); "
        "takes more than a minute on two cores for each level, and less where they have been compiled before"
    )
    try:
        libraries = build_all(root, target, levels, sys.stderr)
    except BuildError as problem:
        sys.exit(f"Carom cannot be built here: {problem}")
    _say(f"compiled the physics kernels in {time.monotonic() - began:.0f} s")
    return libraries


def _say(sentence: str) -> None:
    """For those who asked pip to be verbose."""
    print(f"carom: {sentence}", file=sys.stderr, flush=True)


def _this_target() -> Target:
    from carom.native.targets import NoTarget, this_target

    try:
        return this_target()
    except NoTarget as problem:
        sys.exit(f"Carom cannot be built here: {problem}")
