"""Imports point one way; docs/architecture.md says why each layer may know the ones below it."""

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "src"

DESCRIPTION = {"carom.errors", "carom.description"}
MODEL = {*DESCRIPTION, "carom.formats", "carom.geometry", "carom.layouts", "carom.native", "carom.model"}
ENGINE = {*MODEL, "carom.engine"}

# What each layer may import beside itself, the standard library and third parties.
MAY_IMPORT = {
    "carom.errors": set(),
    "carom.version": set(),
    "carom.checks": set(),
    "carom.named": set(),
    "carom.description": {"carom.errors"},
    "carom.geometry": DESCRIPTION,
    "carom.formats": {*DESCRIPTION, "carom.geometry"},
    "carom.layouts": {"carom.description"},
    "carom.native": {"carom.errors", "carom.layouts"},
    "carom.model": {*DESCRIPTION, "carom.formats", "carom.geometry", "carom.layouts", "carom.native"},
    # Device code: nothing that runs on the host imports it.
    "carom.kernels": {"carom.layouts"},
    "carom.engine": MODEL,
    "carom.gpu": {*ENGINE, "carom.kernels"},
    "carom.remote": {"carom.errors"},
    # It takes any vector environment, and so needs none of ours.
    "carom.cluster": {"carom.errors"},
    "carom.control": {"carom.checks"},
    "carom.saved": MODEL,
    # World, bodies, joints, links: the modules directly under carom that are not named here.
    "carom.world": {
        *ENGINE,
        "carom.checks",
        "carom.named",
        "carom.saved",
        "carom.version",
    },
    "carom.worlds": {*ENGINE, "carom.checks", "carom.world", "carom.camera"},
    "carom.vector": {"carom.checks", "carom.world", "carom.worlds", "carom.camera", "pybullet_data"},
    "carom.algorithms": {*ENGINE, "carom.world"},
    "carom.render": {*ENGINE, "carom.saved", "carom.world"},
    "carom.viewer": {*ENGINE, "carom.checks", "carom.world", "carom.render"},
    "carom.camera": {*DESCRIPTION, "carom.checks", "carom.world", "carom.render"},
    "carom.video": {"carom.checks"},
    "carom.recorder": {"carom.checks", "carom.world", "carom.camera", "carom.video"},
    "carom.warmup": {*ENGINE, "carom.algorithms", "carom.render"},
    "carom.record": {"carom.world", "carom.viewer"},
    "carom": {
        "carom.world",
        "carom.worlds",
        "carom.camera",
        "carom.recorder",
        "carom.control",
        "carom.version",
    },
    "carom.cli": {
        *MODEL,
        "carom.serve",
        "carom.record",
        "carom.world",
        "carom.viewer",
        "carom.version",
        "carom.warmup",
        "pybullet_data",
    },
    "carom.serve": {"carom.errors", "carom.warmup", "pybullet"},
    "carom.__main__": {"carom.cli"},
    "pybullet": {
        *MODEL,
        "carom.world",
        "carom.algorithms",
        "carom.remote",
        "carom.render",
        "carom.camera",
        "carom.video",
        "carom.recorder",
        "carom.viewer",
        "carom.version",
    },
    "pybullet_data": set(),
    "eglRenderer": set(),
    # The URDF editor writes files of its own.
    "pybullet_utils": {"pybullet", "pybullet_data", *DESCRIPTION, "carom.formats"},
    "pybullet_robots": {"pybullet", "pybullet_data", "pybullet_utils"},
    "pybullet_envs": {
        "pybullet",
        "pybullet_data",
        "pybullet_utils",
        "pybullet_robots",
        # Environments many at once.
        *MODEL,
        "carom.checks",
        "carom.camera",
        "carom.vector",
        "carom.world",
        "carom.worlds",
    },
    "pybullet_examples": {"pybullet_utils"},
}


def layer_of(module: str) -> str | None:
    """The layer a module is in; None for the standard library and third parties."""
    package, *rest = module.split(".")
    if package != "carom" or not rest:
        return package if package in MAY_IMPORT else None
    layer = f"carom.{rest[0]}"
    is_part_of_the_world = layer not in MAY_IMPORT and (SOURCE / "carom" / f"{rest[0]}.py").is_file()
    return "carom.world" if is_part_of_the_world else layer


def module_name(path: Path) -> str:
    parts = path.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported_modules(path: Path) -> set[str]:
    """Absolute names of all modules a file imports, local imports included."""
    package = module_name(path).split(".")
    if path.name != "__init__.py":
        package = package[:-1]
    names = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else []
            origin = ".".join([*above, *([node.module] if node.module else [])])
            inside_a_package = (SOURCE / Path(*origin.split("."))).is_dir()
            # `from carom import model` imports carom.model, `from carom.world import World` carom.world.
            names.update(f"{origin}.{alias.name}" if inside_a_package else origin for alias in node.names)
    return names


SOURCES = sorted(SOURCE.rglob("*.py"))


@pytest.mark.parametrize("path", SOURCES, ids=module_name)
def test_a_module_imports_only_the_layers_below_its_own(path):
    layer = layer_of(module_name(path))
    assert layer in MAY_IMPORT, f"{module_name(path)} belongs to no layer; add it to the table and the docs"
    imported = {layer_of(name) for name in imported_modules(path)} - {None, layer}
    assert imported <= MAY_IMPORT[layer]


def test_the_table_is_a_hierarchy():
    graph = {layer: set(targets) for layer, targets in MAY_IMPORT.items()}
    while graph:
        leaves = [layer for layer, targets in graph.items() if not targets & graph.keys()]
        assert leaves, f"these layers import each other in a circle: {sorted(graph)}"
        for leaf in leaves:
            del graph[leaf]
