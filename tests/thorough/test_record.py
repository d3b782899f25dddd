"""What has been done of the long checks outlives a run, and holds for one state of the checkout."""

import subprocess
from pathlib import Path

import pytest
from tools.thorough.record import Record, checkout_digest


def test_a_run_is_there_in_the_next_record(tmp_path: Path):
    file = tmp_path / "deep" / "record.json"
    record = Record(file, "a")
    assert record.last("fuzz: 1") is None
    record.add("fuzz: 1", True, 2.25)
    record.add("fuzz: 2", False, 1.0)
    later = Record(file, "a")
    assert later.is_done("fuzz: 1")
    assert not later.is_done("fuzz: 2")
    done = later.last("fuzz: 1")
    assert done is not None
    assert (done.digest, done.seconds, done.number) == ("a", 2.2, 1)


def test_what_passed_on_another_checkout_is_not_done_but_counts(tmp_path: Path):
    file = tmp_path / "record.json"
    Record(file, "a").add("fuzz: 1", True, 1.0)
    record = Record(file, "b")
    assert not record.is_done("fuzz: 1")
    assert record.passes("fuzz: 1") == 1
    record.add("fuzz: 1", False, 1.0)
    assert (record.is_done("fuzz: 1"), record.passes("fuzz: 1")) == (False, 1)
    record.add("fuzz: 1", True, 1.0)
    assert (record.is_done("fuzz: 1"), record.passes("fuzz: 1")) == (True, 2)


@pytest.fixture
def checkout(tmp_path: Path) -> Path:
    for name, text in (
        ("src/a.py", "a"),
        ("docs/page.md", "p"),
        ("pyproject.toml", ""),
        (".gitignore", "*.o"),
    ):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    subprocess.run(["git", "init", "-q"], cwd=tmp_path, check=True)
    subprocess.run(["git", "add", "."], cwd=tmp_path, check=True)
    return tmp_path


def test_a_digest_changes_with_sources_tests_and_tools(checkout: Path):
    digests = [checkout_digest(checkout)]
    for name, text in (("src/a.py", "b"), ("src/new.py", ""), ("pyproject.toml", "[tool]")):
        (checkout / name).write_text(text)
        digests.append(checkout_digest(checkout))
    (checkout / "src" / "a.py").unlink()
    digests.append(checkout_digest(checkout))
    assert len(set(digests)) == 5


def test_a_digest_does_not_change_with_pages_and_what_git_ignores(checkout: Path):
    before = checkout_digest(checkout)
    (checkout / "docs" / "page.md").write_text("other")
    (checkout / "src" / "made.o").write_text("object")
    assert checkout_digest(checkout) == before
