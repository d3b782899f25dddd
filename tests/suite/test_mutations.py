"""The list of changes that `tools/mutate.py` makes stays true, and long enough."""

import ast
from pathlib import Path

import pytest
from tests.each import each
from tools.mutate import ROOT, Mutation, read_mutations

MUTATIONS = read_mutations()
FEWEST = 60


@each("mutation", MUTATIONS, ids=str)
def test_a_mutation_changes_what_is_there_once(mutation: Mutation) -> None:
    source = (ROOT / mutation.file).read_text(encoding="utf-8")
    mutated = mutation.mutated(source)
    assert mutated != source
    if mutation.file.endswith(".py"):
        ast.parse(mutated)
    assert mutation.tests
    for test in mutation.tests:
        assert Path(ROOT, test.partition("::")[0]).exists(), test


def test_there_are_enough_mutations_and_no_two_are_the_same() -> None:
    assert len(set(MUTATIONS)) == len(MUTATIONS) >= FEWEST
    files = {mutation.file for mutation in MUTATIONS}
    for part in ("src/carom/kernels/", "src/pybullet/", "src/carom/formats/"):
        assert any(file.startswith(part) for file in files), part


def test_a_text_that_is_not_there_once_is_refused() -> None:
    mutation = Mutation("any.py", "a < b", "a <= b", ("tests",))
    assert mutation.mutated("if a < b:") == "if a <= b:"
    for source in ("if b > a:", "if a < b < c or a < b:"):
        with pytest.raises(ValueError, match="has 'a < b'"):
            mutation.mutated(source)
