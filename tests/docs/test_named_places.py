"""Files and functions that pages for developers name exist, and their lists of places are complete."""

import ast
import re
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src"
PAGES = (
    *("CONTRIBUTING.md", "docs/architecture.md", "docs/solver.md"),
    *sorted(f"docs/architecture/{page.name}" for page in (ROOT / "docs" / "architecture").glob("*.md")),
)
WINGS = ("physics", "face", "window", "lab", "drop-in")
# What a page may have, so that it is read: that which leads to the others, and each of these (ten minutes).
MOST_WORDS = {"docs/architecture.md": 3_500}
MOST_WORDS_OF_A_PAGE = 2_500
# Packages of one module.
SINGLE = {"carom.camera", "carom.file_bodies", "carom.jax", "carom.pose", "carom.torch"}
MAX_PLACES = 12

JOINTS = {"REVOLUTE", "CONTINUOUS", "PRISMATIC", "SPHERICAL", "PLANAR", "SCREW"}
KINDS_OF_SHAPE = {"SPHERE", "BOX", "CAPSULE", "CYLINDER", "PLANE", "HULL", "TRIANGLES", "HEIGHTFIELD"}
SHAPES = {"Sphere", "Box", "Capsule", "Cylinder", "Plane", "RoundedBox", "Ellipsoid"}
FILES_OF_SHAPES = {
    f"src/carom/description/shapes/{name}.py"
    for name in ("sphere", "box", "capsule", "cylinder", "plane", "rounded_box", "ellipsoid")
}
PRIMITIVES = {f"GEOM_{name.upper()}" for name in SHAPES}
ACTUATORS = {
    "GeneralActuator",
    "Motor",
    "PositionActuator",
    "VelocityActuator",
    "IntegratedVelocityActuator",
    "Damper",
    "Cylinder",
    "MuscleSpec",
}
# Where parameters of functions of the drop-in are named.
OF_PARAMETERS = ("src/carom", "src/pybullet", "tests/pybullet/calls", "tests/surface/calls", "tools/differ")
# A kind of user constraint has the name of a kind of joint.
NOT_JOINTS = {"src/pybullet/_joints/constraints.py"}
# Modules that make one certain shape: the balls and boxes around meshes, and cables that are rounded.
MAKE_ONE_SHAPE = {
    "src/carom/formats/mjcf/compiled/flexes/rigid.py",
    "src/carom/formats/sdf/automatic_inertia.py",
    "src/carom/formats/sdf/written_geometry.py",
    "src/carom/formats/usd/geometry.py",
    "src/carom/formats/usd/mesh.py",
}


def section(title: str) -> str:
    """A section of CONTRIBUTING.md, without those below it."""
    page = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    found = re.search(rf"^#+ {re.escape(title)}\n(.*?)(?=^#|\Z)", page, re.MULTILINE | re.DOTALL)
    assert found is not None, title
    return found[1]


def places(*titles: str) -> list[str]:
    """What the items of lists in sections of CONTRIBUTING.md begin with."""
    return [place for title in titles for place in re.findall(r"^- `([^`]+)`", section(title), re.MULTILINE)]


@cache
def names_in(path: Path) -> frozenset[tuple[str, str]]:
    """Members of enums that a module names, and what it imports: (enum or module, name)."""
    return frozenset(found_names(path))


def found_names(path: Path) -> Iterator[tuple[str, str]]:
    """As `names_in`, one by one."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
            yield node.value.id, node.attr
        elif isinstance(node, ast.ImportFrom) and node.module is not None:
            yield from ((node.module, alias.name) for alias in node.names)
        elif isinstance(node, ast.Assign) and path.name == "constants.py":
            yield from (("constants", name.id) for name in node.targets if isinstance(name, ast.Name))
        elif isinstance(node, ast.ClassDef) and path.name in ("codes.py", "joint.py"):
            members = (name for item in node.body if isinstance(item, ast.Assign) for name in item.targets)
            yield from ((node.name, name.id) for name in members if isinstance(name, ast.Name))
        elif isinstance(node, ast.ClassDef) and path.parent == SOURCE / "carom" / "description" / "shapes":
            yield "carom.description", node.name


def singles_out_joints(owner: str, name: str) -> bool:
    """Whether a name is that of a kind of joint that moves."""
    if owner in ("JointCode", "JointType", "carom.layouts.codes"):
        return name in JOINTS
    return owner in ("constants", "pybullet._calls.constants") and name.removeprefix("JOINT_") in JOINTS


def singles_out_shapes(owner: str, name: str) -> bool:
    """Whether a name is that of a primitive shape."""
    if (
        owner in ("description", "carom.description", "carom.description.geometry")
        or "description.shapes." in owner
    ):
        return name in SHAPES
    return owner in ("constants", "pybullet._calls.constants") and name in PRIMITIVES


def singles_out_kinds_of_shape(owner: str, name: str) -> bool:
    """Whether a name is that of a kind of shape in kernels."""
    return owner in ("ShapeKind", "carom.layouts.codes") and name in KINDS_OF_SHAPE


def singles_out_sensors(owner: str, name: str) -> bool:
    """Whether a name is that of a kind of sensor."""
    return (owner == "SensorKind" and name.isupper()) or (
        owner == "carom.description.sensors" and name != "Sensor"
    )


def singles_out_actuators(owner: str, name: str) -> bool:
    """Whether a name is that of a kind of actuator, or of the laws that its activation follows."""
    if owner == "carom.description.actuator":
        return name in ACTUATORS
    return owner == "ActivationDynamics"


def files_with(pattern: str, *folders: str) -> set[str]:
    """The modules in some folders whose text has a match."""
    return {
        path.relative_to(ROOT).as_posix()
        for folder in folders
        for path in (ROOT / folder).rglob("*.py")
        if re.search(pattern, path.read_text(encoding="utf-8"))
    }


def modules_that(single_out: Callable[[str, str], bool]) -> set[str]:
    """The modules of the simulator and the drop-in that name one of some kinds."""
    return {
        path.relative_to(ROOT).as_posix()
        for package in ("carom", "pybullet")
        for path in (SOURCE / package).rglob("*.py")
        if any(single_out(owner, name) for owner, name in names_in(path))
    }


@pytest.mark.parametrize(
    ("single_out", "titles", "others"),
    [
        (
            singles_out_joints,
            ("Adding a joint type",),
            NOT_JOINTS,
        ),
        (
            singles_out_shapes,
            ("Adding a shape",),
            MAKE_ONE_SHAPE | FILES_OF_SHAPES - {"src/carom/description/shapes/box.py"},
        ),
        (singles_out_kinds_of_shape, ("Kinds of shape in the engine",), FILES_OF_SHAPES),
        (
            singles_out_sensors,
            (
                "Adding a sensor",
                "Sensors between shapes",
                "Sensors of steps and of time",
                "Sensors in SDF files",
            ),
            set[str](),
        ),
        (singles_out_actuators, ("Adding an actuator",), set[str]()),
    ],
)
def test_lists_of_places_are_what_the_code_says(
    single_out: Callable[[str, str], bool], titles: tuple[str, ...], others: set[str]
):
    assert modules_that(single_out) - others == set(places(*titles))


@pytest.mark.parametrize(
    ("title", "pattern", "folders"),
    [
        ("Adding an MJCF element", '"equality"', ("src/carom/formats/mjcf",)),
        (
            "Adding a parameter of the API",
            r"\brestitution(VelocityThreshold|_velocity_threshold)\b",
            OF_PARAMETERS,
        ),
        ("Parameters of a link", r"\banisotropic(Friction|_friction)\b", OF_PARAMETERS),
    ],
)
def test_places_of_an_example_are_where_it_is_named(title: str, pattern: str, folders: tuple[str, ...]):
    assert files_with(pattern, *folders) == set(places(title))


@pytest.mark.parametrize(
    "title",
    [
        "Adding a joint type",
        "Adding a shape",
        "Adding a sensor",
        "Adding an actuator",
        "Adding an MJCF element",
        "Adding a parameter of the API",
        "Parameters of a link",
    ],
)
def test_a_new_kind_needs_few_places(title: str):
    assert 0 < len(places(title)) <= MAX_PLACES


@pytest.mark.parametrize("page", PAGES)
def test_files_that_pages_name_exist(page: str):
    files = {
        path.relative_to(ROOT).as_posix()
        for folder in ("src", "tests", "tools", "docs", "benchmarks")
        for path in (ROOT / folder).rglob("*")
    }
    named = re.findall(r"`([\w./-]+\.(?:py|cpp|js|md|json)|(?:src|tests)/[\w./-]+)`", text_of(page))
    lost = [name for name in named if not any(f"/{path}".endswith(f"/{name.rstrip('/')}") for path in files)]
    assert not lost


@pytest.mark.parametrize("page", PAGES)
def test_modules_that_pages_name_exist(page: str):
    named = re.findall(r"`((?:carom|pybullet)(?:\.\w+)+)`", text_of(page))
    assert not [name for name in named if not is_there(name)]


@pytest.mark.parametrize(
    "page", ["solver", "architecture/rows", "architecture/newton", "architecture/bullet"]
)
def test_functions_that_pages_about_the_solver_name_exist(page: str):
    words = set(re.findall(r"\w+", "".join(path.read_text("utf-8") for path in SOURCE.rglob("*.py"))))
    named = re.findall(r"`([A-Za-z_.]+)(?:\[\w+\])?`", text_of(f"docs/{page}.md"))
    parts = {part for name in named for part in name.split(".") if "/" not in part}
    assert parts <= words


def test_every_package_is_in_one_wing_of_the_architecture():
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    listed = re.findall(r"^(carom\.\w+)", page, re.MULTILINE) + re.findall(
        r"^carom\.\w+ .*; (carom\.\w+),", page, re.MULTILINE
    )
    folders = [path for path in (SOURCE / "carom").iterdir() if (path / "__init__.py").is_file()]
    assert sorted(listed) == sorted(
        {f"carom.{path.name}" for path in folders} - {"carom.cli", "carom.examples"} | SINGLE
    )


@pytest.mark.parametrize("page", [page for page in PAGES if page.startswith("docs/architecture")])
def test_pages_about_the_architecture_are_read_in_ten_minutes(page: str):
    words = (ROOT / page).read_text(encoding="utf-8").split()
    assert len(words) <= MOST_WORDS.get(page, MOST_WORDS_OF_A_PAGE)


def test_each_wing_has_a_page_and_each_question_names_what_is_there():
    page = (ROOT / "docs" / "architecture.md").read_text(encoding="utf-8")
    assert set(WINGS) <= set(re.findall(r"\(architecture/([\w-]+)\.md\)", page))
    answers = re.findall(r"^\| [^|]+\? \| (.+) \|$", page, re.MULTILINE)
    assert len(answers) >= 20
    for answer in answers:
        files = re.findall(r"`([\w/]+\.(?:py|cpp))`", answer)
        folders = (SOURCE / "carom", SOURCE)
        found = [folder / path for path in files for folder in folders if (folder / path).is_file()]
        assert len(found) == len(files) > 0, answer
        text = "".join(file.read_text(encoding="utf-8") for file in found)
        names = re.findall(r"`(\w+)`", answer)
        assert not [name for name in names if not re.search(rf"\b{name}\b", text)], answer


def text_of(page: str) -> str:
    """A page without its blocks of code."""
    return re.sub(
        r"^```.*?^```", "", (ROOT / page).read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL
    )


def is_there(name: str) -> bool:
    """Whether a dotted name is a module, or something that a module has or imports."""
    parts = name.split(".")
    for length in range(len(parts), 0, -1):
        base = SOURCE.joinpath(*parts[:length])
        for module in (base.with_suffix(".py"), base / "__init__.py"):
            if module.is_file():
                text = module.read_text(encoding="utf-8")
                return all(re.search(rf"\b{part}\b", text) for part in parts[length:][:1])
    return False
