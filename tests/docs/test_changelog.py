"""The changelog has a section for the version, and its sections come in order."""

import re
from datetime import date

from tests.docs.blocks import ROOT

from carom.version import __version__

TEXT = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
SECTIONS = re.findall(r"^## (.*)$", TEXT, re.MULTILINE)


def test_what_is_not_released_comes_first():
    assert SECTIONS[0] == "Unreleased"


def test_releases_have_dates_and_come_from_the_newest_to_the_oldest():
    found = [re.fullmatch(r"(\d+)\.(\d+)\.(\d+) - (\d{4}-\d\d-\d\d)", section) for section in SECTIONS[1:]]
    releases = [(tuple(map(int, one.groups()[:3])), date.fromisoformat(one[4])) for one in found if one]
    assert len(releases) == len(SECTIONS) - 1
    assert releases == sorted(releases, reverse=True)


def test_a_version_to_be_released_has_a_section():
    # Between releases the version ends in `.dev0`.
    if ".dev" not in __version__:
        assert SECTIONS[1].startswith(f"{__version__} - ")
