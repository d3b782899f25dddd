"""What pages are sent, whenever they join."""

from hypothesis import given
from hypothesis import strategies as st

from carom.viewer.board import Board
from carom.viewer.messages import decoded


def headers(messages: list[bytes]) -> list[dict]:
    return [decoded(message)[0] for message in messages]


def test_only_the_newest_message_of_a_key_is_sent():
    board = Board()
    board.put("a", {"n": 1})
    board.put("b", {"n": 2}, b"1234")
    board.put("a", {"n": 3})
    messages, revision = board.since(0)
    assert headers(messages) == [{"n": 2}, {"n": 3}]
    assert decoded(messages[0])[1] == b"1234"
    assert board.since(revision) == ([], revision)


def test_who_knew_it_is_told_that_it_has_gone():
    board = Board()
    board.put("a", {"n": 1})
    _, revision = board.since(0)
    board.take_down("a", {"gone": "a"})
    board.take_down("a", {"gone": "again"})
    board.take_down("never there", {"gone": "never"})
    assert headers(board.since(revision)[0]) == [{"gone": "a"}]
    assert board.since(0)[0] == []
    assert not board.holds("a")


def test_an_amended_message_is_for_newcomers():
    board = Board()
    board.put("a", {"n": 1})
    _, revision = board.since(0)
    board.amend("a", {"n": 2})
    board.amend("unknown", {"n": 3})
    assert board.since(revision)[0] == []
    assert headers(board.since(0)[0]) == [{"n": 2}]


ACTIONS = st.tuples(st.sampled_from(["put", "take down", "look", "forget"]), st.integers(0, 4))


@given(st.lists(ACTIONS, max_size=60))
def test_every_page_comes_to_know_what_there_is(actions: list[tuple[str, int]]):
    board, truth = Board(), {}
    pages: list[tuple[dict, int]] = [({}, 0)]

    def look(page: int) -> None:
        known, revision = pages[page]
        messages, revision = board.since(revision)
        for header in headers(messages):
            if header["n"] is None:
                known.pop(header["key"], None)
            else:
                known[header["key"]] = header["n"]
        pages[page] = (known, revision)

    for number, (action, key) in enumerate(actions):
        if action == "put":
            board.put(key, {"key": key, "n": number})
            truth[key] = number
        elif action == "take down":
            board.take_down(key, {"key": key, "n": None})
            truth.pop(key, None)
        elif action == "forget":
            board.forget_removals(min(revision for _, revision in pages))
        elif key < len(pages):
            look(key)
        else:
            pages.append(({}, 0))
    for page in range(len(pages)):
        look(page)
        assert pages[page][0] == truth
