"""Translate the kernels to C++, write a manifest of them as JSON, and the header of our own C++.

This runs as a program in a process of its own, because it imports Warp:
`python -m carom.native.building.codegen DIGEST FOLDER MODULE...`.

Warp generates the same C++ that it would compile itself, except for parts that are not needed here: adjoints,
comments with line numbers, and names that depend on the content.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from importlib import import_module
from multiprocessing import get_context
from pathlib import Path
from typing import Any, NamedTuple

import warp as wp
from warp._src.context import ModuleBuilder

from carom.layouts.programs import LANES
from carom.native.building.cache import MANIFEST
from carom.native.building.headers import HEADER, header
from carom.native.building.inlining import inlined
from carom.native.building.lanes import in_lanes
from carom.native.building.manifest import (
    fixed_layouts,
    kernel_entry,
    layout_assertions,
    merge_layouts,
    struct_layouts,
)
from carom.native.cpu import core_count
from carom.native.kernel_modules import LANE_MODULES

# Code is generated for blocks of one thread, which makes a kernel a plain C function.
_BLOCK_SIZE = 1
_COMMENT = re.compile(r"^[ \t]*//.*\n", re.MULTILINE)
# Memory for tiles. No kernel uses it, but each would clear it, in memory that all threads share.
_TILE_ROOM = re.compile(
    r"^ *wp::tile_shared_storage_t tile_mem;\n#if defined\(WP_ENABLE_TILES_IN_STACK_MEMORY\)\n.*\n#endif\n",
    re.MULTILINE,
)
# Accesses to elements of arrays and loops over ranges, for which `arrays.h` and `loops.h` have functions of
# the same names; they need Warp's header. Which `iter_cmp` is called depends on the type of its argument.
_REPLACED = re.compile(r"\bwp::(address|index|array_store|range_t|range|iter_next)\b")
_WARPS_HEADER = '#include "builtin.h"\n'
_OUR_HEADERS = '#include "arrays.h"\n#include "loops.h"\n'


# Functions for adjoints of structs have external linkage, and several modules have the same structs; so they
# are made static.
_SEEN = re.compile(r"^(?=CUDA_CALLABLE )", re.MULTILINE)
# All functions are to be inlined at first; see `inlining`.
_NATIVE = re.compile(r"^static (?=CUDA_CALLABLE )", re.MULTILINE)


class KernelClash(Exception):
    """Two modules have kernels of the same name."""


class _ForwardBuilder(ModuleBuilder):
    """Generates no adjoints."""

    def _codegen_functions(
        self, functions: Any, device: str, forward_only: bool = False, reverse_only: bool = False
    ) -> str:
        if reverse_only:
            return ""
        return super()._codegen_functions(functions, device, forward_only, reverse_only)


class _Generated(NamedTuple):
    """C++ of one module, and the entries of its kernels and of their structs in the manifest."""

    source: str
    kernels: dict[str, dict[str, Any]]
    structs: dict[str, dict[str, Any]]


def generate(modules: Sequence[str], digest: str, folder: Path) -> None:
    """Write to a folder a `.cpp` file for each module, a manifest with the sources' digest, and `layouts.h`.

    Modules are translated in parallel, in this order.

    Raises:
        KernelClash: Two modules have a kernel of the same name.
    """
    kernels: dict[str, dict[str, Any]] = {}
    structs: dict[str, dict[str, Any]] = {}
    # Forks are not safe once there are threads. Warp numbers functions of one name as they are imported, so
    # every process imports all modules, in the same order.
    processes = min(core_count(), len(modules)), get_context("spawn"), _import_all, (modules,)
    with ProcessPoolExecutor(*processes) as workers:
        for name, generated in zip(modules, workers.map(_generate_module, modules), strict=True):
            for key, kernel in generated.kernels.items():
                if key in kernels:
                    raise KernelClash(
                        f"{kernels[key]['module']} and {name} both have a kernel {key!r}; "
                        "kernels of the native library need names of their own"
                    )
                kernels[key] = kernel
            merge_layouts(structs, generated.structs)
            (folder / f"{name}.cpp").write_text(generated.source, encoding="utf-8", newline="\n")
    merge_layouts(structs, fixed_layouts(kernel["dimensions"] for kernel in kernels.values()))
    manifest = {
        "digest": digest,
        "kernels": dict(sorted(kernels.items())),
        "structs": dict(sorted(structs.items())),
    }
    (folder / HEADER).write_text(header(), encoding="utf-8", newline="\n")
    text = json.dumps(manifest, separators=(",", ":"))
    (folder / MANIFEST).write_text(text + "\n", encoding="utf-8", newline="\n")


def _import_all(modules: Sequence[str]) -> None:
    for name in modules:
        import_module(name)


def _generate_module(name: str) -> _Generated:
    module = wp.get_module(import_module(name).__name__)
    # Names without a part that depends on the content.
    module.options["strip_hash"] = True
    options = module.resolve_options(wp.config, block_dim=_BLOCK_SIZE) | {"output_arch": None}
    options["line_directives"] = False
    builder = _ForwardBuilder(module, options, target="cpu")
    source = _COMMENT.sub("", builder.codegen("cpu"))
    source, count = _TILE_ROOM.subn("", source)
    source = _NATIVE.sub("static WP_FORCEINLINE ", source)
    source = _SEEN.sub("static ", source)
    source = _REPLACED.sub(r"carom::\1", source)
    source = source.replace(_WARPS_HEADER, _WARPS_HEADER + _OUR_HEADERS)
    kernels = list(builder.kernels)
    if count != len(kernels):
        raise RuntimeError(f"{name}: this version of Warp generates kernels in another form than 1.19")
    source = '#include "prelude.h"\n' + source.replace("WP_API", "CAROM_EXPORT")
    for_lanes = name in LANE_MODULES
    called = {one.native_func for one in builder.functions if getattr(one.func, "called", False)}
    source = inlined(in_lanes(source) if for_lanes else source, called)
    source += layout_assertions(kernels, LANES if for_lanes else 1)
    entries = {kernel.key: kernel_entry(kernel, name) for kernel in sorted(kernels, key=lambda one: one.key)}
    return _Generated(source, entries, struct_layouts(kernels))


if __name__ == "__main__":
    # Workers import this module by its name, not that of the program.
    import_module("carom.native.building.codegen").generate(sys.argv[3:], sys.argv[1], Path(sys.argv[2]))
