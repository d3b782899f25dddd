"""Keys and mouse events as scripts see them."""

from hypothesis import given
from hypothesis import strategies as st
from tests.each import each

import pybullet as p
from carom.viewer.input.keys import Keyboard, key_code
from carom.viewer.input.mouse import Mouse

DOWN, TRIGGERED, RELEASED = p.KEY_IS_DOWN, p.KEY_WAS_TRIGGERED, p.KEY_WAS_RELEASED


@each(
    ("key", "place", "code"),
    [
        ("a", "KeyA", ord("a")),
        ("A", "KeyA", ord("a")),
        ("!", "Digit1", ord("1")),
        (" ", "Space", p.B3G_SPACE),
        ("Escape", "Escape", 27),
        ("Enter", "Enter", p.B3G_RETURN),
        ("ArrowUp", "ArrowUp", p.B3G_UP_ARROW),
        ("ArrowLeft", "ArrowLeft", p.B3G_LEFT_ARROW),
        ("PageDown", "PageDown", p.B3G_PAGE_DOWN),
        ("Delete", "Delete", p.B3G_DELETE),
        ("Shift", "ShiftLeft", p.B3G_SHIFT),
        ("Control", "ControlLeft", p.B3G_CONTROL),
        ("Alt", "AltLeft", p.B3G_ALT),
        ("F1", "F1", p.B3G_F1),
        ("F15", "F15", p.B3G_F15),
        ("Dead", "BracketLeft", None),
    ],
)
def test_codes(key: str, place: str, code: int | None):
    assert key_code(key, place) == code


def test_a_key_is_triggered_once_held_and_released_once():
    keyboard = Keyboard()
    keyboard.press(1, "a", "KeyA")
    assert keyboard.events() == {97: DOWN | TRIGGERED}
    keyboard.press(1, "a", "KeyA")
    assert keyboard.events() == {97: DOWN}
    assert keyboard.events() == {97: DOWN}
    keyboard.release(1, "a", "KeyA")
    assert keyboard.events() == {97: RELEASED}
    assert keyboard.events() == {}


def test_a_short_press_between_two_calls_is_not_lost():
    keyboard = Keyboard()
    keyboard.press(1, "Escape", "Escape")
    keyboard.release(1, "Escape", "Escape")
    assert keyboard.events() == {27: TRIGGERED | RELEASED}
    assert keyboard.events() == {}


def test_shift_let_go_first_leaves_no_key_behind():
    keyboard = Keyboard()
    keyboard.press(1, "!", "Digit1")
    keyboard.release(1, "1", "Digit1")
    assert keyboard.events() == {ord("1"): TRIGGERED | RELEASED}


def test_a_page_that_is_gone_holds_no_keys():
    keyboard = Keyboard()
    keyboard.press(1, "a", "KeyA")
    keyboard.press(2, "a", "KeyA")
    keyboard.events()
    keyboard.release_all(1)
    assert keyboard.events() == {97: DOWN}
    keyboard.release_all(2)
    assert keyboard.events() == {97: RELEASED}


@given(st.lists(st.tuples(st.sampled_from("pre"), st.integers(0, 1), st.sampled_from("abc")), max_size=50))
def test_states_tell_the_same_as_the_keys(actions: list[tuple[str, int, str]]):
    keyboard = Keyboard()
    held: set[tuple[int, str]] = set()
    before: set[str] = set()
    for action, page, key in actions:
        if action == "p":
            keyboard.press(page, key, "")
            held.add((page, key))
        elif action == "r":
            keyboard.release(page, key, "")
            held.discard((page, key))
        else:
            events = keyboard.events()
            down = {chr(code) for code, state in events.items() if state & DOWN}
            assert down == {key for _, key in held}
            assert {chr(code) for code, state in events.items() if state == DOWN} <= before & down
            assert all(state & TRIGGERED or chr(code) in before for code, state in events.items())
            before = down


def test_mouse_events():
    mouse = Mouse()
    mouse.move(3, 4)
    mouse.button(3, 4, 0, down=True)
    mouse.button(5, 4, 0, down=False)
    assert mouse.events() == [(1, 3, 4, -1, 0), (2, 3, 4, 0, DOWN | TRIGGERED), (2, 5, 4, 0, RELEASED)]
    assert mouse.events() == []


def test_events_nobody_asks_for_do_not_pile_up():
    mouse = Mouse()
    for x in range(100_000):
        mouse.move(x, 0)
    assert len(mouse.events()) <= 1000
