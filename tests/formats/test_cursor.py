"""The reading cursor: what a reader has not taken is reported, with file, line, consequence and reason."""

from pathlib import Path

import pytest

from carom.files.xml_element import Element
from carom.files.xml_tree import parse_root
from carom.formats.reading.cursor import Cursor, layered
from carom.formats.reading.rules import Rule, Rules

FILE = Path("file.xml")
RULES = Rules(
    "XML",
    (
        Rule("a/b", "no b", "short"),
        Rule("root/a/b", "no b in a of the root", "long"),
        Rule("a@*", "no attributes", "any"),
        Rule("a@kept", "it is kept and not used", "kept", even_if_taken=True),
        Rule("*/light", "none", "looks"),
    ),
)


def traced(text: str) -> tuple[Cursor, Element]:
    cursor = Cursor(RULES)
    return cursor, cursor.trace(parse_root(text.encode(), FILE, "root"), FILE)


def told(cursor: Cursor) -> list[tuple[str, tuple[str, ...], int, str]]:
    return [(one.element, one.attributes, one.line, one.consequence) for one in cursor.ignored()]


def test_nothing_of_a_document_that_was_read_whole_is_reported():
    cursor, root = traced('<root xmlns:x="u"><a name="n"><b/></a></root>')
    a = root.first("a")
    assert a is not None
    assert a.attributes["name"] == "n"
    assert list(a.all("b"))
    assert told(cursor) == []


def test_what_was_not_taken_is_reported_at_its_outermost_element():
    cursor, _ = traced('<root version="1">\n<a x="1"><b/></a>\n<light/></root>')
    assert told(cursor) == [
        ("root", ("version",), 1, "it has no effect"),
        ("root/a", (), 2, "it has no effect"),
        ("root/light", (), 3, "none"),
    ]
    assert [one.matters for one in cursor.ignored()] == [True, True, False]


def test_the_longest_rule_counts():
    cursor, root = traced('<root><a x="1" y="2"><b/></a></root>')
    assert root.first("a")
    assert told(cursor) == [
        ("root/a", ("x", "y"), 1, "no attributes"),
        ("a/b", (), 1, "no b in a of the root"),
    ]


def test_a_rule_can_report_what_is_taken():
    cursor, root = traced('<root><a kept="1"/></root>')
    a = root.first("a")
    assert a is not None
    assert a.attributes.get("kept") == "1"
    assert told(cursor) == [("root/a", ("kept",), 1, "it is kept and not used")]


def test_going_through_children_takes_none_of_them():
    cursor, root = traced("<root><a/><light/></root>")
    for child in root.children:
        if child.tag == "light":
            child.note()
    assert told(cursor) == [("root/a", (), 1, "it has no effect")]


def test_a_second_element_of_a_kind_of_which_one_is_used_is_reported_as_such():
    cursor, root = traced("<root><a/>\n<a/></root>")
    assert root.first("a")
    assert told(cursor) == [("root/a", (), 2, "only another one of its kind counts")]


def test_equal_entries_are_counted():
    cursor, _ = traced("<root><a/>\n<a/>\n<a/></root>")
    (one,) = cursor.ignored()
    assert (one.count, one.line) == (3, 1)
    assert cursor.ignored().total == 3
    assert cursor.ignored().summary() == "3 root/a"


@pytest.mark.parametrize("name", ["mine", "below"])
def test_values_of_layers_are_followed_to_where_they_came_from(name):
    cursor, root = traced('<root><default below="1" mine="2"/><a mine="3"/></root>')
    default, a = root.children
    default.note()
    merged = layered(default.attributes, a.attributes)
    assert merged == {"below": "1", "mine": "3"}
    assert merged[name]
    left = {(one.element, one.attributes) for one in cursor.ignored()}
    if name == "mine":
        assert left == {("root/default", ("below", "mine"))}
    else:
        assert left == {("root/default", ("mine",)), ("root/a", ())}


def test_plain_attributes_are_layered_as_plain_ones():
    assert type(layered({"a": "1"}, {"b": "2"})) is dict


def test_a_reader_can_report_what_it_takes_and_does_not_use():
    cursor, root = traced("<root><a/></root>")
    a = root.first("a")
    assert a is not None
    cursor.leave_out(a, "lost", "because", attributes=("x",))
    (one,) = cursor.ignored()
    assert str(one) == "file.xml:1: root/a x: lost (because)"
    assert "root/a" in str(cursor.ignored())
