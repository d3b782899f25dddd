"""The page about other people's code."""

import re
from pathlib import Path

from tests.clients.page import PAGE, note, page, read


def test_the_page_is_up_to_date() -> None:
    assert PAGE.read_text(encoding="utf-8") == page(read()), "run python -m tests.clients.page"


def test_no_folder_of_a_machine_is_recorded() -> None:
    texts = [outcome["text"] for group in read().values() for outcome in group.values()]
    assert texts
    assert not [text for text in texts if re.search(r"(?<![\w.:/])/\w", text)]


def test_outcomes_are_noted_and_shown(tmp_path: Path) -> None:
    path = tmp_path / "record.json"
    group = "examples in the wheel"
    note(group, "hello", same=False, text="drifts | apart\nlost: one", path=path)
    note(group, "hello", same=True, text="ends | well", path=path)
    note("panda-gym", "panda-gym", same=False, text="9 of 10", path=path)
    record = read(path)
    assert record[group]["hello"]["same"]
    shown = page(record)
    assert f"| `hello` | {record[group]['hello']['date']} | yes | ends \\| well |" in shown
    assert "1 of 1 recorded scripts" in shown
    assert "| no | 9 of 10 |" in shown
