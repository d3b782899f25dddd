"""Who may talk to the server."""

import pytest

from carom.viewer.access import Access, host_allowed, is_loopback, origin_allowed


@pytest.mark.parametrize("host", ["localhost:8400", "127.0.0.1:9", "[::1]:8400", "LOCALHOST"])
def test_this_machine_is_served_under_its_own_names(host: str):
    assert host_allowed("127.0.0.1", host)


@pytest.mark.parametrize(
    "host", [None, "", "evil.example", "localhost.evil.example:8400", "10.0.0.7:80", "[::1"]
)
def test_other_names_that_lead_here_are_refused(host: str | None):
    assert not host_allowed("127.0.0.1", host)


def test_a_server_for_the_network_answers_to_addresses():
    assert host_allowed("0.0.0.0", "192.168.1.20:8400")
    assert host_allowed("robot.lan", "robot.lan:8400")
    assert not host_allowed("0.0.0.0", "evil.example:8400")


def test_sockets_are_for_the_servers_own_page():
    assert origin_allowed("localhost:8400", "http://localhost:8400")
    assert origin_allowed("localhost:8400", None)
    for origin in (
        "http://evil.example",
        "http://localhost:8401",
        "null",
        "file://",
        "http://127.0.0.1:8400",
    ):
        assert not origin_allowed("localhost:8400", origin)


def test_loopback():
    assert all(map(is_loopback, ("127.0.0.1", "127.1.2.3", "::1", "localhost")))
    assert not any(map(is_loopback, ("0.0.0.0", "192.168.1.1", "example.org")))


def test_everybody_needs_the_token():
    access = Access("0.0.0.0")
    assert access.address(8400).endswith(f":8400/?token={access.token}")
    assert "0.0.0.0" not in access.address(8400)
    own = "192.168.1.20:8400"
    assert not access.may_connect("/socket", own, f"http://{own}")
    assert not access.may_connect("/socket", "localhost:8400", None)
    assert not access.may_connect("/socket?token=guessed", own, f"http://{own}")
    assert access.may_connect(f"/socket?token={access.token}", own, f"http://{own}")
    home = Access()
    assert home.address(8400) == f"http://127.0.0.1:8400/?token={home.token}"
    own, origin = "localhost:8400", "http://localhost:8400"
    assert not home.may_connect("/socket", own, origin)
    assert not home.may_connect("/socket", own, origin, "carom-abcd=guessed")
    assert home.may_connect("/socket", own, origin, f"other=1; {home.cookie}")
    assert not home.may_connect("/socket", own, "http://evil.example", home.cookie)
    assert not home.is_known("/", own, None)
    assert home.token != access.token


def test_a_proxy_needs_the_token_or_a_name_that_may_ask():
    hub, origin = "hub.example.org", "https://hub.example.org"
    access = Access()
    assert not access.may_connect("/socket", hub, origin)
    assert not access.may_read("/", hub, None)
    assert access.may_connect(f"/socket?token={access.token}", hub, origin)
    assert access.may_read(f"/?token={access.token}", hub, None)
    assert access.may_read("/main.js", hub, f"other=1; {access.cookie}")
    assert not access.may_read("/main.js", hub, "carom=guessed")
    named = Access(names=frozenset({"hub.example.org"}))
    assert named.may_connect("/socket", hub, origin)
    assert not named.may_connect("/socket", hub, "https://evil.example")
    assert not named.may_connect("/socket", "evil.example", "https://evil.example")
