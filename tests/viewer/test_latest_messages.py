"""What pages are sent, whenever they join."""

from hypothesis import given
from hypothesis import strategies as st

from carom.viewer.latest_messages import LatestMessages
from carom.viewer.messages import decoded


def headers(messages: list[bytes]) -> list[dict]:
    return [decoded(message)[0] for message in messages]


def test_only_the_newest_message_of_a_key_is_sent():
    latest = LatestMessages()
    latest.put("a", {"n": 1})
    latest.put("b", {"n": 2}, b"1234")
    latest.put("a", {"n": 3})
    messages, revision = latest.since(0)
    assert headers(messages) == [{"n": 2}, {"n": 3}]
    assert decoded(messages[0])[1] == b"1234"
    assert latest.since(revision) == ([], revision)


def test_who_knew_it_is_told_that_it_has_gone():
    latest = LatestMessages()
    latest.put("a", {"n": 1})
    _, revision = latest.since(0)
    latest.remove("a", {"gone": "a"})
    latest.remove("a", {"gone": "again"})
    latest.remove("never there", {"gone": "never"})
    assert headers(latest.since(revision)[0]) == [{"gone": "a"}]
    assert latest.since(0)[0] == []
    assert not latest.holds("a")


def test_an_amended_message_is_for_newcomers():
    latest = LatestMessages()
    latest.put("a", {"n": 1})
    _, revision = latest.since(0)
    latest.amend("a", {"n": 2})
    latest.amend("unknown", {"n": 3})
    assert latest.since(revision)[0] == []
    assert headers(latest.since(0)[0]) == [{"n": 2}]


ACTIONS = st.tuples(st.sampled_from(["put", "take down", "look", "forget"]), st.integers(0, 4))


@given(st.lists(ACTIONS, max_size=60))
def test_every_page_comes_to_know_what_there_is(actions: list[tuple[str, int]]):
    latest, truth = LatestMessages(), {}
    pages: list[tuple[dict, int]] = [({}, 0)]

    def look(page: int) -> None:
        known, revision = pages[page]
        messages, revision = latest.since(revision)
        for header in headers(messages):
            if header["n"] is None:
                known.pop(header["key"], None)
            else:
                known[header["key"]] = header["n"]
        pages[page] = (known, revision)

    for number, (action, key) in enumerate(actions):
        if action == "put":
            latest.put(key, {"key": key, "n": number})
            truth[key] = number
        elif action == "take down":
            latest.remove(key, {"key": key, "n": None})
            truth.pop(key, None)
        elif action == "forget":
            latest.forget_removals(min(revision for _, revision in pages))
        elif key < len(pages):
            look(key)
        else:
            pages.append(({}, 0))
    for page in range(len(pages)):
        look(page)
        assert pages[page][0] == truth
