"""The text for a package index has no links into the repository, and is README.md otherwise."""

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.docs.blocks import ROOT
from tests.each import each
from tools.packaging.long_description import long_description

README = (ROOT / "README.md").read_text(encoding="utf-8")
_BLOCK = re.compile(r"^```.*?^```$", re.MULTILINE | re.DOTALL)


def test_no_relative_link_or_picture_of_the_readme_remains():
    text = _BLOCK.sub("", long_description(README))
    targets = re.findall(r"\]\(([^)]*)\)", text)
    assert [target for target in targets if not target.startswith("https://")] == []
    assert "![" not in text
    # There are such links and pictures in the readme.
    assert "](docs/" in README
    assert "![" in README


def test_headings_code_and_words_of_the_readme_stay():
    text = long_description(README)
    assert re.findall(r"^#+ .*$", text, re.MULTILINE) == re.findall(r"^#+ .*$", README, re.MULTILINE)
    assert _BLOCK.findall(text) == _BLOCK.findall(README)
    assert "docs/status.md lists every function" in text
    assert "\n\n\n" not in text


@each(
    ("readme", "expected"),
    [
        ("See [the\npage](docs/a.md).\n", "See the\npage.\n"),
        ("[`code [x]`](a.md#b) and [one](<a b.md>) and [two](c.md 'Title')", "`code [x]` and one and two"),
        ("[here](#usage), [there](https://example.org/a_(b))", "here, [there](https://example.org/a_(b))"),
        (
            "[mail](mailto:a@example.org) <https://example.org>",
            "[mail](mailto:a@example.org) <https://example.org>",
        ),
        ("above\n\n![picture](docs/a.png)\n\nbelow\n", "above\n\nbelow\n"),
        ("a ![b](docs/b.png) c ![d](https://example.org/d.png)", "a  c ![d](https://example.org/d.png)"),
        (
            "[![b](b.svg)](docs/b.md)[![c](https://example.org/c.svg)](c.md)",
            "![c](https://example.org/c.svg)",
        ),
        ("`[a](b.md)` and ``![a](`b.png)``", "`[a](b.md)` and ``![a](`b.png)``"),
        ("~~~\n```\n[a](b.md)\n~~~\n[a](b.md)", "~~~\n```\n[a](b.md)\n~~~\na"),
        ("````\n```\n[a](b.md)\n````\n[a](b.md)\n", "````\n```\n[a](b.md)\n````\na\n"),
        ("```\nnever closed [a](b.md)\n\n\n\n", "```\nnever closed [a](b.md)\n\n\n\n"),
        (r"\[a](b) \![c](d.md)", None),
        ("", ""),
    ],
)
def test_relative_links_become_text_and_relative_pictures_go(readme: str, expected: str | None):
    if expected is None:
        with pytest.raises(ValueError, match="relative link to b is not"):
            long_description(readme)
    else:
        assert long_description(readme) == expected


@pytest.mark.parametrize(
    "readme",
    [
        "see [a]\n\n[a]: docs/a.md\n",
        '<img src="docs/a.png">',
        "<a\nhref=docs/a.md>a</a>",
        "[a [b] c](docs/a.md)",
    ],
)
def test_links_in_another_form_are_refused(readme: str):
    with pytest.raises(ValueError, match=r"docs/a\.(md|png)"):
        long_description(readme)


@given(
    st.lists(
        st.tuples(
            st.sampled_from(["Text.\n", "\n", "[a](b.md)\n", "![a](b.png)\n", "`c`\n", "# H\n", "a ` b\n\n"]),
            st.text("[a](b.md)!` \n#<>", max_size=40).filter(lambda code: "```" not in code),
        ),
        max_size=5,
    )
)
def test_blocks_of_code_are_never_changed(parts: list[tuple[str, str]]):
    blocks = [f"```sh\n{code}\n```\n" for _, code in parts]
    readme = "".join(text + block for (text, _), block in zip(parts, blocks, strict=True))
    result = long_description(readme)
    place = 0
    for block in blocks:
        place = result.index(block, place) + len(block)
    assert "](b" not in re.sub(r"^```sh\n.*?\n```$", "", result, flags=re.MULTILINE | re.DOTALL)
    assert long_description(result) == result
