"""The messages between viewer and pages are declared once; both sides handle those, and no others."""

import ast
import json
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from carom.viewer.protocol import from_page, to_page
from carom.viewer.protocol.message import REMOVAL
from carom.viewer.protocol.page_module import CONSTANTS, TYPES, constants, types

VIEWER = Path(__file__).parents[3] / "src" / "carom" / "viewer"
PAGE = {
    path: path.read_text(encoding="utf-8") for path in (VIEWER / "page").rglob("*.js") if path != CONSTANTS
}
A_TYPE = re.compile(r"""(?:\bsend\(\{ type: |\b(?:header|message)\.type [!=]== )"([a-z ]+)\"""")


def named_in_page(direction: str, before: str = "") -> set[str]:
    """Constants of a direction that the page's modules name."""
    return {name for text in PAGE.values() for name in re.findall(rf"{before}{direction}\.([A-Z_]+)\b", text)}


def named_in_viewer() -> Iterator[str]:
    """Constants of `to_page` that the viewer names."""
    for path in VIEWER.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Attribute) and ast.unparse(node.value) == "to_page":
                yield node.attr


def test_what_the_page_has_of_the_messages_is_up_to_date():
    cure = "run `python -m carom.viewer.protocol`"
    assert CONSTANTS.read_text(encoding="utf-8") == constants(), cure
    assert TYPES.read_text(encoding="utf-8") == types(), cure


@pytest.mark.parametrize("module", [to_page, from_page])
def test_a_constant_has_the_name_of_its_type(module):
    assert {name.lower().replace("_", " "): name for name in module.ALL} == {
        message.type: name for name, message in module.ALL.items()
    }


def test_what_the_viewer_says_is_declared_and_all_of_it_is_said():
    assert set(named_in_viewer()) & set(to_page.ALL) == {
        name for name, message in to_page.ALL.items() if message not in to_page.MADE_BY_PAGE
    }


def test_no_header_is_made_by_hand():
    made = [
        f"{path.name}: {ast.unparse(node)}"
        for path in VIEWER.rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Dict)
        and any(key is not None and ast.unparse(key) == "'type'" for key in node.keys)
    ]
    assert made == ["message.py: {'type': self.type, **fields}"]


def test_the_page_takes_every_message_and_sends_every_one_that_is_declared():
    answers = next(text for path, text in PAGE.items() if path.name == "app.js")
    answered = set(re.findall(r"^ +\[ToPage\.([A-Z_]+)\]: \(", answers, re.MULTILINE))
    elsewhere = {"PAST", "ENDING"}
    assert answered | elsewhere == set(to_page.ALL)
    assert not answered & elsewhere
    assert elsewhere <= named_in_page("ToPage", r"header\.type === ")
    assert named_in_page("FromPage", "type: ") == set(from_page.ALL)


def test_the_page_has_no_types_of_messages_as_texts():
    assert {path.name: found for path, text in PAGE.items() if (found := A_TYPE.findall(text))} == {}


def test_the_viewer_takes_every_message_of_a_page(viewer):
    assert set(viewer._answers) == set(from_page.ALL.values())


def test_a_field_that_is_not_declared_cannot_be_said():
    assert to_page.PAUSE(paused=True) == {"type": "pause", "paused": True}
    with pytest.raises(TypeError, match=r"'pause' message has the fields paused: unknown are \['pausd'\]"):
        to_page.PAUSE(pausd=True)
    with pytest.raises(TypeError, match=r"missing \['paused'\]"):
        to_page.PAUSE()
    with pytest.raises(ValueError, match="'time' of a 'mark' message has to be number, not '4 s'"):
        to_page.checked(to_page.MARK(mark=1, time="4 s"))


@pytest.mark.parametrize(
    ("told", "problem"),
    [
        ('{"type": "puase", "paused": true}', "no message 'puase' from a page"),
        ('{"type": "pause"}', "'pause' message needs the field 'paused'"),
        ('{"type": "pause", "paused": 1}', "'paused' of a 'pause' message has to be boolean, not '1'"),
        ('{"type": "mark", "at": 1}', None),
        ('{"type": "drive", "body": 0, "joint": 1, "target": 2}', None),
        ('{"type": "drive", "body": 0, "joint": true, "target": 2}', "'joint' of a 'drive' message"),
        ('{"type": "drive", "body": 0, "joint": 1, "target": 2, "mode": "force"}', '"position" | "velocity"'),
        ('{"type": "turn", "body": 0, "link": 1, "orientation": [0, 0, 1]}', "'orientation' of a 'turn'"),
        ('{"type": "want", "joints": "all", "links": [[0, -1]]}', None),
        ('{"type": "want", "joints": [0.5]}', "'joints' of a 'want' message"),
        ('{"type": "speed", "speed": null}', None),
        ('{"type": "gamepads", "gamepads": [{"name": "a", "axes": [], "buttons": [1]}]}', "'gamepads' of a"),
        (
            '{"type": "gamepads", "gamepads": [{"name": "a", "axes": [], "buttons": [1], "standard": true}]}',
            None,
        ),
    ],
)
def test_a_message_of_a_page_is_checked(told: str, problem: str | None):
    if problem is None:
        from_page.checked(json.loads(told))
    else:
        with pytest.raises(ValueError, match=re.escape(problem)):
            from_page.checked(json.loads(told))


def test_what_is_kept_can_be_removed():
    for message in to_page.ALL.values():
        if message.kind is not None:
            removal = to_page.declaration({"type": REMOVAL + message.kind})
            assert removal.kind == message.kind
            assert set(removal.fields) == ({message.kept} - {""})
