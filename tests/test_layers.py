"""Imports point one way, between packages and inside them; docs/architecture.md lists the packages.

What counts is every import that is ever performed: at the top of a module, inside a function, or by name.
Imports for the type checker may go in circles only where `CIRCLES_OF_TYPES` says so.
"""

import ast
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path

from tests.each import each

SOURCE = Path(__file__).parents[1] / "src"
MAX_FILES_IN_A_FOLDER = 25
# Floors of all packages, and of the library alone, without the drop-in and what runs it.
MOST_FLOORS = 12
MOST_FLOORS_OF_THE_LIBRARY = 10

# The lowest first: a package may import those of the layers below its own.
LAYERS = (
    {"carom.internal_names"},
    {"carom.foreign_names"},
    {
        "carom.checks",
        "carom.closed",
        "carom.conflicts",
        "carom.errors",
        "carom.logger",
        "carom.forks",
        "carom.suggestions",
        "carom.version",
        "carom.writing",
        "eglRenderer",
        "pybullet_data",
    },
    {"carom.layouts"},
    # Maths of the host is in the native library, too.
    {"carom.kernels", "carom.native"},
    {"carom.files"},
    {"carom.description", "carom.geometry", "carom.meshes"},
    {
        "carom.cluster",
        "carom.control",
        "carom.formats",
        "carom.model",
        "carom.pose",
        "carom.recording",
        "carom.remote",
    },
    {"carom.algorithms", "carom.engine", "carom.file_bodies", "carom.soft"},
    {"carom.editing"},
    {"carom.gpu", "carom.render", "carom.scene"},
    {"carom.linearization", "carom.profiling"},
    {"carom.camera", "carom.controllers", "carom.identification", "carom.viewer", "carom.world_files"},
    {"carom.replay", "carom.world"},
    {"carom.simulator", "carom.worlds"},
    {"carom.jax", "carom.torch", "carom.vector"},
    # The drop-in.
    {"pybullet._calls"},
    {"pybullet._access", "pybullet._maths"},
    {"pybullet._clients"},
    {
        "pybullet._algorithms",
        "pybullet._bodies",
        "pybullet._contacts",
        "pybullet._joints",
        "pybullet._loading",
        "pybullet._plugins",
        "pybullet._shapes",
        "pybullet._window",
    },
    {"pybullet._cameras", "pybullet._connections", "pybullet._engine", "pybullet._logs"},
    {"pybullet"},
    # What runs it, and what comes with it.
    {"carom.cli", "carom.examples", "pybullet_examples", "pybullet_robots", "pybullet_utils"},
    {"carom.__main__", "pybullet_envs"},
)
LAYER = {package: number for number, packages in enumerate(LAYERS) for package in packages}

# Packages that are kept free of the others below them, and what they may import.
KEPT_APART = {
    "carom.description": {"carom.errors", "carom.layouts", "carom.native"},
    "carom.geometry": {"carom.errors", "carom.layouts", "carom.native"},
    "carom.files": {"carom.errors", "carom.forks"},
    "carom.meshes": {"carom.errors", "carom.files", "carom.native"},
    "carom.layouts": set(),
    # Device code: nothing that runs on the host imports it but what compiles and launches it.
    "carom.kernels": {"carom.layouts"},
    "carom.native": {"carom.errors", "carom.forks", "carom.layouts"},
    # They know nothing of physics.
    "carom.remote": {"carom.errors", "carom.writing"},
    "carom.cluster": {"carom.errors"},
    "carom.control": {"carom.checks"},
}
LAUNCH_KERNELS = {"carom.gpu", "carom.kernels"}

# Modules that name each other's types: one of each circle, how many there are, and why.
CIRCLES_OF_TYPES = {
    # A body has a world, joints and links, these have a body, and a world loads bodies: handles that users go
    # from one to the other, and methods that make them.
    "carom.scene.body": 42,
    # The same without what only users need: functions in modules of their own take these classes.
    "carom.scene.core.world_core": 16,
    # Joints, links and shapes of bodies of many worlds: handles as well.
    "carom.worlds.parts.joint": 4,
    # Many worlds, and files and logs of them.
    "carom.worlds.worlds": 5,
}


def module_name(path: Path) -> str:
    parts = path.relative_to(SOURCE).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


# Where Carom is installed, `SOURCE` has the packages of others as well.
TOP_LEVEL = {package.partition(".")[0] for packages in LAYERS for package in packages}
MODULES = {
    module_name(path): path for top in sorted(TOP_LEVEL) for path in sorted((SOURCE / top).rglob("*.py"))
}


def package_of(module: str) -> str | None:
    """The package of the layers a module is in; None for the standard library and third parties."""
    top, _, rest = module.partition(".")
    package = f"{top}.{rest.partition('.')[0]}" if rest else top
    return package if package in LAYER else top if top in LAYER else None


def performed(tree: ast.AST) -> Iterator[ast.AST]:
    """The nodes of a module, without what only the type checker sees."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.If) and "TYPE_CHECKING" in ast.dump(node.test):
            for other in node.orelse:
                yield other
                yield from performed(other)
            continue
        yield node
        yield from performed(node)


def imported_modules(module: str) -> tuple[set[str], set[str]]:
    """The modules of ours that a module imports, also in functions and by name; and those with types."""
    path = MODULES[module]
    package = module.split(".") if path.name == "__init__.py" else module.split(".")[:-1]
    tree = ast.parse(path.read_text(encoding="utf-8"))
    every = list(ast.walk(tree))
    # Most modules have nothing for the type checker alone.
    apart = any(isinstance(node, ast.Name) and node.id == "TYPE_CHECKING" for node in every)
    found = _named(module, package, every)
    return (_named(module, package, list(performed(tree))) if apart else found), found


def _named(module: str, package: list[str], nodes: list[ast.AST]) -> set[str]:
    """The modules of ours that nodes of a module import."""
    names: set[str] = set()
    for node in nodes:
        if isinstance(node, ast.Import):
            names.update(alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            above = package[: len(package) - node.level + 1] if node.level else []
            origin = ".".join([*above, *([node.module] if node.module else [])])
            for alias in node.names:
                inside = f"{origin}.{alias.name}"
                names.add(inside if inside in MODULES else origin)
    if any(isinstance(node, ast.Name) and node.id == "import_module" for node in nodes):
        texts = {
            node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)
        }
        names.update(texts & MODULES.keys())
    return (names & MODULES.keys()) - {module}


@cache
def _imports_of_both_kinds() -> dict[str, tuple[set[str], set[str]]]:
    return {module: imported_modules(module) for module in MODULES}


def imports() -> dict[str, set[str]]:
    """What each module imports."""
    return {module: performed for module, (performed, _) in _imports_of_both_kinds().items()}


def circles(graph: dict[str, set[str]]) -> set[str]:
    """The nodes that are in a circle, or lead from one to another."""
    left = {node: set(targets) & graph.keys() for node, targets in graph.items()}
    while leaves := [node for node, targets in left.items() if not targets & left.keys()]:
        for leaf in leaves:
            del left[leaf]
    return set(left)


def circles_apart(graph: dict[str, set[str]]) -> list[set[str]]:
    """The largest sets of nodes, of two or more, in which each leads to every other."""

    def reached(start: str, edges: dict[str, set[str]]) -> set[str]:
        seen, pending = {start}, [start]
        while pending:
            new = edges[pending.pop()] - seen
            seen |= new
            pending += new
        return seen

    left = circles(graph)
    forward = {node: graph[node] & left for node in left}
    backward = {node: {other for other in left if node in forward[other]} for node in left}
    found = []
    while left:
        start = min(left)
        circle = reached(start, forward) & reached(start, backward)
        left -= circle
        if len(circle) > 1:
            found.append(circle)
    return found


def floors(graph: dict[str, set[str]]) -> int:
    """The number of nodes of the longest way along arrows, of which none lead back."""
    heights: dict[str, int] = {}

    def height(node: str) -> int:
        if node not in heights:
            heights[node] = 1 + max(map(height, graph[node] & graph.keys()), default=0)
        return heights[node]

    return max(map(height, graph))


@each("module", MODULES)
def test_a_module_imports_only_packages_of_lower_layers(module: str) -> None:
    # The package itself only hands out names.
    if module == "carom":
        return
    package = package_of(module)
    assert package in LAYER, f"{module} belongs to no package; add it to the layers and the docs"
    imported = {package_of(name) for name in imports()[module] if name != "carom"} - {package, None}
    assert not [name for name in imported if LAYER[str(name)] >= LAYER[package]]
    if package in KEPT_APART:
        assert imported <= KEPT_APART[package]
    if package not in LAUNCH_KERNELS:
        assert "carom.kernels" not in imported


def test_the_house_does_not_grow_higher() -> None:
    packages: dict[str, set[str]] = {package: set() for package in LAYER}
    for module, found in imports().items():
        if module != "carom":
            packages[str(package_of(module))] |= {str(package_of(name)) for name in found - {"carom"}}
    graph = {package: found - {package, "None"} for package, found in packages.items()}
    # What a package stands on, and so on down. When a floor has gone, it is to stay so.
    assert floors(graph) == MOST_FLOORS
    library = {name: found for name, found in graph.items() if name.startswith("carom.")}
    of_the_drop_in = {name for name, found in library.items() if "pybullet" in found}
    library = {name: found for name, found in library.items() if not (found | {name}) & of_the_drop_in}
    assert floors(library) == MOST_FLOORS_OF_THE_LIBRARY


def test_all_packages_of_the_wheel_have_layers() -> None:
    project = (SOURCE.parent / "pyproject.toml").read_text(encoding="utf-8")
    assert set(re.findall(r'^    "src/(\w+)",$', project, flags=re.MULTILINE)) == TOP_LEVEL


def test_no_modules_import_each_other_in_a_circle() -> None:
    handing_out_names = {"carom"}
    assert not circles({name: imports()[name] - handing_out_names for name in MODULES})


def test_only_known_modules_name_each_others_types_in_a_circle() -> None:
    with_types = {module: found for module, (_, found) in _imports_of_both_kinds().items()}
    found = circles_apart({name: found - {"carom"} for name, found in with_types.items()})
    known = {name: len(circle) for circle in found for name in circle if name in CIRCLES_OF_TYPES}
    assert not [circle for circle in found if circle.isdisjoint(CIRCLES_OF_TYPES)]
    # A circle that has become smaller is to stay so.
    assert known == CIRCLES_OF_TYPES


def test_circles_are_found() -> None:
    assert circles_apart({"a": {"b"}, "b": {"c"}, "c": {"b", "d"}, "d": {"e"}, "e": {"d"}}) == [
        {"b", "c"},
        {"d", "e"},
    ]
    assert floors({"a": {"b", "c"}, "b": {"c"}, "c": set(), "d": set()}) == 3
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}, "d": {"a"}}) == {"a", "b", "c", "d"}
    assert not circles({"a": {"b", "c"}, "b": {"c"}, "c": set()})


def test_imports_by_name_and_in_functions_are_seen() -> None:
    assert "carom.viewer.replay.recorder" in imports()["carom.world.face.looking"]
    assert "carom.world.world" in imports()["carom"]
    assert "carom.world.world" not in imports()["carom.scene.body"]


@each("folder", sorted({path.relative_to(SOURCE).parent for path in MODULES.values()}), ids=str)
def test_no_folder_has_more_files_than_one_takes_in(folder: Path) -> None:
    assert len(list((SOURCE / folder).glob("*.py"))) <= MAX_FILES_IN_A_FOLDER


TESTS = Path(__file__).parent


@each("folder", sorted({path.relative_to(TESTS).parent for path in TESTS.rglob("*.py")}), ids=str)
def test_no_folder_of_tests_has_more_files_than_one_takes_in(folder: Path) -> None:
    assert len(list((TESTS / folder).glob("*.py"))) <= MAX_FILES_IN_A_FOLDER
