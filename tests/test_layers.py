"""Imports point one way; docs/architecture.md says why each layer may know the ones below it."""

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).parents[1] / "src"

DESCRIPTION = {"carom.errors", "carom.description"}
MODEL = {*DESCRIPTION, "carom.formats", "carom.model"}
ENGINE = {*MODEL, "carom.physics"}
HELPERS = {"carom.checks", "carom.named"}
# A world and what hangs on it know each other.
WORLD = {
    "carom.algorithms",
    "carom.alive",
    "carom.body",
    "carom.constraints",
    "carom.dynamics_changes",
    "carom.joint",
    "carom.joint_motor",
    "carom.link",
    "carom.link_dynamics",
    "carom.world",
}

# What each layer may import beside itself, the standard library and third parties.
MAY_IMPORT = {
    "carom.errors": set(),
    "carom.version": set(),
    "carom.checks": set(),
    "carom.named": set(),
    "carom.description": {"carom.errors"},
    "carom.formats": DESCRIPTION,
    "carom.model": {*DESCRIPTION, "carom.formats"},
    "carom.physics": {"carom.errors", "carom.model"},
    "carom.control": {"carom.checks"},
    **{part: {*ENGINE, *HELPERS, *WORLD} for part in WORLD},
    "carom.warmup": {"carom.model", "carom.physics", "carom.algorithms"},
    "carom": {*WORLD, "carom.control", "carom.version"},
    "carom.cli": {*ENGINE, *WORLD, "carom.version", "carom.warmup", "pybullet_data"},
    "carom.__main__": {"carom.cli"},
    "pybullet": {*MODEL, *WORLD, "carom.version"},
    "pybullet_data": set(),
    "pybullet_utils": {"pybullet"},
}


def layer_of(module: str) -> str | None:
    """The layer a module is in: the longest name of the table that it starts with."""
    parts = module.split(".")
    if parts[0] == "carom" and len(parts) > 1:
        return ".".join(parts[:2])
    return parts[0] if parts[0] in MAY_IMPORT else None


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


def test_the_table_is_a_hierarchy_but_for_the_world_and_its_parts():
    graph = {layer: targets - WORLD if layer in WORLD else targets for layer, targets in MAY_IMPORT.items()}
    while graph:
        leaves = [layer for layer, targets in graph.items() if not targets & graph.keys()]
        assert leaves, f"these layers import each other in a circle: {sorted(graph)}"
        for leaf in leaves:
            del graph[leaf]
