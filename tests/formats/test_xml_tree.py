"""Reading XML in bounds: well-formed, sloppy and hostile."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.errors import DescriptionError
from carom.files.budget import Budget
from carom.files.xml_element import MAX_DEPTH, Element, TreeBuilder
from carom.files.xml_tolerant import read_tolerantly
from carom.files.xml_tree import parse_xml

FILE = Path("some.xml")


def parse(text: str) -> list[Element]:
    return parse_xml(text.encode("utf-8"), FILE)


def tolerant(text: str) -> list[Element]:
    builder = TreeBuilder(FILE)
    read_tolerantly(text, builder)
    return builder.roots


def plain(element: Element) -> tuple:
    children = [plain(child) for child in element.children]
    return element.tag, element.attributes, element.line, element.text, children


def refusal(text: str | bytes) -> DescriptionError:
    with pytest.raises(DescriptionError) as raised:
        parse_xml(text.encode("utf-8") if isinstance(text, str) else text, FILE)
    return raised.value


def test_elements_have_names_attributes_lines_and_text() -> None:
    (root,) = parse('<?xml version="1.0"?>\n<a x="1"\n   y="&lt;2">one\n<b/>two<c>three</c>\n</a>')
    assert (root.tag, root.attributes, root.line, root.text) == ("a", {"x": "1", "y": "<2"}, 2, "one\n")
    assert [child.tag for child in root.children] == ["b", "c"]
    assert [child.line for child in root.children] == [4, 4]
    assert [child.text for child in root.children] == ["", "three"]
    assert root.first("c") is root.children[1]
    assert root.first("d") is None
    assert [child.tag for child in root.all("b")] == ["b"]
    assert root.path_to(root.children[1]) == [root, root.children[1]]


@pytest.mark.parametrize(
    ("text", "name"),
    [
        ('\n <?xml version="1.0"?><a name="x"/>', "x"),
        ('words before <a name="x"/>', "x"),
        ('<a name="x"/><b/>', "x"),
        ('<a name="this & that"/>', "this & that"),
        ('<a name="x < y"/>', "x < y"),
        ('<a name="&unknown; &#65;&#x42;&#0;"/>', "&unknown; AB&#0;"),
        ('<a p="1"name="x"/>', "x"),
        ('<a name="x"><!-- two -- hyphens --></a>', "x"),
        ('<!DOCTYPE a><a name="x"/>', "x"),
        ("<a name = 'x' ></a >", "x"),
        ('<a:b name="x"/>', "x"),
    ],
)
def test_sloppy_documents_are_read(text: str, name: str) -> None:
    assert parse(text)[0].attributes["name"] == name


@pytest.mark.parametrize(
    "rest", ["</a>", "</b>", '</a x="1">', "</a><c/>", "</a> words < &", "</a><c x=1><d></e>"]
)
def test_an_end_tag_too_many_ends_the_document(rest: str) -> None:
    assert [plain(root) for root in parse(f"<a><b/></a>\n{rest}")] == [plain(parse("<a><b/></a>")[0])]


def test_what_is_not_utf8_is_latin_1() -> None:
    (root,) = parse_xml(b'<a name="caf\xe9"/>', FILE)
    assert root.attributes["name"] == "café"


def test_a_declared_encoding_is_not_applied_to_utf8() -> None:
    (root,) = parse_xml('<?xml version="1.0" encoding="iso-8859-1"?><a name="é"/>'.encode(), FILE)
    assert root.attributes["name"] == "é"


def test_a_byte_order_mark_is_skipped() -> None:
    (root,) = parse_xml(b"\xef\xbb\xbf<a/>", FILE)
    assert root.tag == "a"


def test_a_nul_character_is_white_space() -> None:
    (root,) = parse_xml(b"<a>\n<b/>\0<c\0/>\n</a>", FILE)
    assert [child.tag for child in root.children] == ["b", "c"]


@pytest.mark.parametrize(
    ("text", "line", "words"),
    [
        ("<a>\n<b>\n</a>", 3, "</a> does not match <b> on line 2"),
        ("<a>\n<b>\n</b>", 1, "<a> is never closed"),
        ("<!-- c -->\n</b><a/>", 2, "without a start tag"),
        ("<a/>\n</b", 2, "without a closing"),
        ("<a\n x=1/>", 2, 'name="value"'),
        ("<a\n x='1' x='2'/>", 2, "twice"),
        ("<a/>\nrest", 2, "after the last element"),
        ("<a>\n<!-- open", 2, "without a closing"),
        ("<a>\n< 1/></a>", 2, "without the name"),
        ("<!-- c -->\n<?xml version='1.0'?><a/>", 2, "before everything else"),
        ("<a>\n&bad\n<b x='1", 3, "name="),
    ],
)
def test_broken_documents_are_refused_with_line_and_reason(text: str, line: int, words: str) -> None:
    error = refusal(text)
    assert error.line == line
    assert words in error.reason
    assert str(error).startswith(f"some.xml:{line}: ")


@pytest.mark.parametrize(
    "text",
    [
        '<!DOCTYPE a [<!ENTITY x "y">]><a>&x;</a>',
        '<!DOCTYPE a [\n<!ENTITY l "lol"><!ENTITY m "&l;&l;&l;&l;&l;">]><a>&m;</a>',
        '<!DOCTYPE a SYSTEM "file:///etc/passwd"><a/>',
        '<!DOCTYPE a PUBLIC "x" "http://localhost/x.dtd"><a/>',
        '<!DOCTYPE a [<!ENTITY x SYSTEM "file:///etc/passwd">]><a>&x;</a>',
        # The same where expat has given up already, and the tolerant reader sees them.
        'words <!DOCTYPE a [<!ENTITY x "y">]><a>&x;</a>',
        'words <!DOCTYPE a SYSTEM "file:///etc/passwd"><a/>',
        'words <!ENTITY x "y"><a>&x;</a>',
    ],
)
def test_entities_and_external_references_are_refused(text: str) -> None:
    assert "are not accepted" in refusal(text).reason


def test_empty_documents_are_refused() -> None:
    assert "empty" in refusal(b"  \n").reason


@pytest.mark.parametrize("prefix", ["", "sloppy "])
def test_depth_is_bounded(prefix: str) -> None:
    assert parse(prefix + "<a>" * MAX_DEPTH + "</a>" * MAX_DEPTH)
    assert "nested deeper" in refusal(prefix + "<a>" * (MAX_DEPTH + 1) + "</a>" * (MAX_DEPTH + 1)).reason
    assert "nested deeper" in refusal(prefix + "<a>" * 100_000).reason


def test_the_number_of_elements_is_bounded() -> None:
    assert "more than" in refusal("<a>" + "<b/>" * Budget().elements + "</a>").reason


_NAMES = st.text("abcxyz", min_size=1, max_size=4)
_TEXTS = st.text("ab <>&\"'\n.01é", max_size=8)


@st.composite
def _documents(draw: st.DrawFn, depth: int = 3) -> str:
    from xml.sax.saxutils import escape, quoteattr

    tag = draw(_NAMES)
    # White space in attributes is kept by one reader and normalised by the other.
    attributes = draw(st.dictionaries(_NAMES, _TEXTS.map(lambda text: text.replace("\n", " ")), max_size=3))
    opened = tag + "".join(f" {key}={quoteattr(value)}" for key, value in attributes.items())
    children = draw(st.lists(_documents(depth - 1), max_size=3)) if depth else []
    return f"<{opened}>{escape(draw(_TEXTS))}{''.join(children)}\n</{tag}>"


@given(_documents())
def test_both_readers_agree_on_well_formed_documents(text: str) -> None:
    ours, theirs = tolerant(text)[0], parse(text)[0]

    def strip(value: tuple) -> tuple:
        tag, attributes, line, words, children = value
        return tag, attributes, line, words.strip(), [strip(child) for child in children]

    assert strip(plain(ours)) == strip(plain(theirs))
