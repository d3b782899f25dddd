"""What decides how bodies move takes no maths from the platform, where it differs in the last bit."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest
from tests.each import each

SOURCE = Path(__file__).parents[2] / "src"
ROOMS = (
    *(f"carom/{room}" for room in ("algorithms", "description", "engine", "formats", "geometry", "model")),
    *(f"carom/{room}" for room in ("queries", "scene", "soft", "world", "worlds")),
    *(f"pybullet/{room}" for room in ("_bodies", "_contacts", "_joints", "_loading", "_maths", "_shapes")),
)
FUNCTIONS = {"sin", "cos", "tan", "asin", "acos", "atan", "atan2", "exp", "log", "pow", "cbrt"}
ARRAY_FUNCTIONS = FUNCTIONS | {
    "arcsin",
    "arccos",
    "arctan",
    "arctan2",
    "dot",
    "einsum",
    "matmul",
    "inner",
    "vdot",
}
# Rounding decides nothing there: is a wheel round within 5 percent, where is a soft body drawn? And usd-core
# reads stages of USD by the platform's maths anyway.
TOLERANT = ("carom/geometry/rolling.py", "carom/soft/skin.py", "carom/formats/usd/")


def of_the_platform(tree: ast.AST) -> Iterator[str]:
    """Names of maths that comes from a platform's C library, or from its BLAS."""
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.module == "math":
            yield from (alias.name for alias in node.names if alias.name in FUNCTIONS)
        elif isinstance(node, ast.BinOp) and isinstance(node.op, ast.MatMult):
            yield f"@ in line {node.lineno}"
        elif isinstance(node, ast.Call):
            name = ast.unparse(node.func)
            module, _, function = name.rpartition(".")
            # Along an axis NumPy adds squares itself; the length of one vector it leaves to the BLAS.
            is_row_lengths = name == "np.linalg.norm" and any(word.arg == "axis" for word in node.keywords)
            if (module == "np.linalg" and not is_row_lengths) or (
                module in ("np", "math") and function in ARRAY_FUNCTIONS
            ):
                yield f"{name} in line {node.lineno}"


@pytest.mark.parametrize(
    "code", ["a @ b", "np.linalg.inv(a)", "np.linalg.norm(a)", "np.sin(a)", "math.sin(a)"]
)
def test_maths_of_the_platform_is_found(code: str):
    assert list(of_the_platform(ast.parse(code)))


@each("room", ROOMS)
def test_rooms_take_their_maths_from_the_native_library(room: str):
    found = {
        str(path.relative_to(SOURCE)): names
        for path in sorted((SOURCE / room).rglob("*.py"))
        if not path.relative_to(SOURCE).as_posix().startswith(TOLERANT)
        and (names := list(of_the_platform(ast.parse(path.read_text("utf-8")))))
    }
    assert not found
