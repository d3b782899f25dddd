"""Options of `connect`."""

from pybullet._calls.options import Target, named_values


def test_double_quotes_enclose_spaces() -> None:
    options = '--width=800 --mp4="my run.mp4" --minGraphicsUpdateTimeMs --key-file="a b"c'
    assert dict(named_values(options)) == {
        "width": "800",
        "mp4": "my run.mp4",
        "minGraphicsUpdateTimeMs": "",
        "key-file": "a bc",
    }


def test_the_last_value_of_a_name_counts() -> None:
    target = Target(options="--width=800 --width=640")
    assert target.option("width") == "640"
    assert target.option("height") is None
