"""What the drop-in's documentation says of each function: complete, and its examples run."""

import doctest
import inspect
import re
import runpy
from pathlib import Path
from typing import Any

import pytest
from tests.each import each

GENERATOR = runpy.run_path(str(Path(__file__).parents[3] / "tools" / "docs" / "drop_in.py"))
FUNCTIONS: dict[str, Any] = GENERATOR["functions"]()
# They answer whatever happens.
NEVER_RAISE = {"getAPIVersion", "getConnectionInfo", "isConnected", "isNumpyEnabled"}
ALWAYS_RAISE: set[str] = set()


@each("name", FUNCTIONS)
def test_arguments_results_and_errors_are_documented(name: str) -> None:
    function = FUNCTIONS[name].__self__
    text = inspect.getdoc(function) or ""
    first, _, rest = text.partition("\n")
    assert first.endswith((".", "?")), "a sentence that stands alone"
    documented = re.findall(r"^    [*]*(\w+)(?:, \w+)*: ", rest, re.MULTILINE)
    for parameter in inspect.signature(FUNCTIONS[name]).parameters:
        assert parameter in documented, f"{parameter} under Args"
    returns = inspect.signature(function).return_annotation
    if returns not in ("None", "NoReturn", None) and name not in ALWAYS_RAISE:
        assert "\nReturns:\n" in text
    assert ("\nRaises:\n" in text) != (name in NEVER_RAISE)
    assert "\nExamples:\n    >>> " in text


@pytest.mark.parametrize("name", FUNCTIONS)
def test_examples_are_true(name: str, tmp_path: Path) -> None:
    world: dict[str, Any] = {"folder": tmp_path.as_posix()}
    exec(GENERATOR["EXAMPLE_WORLD"], world)
    example = doctest.DocTestParser().get_doctest(
        inspect.getdoc(FUNCTIONS[name].__self__) or "", world, name, None, 0
    )
    assert example.examples
    problems: list[str] = []
    doctest.DocTestRunner(optionflags=doctest.ELLIPSIS).run(example, out=problems.append)
    assert problems == []


def test_nothing_is_said_of_constants_that_do_not_exist() -> None:
    names = {name for group in GENERATOR["constants"]().values() for name in group}
    assert len(names) == 167
    assert GENERATOR["WITHOUT_EFFECT"].keys() <= names
