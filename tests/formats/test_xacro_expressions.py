"""Expressions of xacro: what they give, and that none reaches the system or takes long."""

from __future__ import annotations

import math
import re
from contextlib import suppress

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from carom.formats.xacro.expression import evaluate
from carom.formats.xacro.limits import Allowance, ExpressionError
from carom.formats.xacro.macro import Parameter, parse_parameters
from carom.formats.xacro.values import literal, truth

NAMES = {"a": 3, "s": "one two", "l": [1, 2, 3], "d": {"x": {"y": 4}}}


def value(text: str):
    return evaluate(text, NAMES, Allowance())


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("1 + 2 * 3", 7),
        (" a\n + 1", 4),
        ("-2 ** 2", -4),
        ("7 // 2, 7 % 4, 7 / 2", (3, 3, 3.5)),
        ("sin(pi / 2) + math.cos(0)", 2.0),
        ("radians(180)", math.pi),
        ("1 if a > 2 else 0", 1),
        ("1 < a <= 3 and not False", True),
        ("'' or 'x'", "x"),
        ("l[1] + l[-1]", 5),
        ("l[:2]", [1, 2]),
        ("d['x']['y'] + d.x.y", 8),
        ("s.split()[1].upper()", "TWO"),
        ("[float(i) * 2 for i in '1 2'.split() if i != '1']", [4.0]),
        ("sum(x * y for x, y in zip(l, l))", 14),
        ("'%.2f' % 1.234", "1.23"),
        ("max(l) + min(1, 2) + abs(-1) + len(s)", 12),
        ("'two' in s", True),
        ("'-'.join(s.split()).replace('o', '0')", "0ne-tw0"),
        ("list(range(3))", [0, 1, 2]),
        ("isinstance(a, int)", True),
        ("xs if False else 2", 2),
    ],
)
def test_values(text, expected):
    assert value(text) == expected


@pytest.mark.parametrize(
    ("text", "complaint"),
    [
        ("__import__('os')", "'__import__' is not defined"),
        ("open('x')", "'open' is not defined"),
        ("().__class__", "no attribute '__class__'"),
        ("s.format", "no attribute 'format'"),
        ("sin.__self__", "no attribute '__self__'"),
        ("math.__loader__", "is not defined"),
        ("lambda: 1", "Lambda is not accepted"),
        ("(x := 1)", "NamedExpr is not accepted"),
        ("f'{a}'", "JoinedStr is not accepted"),
        ("9 ** 9 ** 9", "bits is refused"),
        ("1 << 10 ** 9", "bits is refused"),
        ("10 ** 400", "bits is refused"),
        ("'x' * 10 ** 9", "longer than"),
        ("[0] * 10 ** 9", "longer than"),
        ("range(10 ** 9)", "longer than"),
        ("'%999999999d' % 1", "at most two digits"),
        ("'%*d' % (9, 1)", "at most two digits"),
        ("'x'.zfill(10 ** 9)", "pads to at most"),
        ("('x' * 10 ** 6).replace('x', 'y' * 10 ** 6)", "longer than"),
        ("range(10 ** 6)", "longer than"),
        ("[0 for i in range(10 ** 4) for j in range(10 ** 4)]", "operations"),
        ("(-8) ** 0.5", "no real number"),
        ("-" * 500 + "1", "nested deeper"),
        ("(" * 3000 + "1", "is no expression"),
        ("1 +", "is no expression"),
        ("'x' * 20000 + 'y' + " + "'z'" * 4000, "longer than"),
        ("", "is empty"),
        ("1 / 0", "fails: division by zero"),
        ("d['z']", "there is no 'z'; there are x"),
        ("pie", "did you mean 'pi'"),
        ("a()", "is no function"),
        ("sorted(l, key=len)", "not accepted"),
        ("b'x'", "not accepted"),
    ],
)
def test_what_is_refused(text, complaint):
    with pytest.raises(ExpressionError, match=re.escape(complaint)):
        value(text)


def test_lists_that_hold_each_other_cannot_grow_without_bound():
    names: dict[str, object] = {"x": [1] * 10}
    budget = Allowance()
    with pytest.raises(ExpressionError):
        for _ in range(60):
            names["x"] = evaluate("[x, x]", names, budget)


_atoms = st.sampled_from(["1", "2.5", "a", "s", "l", "'x'", "d", "pi", "9", "True", "None", "0"])
_operators = st.sampled_from(["+", "-", "*", "/", "**", "%", "<<", "//", "<", "==", "in", "and"])
_functions = st.sampled_from(["len", "str", "list", "sin", "sum", "int", "-", "not ", "range", "max"])
_texts = st.recursive(
    _atoms,
    lambda inner: st.one_of(
        st.tuples(inner, _operators, inner)
        .map(lambda it: f"({it[0]} {it[1]} {it[2]})"),
        st.tuples(_functions, inner)
        .map(lambda it: f"{it[0]}({it[1]})"),
        st.tuples(inner, inner).map(lambda it: f"{it[0]}[{it[1]}]"),
        st.tuples(inner, inner).map(lambda it: f"[{it[0]} for x in {it[1]}]"),
    ),
    max_leaves=20,
)  # fmt: skip


@settings(max_examples=300, deadline=None)
@given(_texts)
def test_any_expression_gives_a_plain_value_or_a_stated_error(text):
    try:
        result = value(text)
    except ExpressionError:
        return
    assert isinstance(result, (bool, int, float, str, list, tuple, dict, type(None))) or callable(result)


@settings(max_examples=200, deadline=None)
@given(st.text(max_size=60))
def test_any_text_gives_a_value_or_a_stated_error(text):
    for work in (value, parse_parameters):
        with suppress(ExpressionError):
            work(text)


@given(st.one_of(st.integers(-(10**9), 10**9), st.floats(allow_nan=False)))
def test_numbers_survive_as_texts(number):
    assert literal(str(number)) == number
    assert truth(str(number)) is bool(number)


def test_literals():
    texts = ["1", "1.5", "true", "False", "1_0", "'1'", "", "x", " 1 "]
    assert [literal(text) for text in texts] == [1, 1.5, True, False, "1_0", "1", "", "x", 1]


def test_parameters():
    assert parse_parameters("a b:=1 c:=^ d:=^|2 e:='x y' f:=${1 + 2}\n *g **h") == (
        Parameter("a"),
        Parameter("b", 0, "1"),
        Parameter("c", 0, None, True),
        Parameter("d", 0, "2", True),
        Parameter("e", 0, "'x y'"),
        Parameter("f", 0, "${1 + 2}"),
        Parameter("g", 1),
        Parameter("h", 2),
    )
    for text in ("a a", "*a:=1", ":=1"):
        with pytest.raises(ExpressionError):
            parse_parameters(text)
