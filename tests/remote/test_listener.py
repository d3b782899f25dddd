"""A server that echoes, and all who come to it."""

import socket
import struct
from collections.abc import Iterator
from contextlib import suppress
from threading import Event, Thread
from time import sleep

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from tests.patience import PATIENCE, until
from tests.thorough.profiles import cases

from carom.remote import handshake, listener
from carom.remote.connection import Connection
from carom.remote.errors import Malformed, NoServer, ServerGone
from carom.remote.frames import Frame
from carom.remote.handshake import enter
from carom.remote.listener import Listener
from carom.remote.values import pack, unpack

KEY = b"a key of enough characters"


class Echo:
    """Answers with what it was asked; `"wait"` waits until it may go on."""

    def __init__(self) -> None:
        self.go_on = Event()

    def __call__(self, frame: Frame) -> tuple[bytes, list[memoryview]]:
        request = unpack(frame.message, frame.contents, lists=True)
        if request == "wait":
            self.go_on.wait()
        if request == "fail":
            raise RuntimeError
        return pack(request)


@pytest.fixture
def echo() -> Echo:
    return Echo()


@pytest.fixture
def server(echo: Echo) -> Iterator[Listener]:
    running = Listener([("127.0.0.1", 0)], KEY, echo)
    yield running
    echo.go_on.set()
    running.close()
    assert running.client_count == 0


def join(server: Listener, timeout: float = PATIENCE, key: bytes = KEY) -> Connection:
    host, port = server.addresses[0]
    return Connection(host, port, key, timeout)


def call_at(address: tuple[str, int]) -> Connection:
    return Connection(address[0], address[1], KEY, 1.0)


def stranger(server: Listener) -> socket.socket:
    peer = socket.create_connection(server.addresses[0])
    peer.settimeout(PATIENCE)
    return peer


def friend(server: Listener) -> socket.socket:
    """A socket that has shown the key."""
    peer = stranger(server)
    enter(peer, KEY)
    return peer


def is_closed(peer: socket.socket) -> bool:
    """Whether the server closes the connection before long."""
    try:
        while peer.recv(65536):
            pass
    except TimeoutError:
        return False
    except OSError:
        pass
    return True


def works(server: Listener) -> bool:
    connection = join(server)
    try:
        return connection.call(["how", "are", "you"]) == ("how", "are", "you")
    finally:
        connection.close()


def test_calls_are_answered(server: Listener) -> None:
    connection = join(server)
    for request in (1, "two", (3.0, None), {"four": b"5"}):
        assert connection.call(request) == request
    connection.close()
    assert not connection.is_open()


def test_threads_share_a_connection(server: Listener) -> None:
    connection = join(server)
    wrong = []

    def ask(number: int) -> None:
        for count in range(200):
            if connection.call((number, count)) != (number, count):
                wrong.append(number)

    threads = [Thread(target=ask, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    connection.close()
    assert not wrong


@pytest.mark.parametrize("key", [b"", b"another key of enough characters", KEY[:-1]])
def test_a_wrong_key(server: Listener, key: bytes) -> None:
    with pytest.raises(NoServer):
        join(server, key=key)
    assert works(server)


def test_a_server_that_does_not_know_the_key_learns_nothing() -> None:
    heard = b""

    def pose(listening: socket.socket) -> None:
        nonlocal heard
        peer, _ = listening.accept()
        with peer:
            heard += peer.recv(1000)
            peer.sendall(heard[:8] + bytes(64))
            with suppress(OSError):
                heard += peer.recv(1000)

    with socket.create_server(("127.0.0.1", 0)) as listening:
        thread = Thread(target=pose, args=(listening,))
        thread.start()
        with pytest.raises(NoServer, match="another key"):
            call_at(listening.getsockname())
        thread.join()
    # The greeting and a random number.
    assert len(heard) == 8 + 32


def test_something_else_answers() -> None:
    def talk(listening: socket.socket) -> None:
        peer, _ = listening.accept()
        with peer:
            peer.sendall(b"HTTP/1.1 400 Bad Request\r\n\r\n" + bytes(100))

    with socket.create_server(("127.0.0.1", 0)) as listening:
        thread = Thread(target=talk, args=(listening,))
        thread.start()
        with pytest.raises(NoServer):
            call_at(listening.getsockname())
        thread.join()


def test_nobody_answers() -> None:
    with socket.create_server(("127.0.0.1", 0)) as listening:
        address = listening.getsockname()
    with pytest.raises(NoServer):
        call_at(address)
    with pytest.raises(NoServer):
        Connection("localhost", 700_000, KEY, 1.0)


def test_a_server_that_says_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    from carom.remote import connection

    monkeypatch.setattr(connection, "TIMEOUT", 0.2)
    monkeypatch.setattr(handshake, "TIMEOUT", 0.2)
    with socket.create_server(("127.0.0.1", 0)) as listening, pytest.raises(NoServer):
        call_at(listening.getsockname())


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=cases(50))
@given(st.binary(max_size=200))
def test_any_bytes_from_strangers(server: Listener, rubbish: bytes) -> None:
    with stranger(server) as peer:
        with suppress(OSError):
            peer.sendall(rubbish)
            peer.shutdown(socket.SHUT_WR)
        assert is_closed(peer)
    assert works(server)


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=cases(50))
@given(
    st.binary(max_size=200)
    | st.builds(
        lambda number, message, contents, rest: struct.pack("<IIQ", number, message, contents) + rest,
        st.integers(0, 2**32 - 1),
        st.integers(0, 2**32 - 1),
        st.integers(0, 2**64 - 1),
        st.binary(max_size=100),
    )
    | st.binary(max_size=100).map(lambda message: struct.pack("<IIQ", 1, len(message), 0) + message)
)
def test_any_bytes_from_friends(server: Listener, rubbish: bytes) -> None:
    with friend(server) as peer:
        with suppress(OSError):
            peer.sendall(rubbish)
            peer.shutdown(socket.SHUT_WR)
        assert is_closed(peer)
    assert works(server)


def test_an_answer_that_fails_costs_one_connection(
    server: Listener, caplog: pytest.LogCaptureFixture
) -> None:
    connection = join(server)
    with pytest.raises(ServerGone):
        connection.call("fail")
    assert works(server)
    # Whoever runs the server learns why.
    assert until(lambda: "A client has lost its connection." in caplog.text)
    assert "RuntimeError" in caplog.text


def test_of_more_than_32_silent_connections_the_oldest_is_closed(
    monkeypatch: pytest.MonkeyPatch, server: Listener
) -> None:
    monkeypatch.setattr(handshake, "TIMEOUT", 10.0 * PATIENCE)
    crowd = [stranger(server) for _ in range(32)]
    for peer in crowd:
        peer.settimeout(0.05)
    assert until(lambda: len(server._strangers) == 32)
    assert not is_closed(crowd[0])
    crowd.append(stranger(server))
    crowd[0].settimeout(PATIENCE)
    assert is_closed(crowd[0])
    assert not is_closed(crowd[1])
    for peer in crowd:
        peer.close()


def test_strangers_have_little_time(monkeypatch: pytest.MonkeyPatch, server: Listener) -> None:
    monkeypatch.setattr(handshake, "TIMEOUT", 1.0)
    with stranger(server) as silent, stranger(server) as slow:
        assert works(server)
        with suppress(OSError):
            for _ in range(6):
                slow.sendall(b"c")
                sleep(0.25)
        assert is_closed(silent)
        assert is_closed(slow)


def test_a_crowd_of_strangers_keeps_no_friend_out(monkeypatch: pytest.MonkeyPatch, server: Listener) -> None:
    monkeypatch.setattr(handshake, "TIMEOUT", 3.0)
    crowd = [stranger(server) for _ in range(listener._MAX_STRANGERS + 10)]
    # They take all places, and go on coming; whoever knows the key gets in at once.
    for _ in range(10):
        crowd.append(stranger(server))
        assert works(server)
    for peer in crowd:
        assert is_closed(peer)
        peer.close()
    assert works(server)


def test_each_stranger_too_many_takes_the_place_of_another(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listener, "_MAX_STRANGERS", 2)
    asleep = Event()
    # Threads of those that were hung up on may be slow to notice.
    talk = Listener._talk

    def late(self: Listener, peer: socket.socket) -> None:
        asleep.wait(PATIENCE)
        talk(self, peer)

    monkeypatch.setattr(Listener, "_talk", late)
    server = Listener([("127.0.0.1", 0)], KEY, Echo())
    crowd = [stranger(server) for _ in range(5)]
    assert all(is_closed(peer) for peer in crowd[:3])
    for peer in crowd[3:]:
        peer.settimeout(0.3)
        assert not is_closed(peer)
    asleep.set()
    for peer in crowd:
        peer.close()
    server.close()


def test_there_is_room_for_so_many(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listener, "MAX_CLIENTS", 3)
    server = Listener([("127.0.0.1", 0)], KEY, Echo())
    connections = [join(server) for _ in range(3)]
    with pytest.raises(NoServer, match="its maximum number of clients"):
        join(server)
    assert [connection.call(number) for number, connection in enumerate(connections)] == [0, 1, 2]
    connections[0].close()
    assert until(lambda: server.client_count == 2)
    assert works(server)
    server.close()


def test_hung_clients_harm_nobody(server: Listener) -> None:
    with friend(server) as half, friend(server) as deaf:
        half.sendall(struct.pack("<IIQ", 1, 1000, 0) + b"half of")
        # Asks and asks and never listens.
        message, _ = pack(bytes(60_000))
        deaf.settimeout(0.3)
        with suppress(TimeoutError):
            for _ in range(1000):
                deaf.sendall(struct.pack("<IIQ", 1, len(message), 0) + message + bytes(-len(message) % 16))
        assert works(server)
        server.close()
    assert server.client_count == 0


def test_a_call_that_takes_too_long_ends_the_connection(server: Listener, echo: Echo) -> None:
    connection = join(server, timeout=0.1)
    with pytest.raises(ServerGone, match=r"within 0\.1 s"):
        connection.call("wait")
    assert not connection.is_open()
    with pytest.raises(ServerGone):
        connection.call("anything")
    assert works(server)


class Waiting:
    """A thread in the middle of a call, and whether the server went meanwhile."""

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._gone = False
        self._thread = Thread(target=self._ask)
        self._thread.start()
        assert until(connection._lock.locked)

    def _ask(self) -> None:
        try:
            self._connection.call("wait")
        except ServerGone:
            self._gone = True

    def has_lost_its_server(self) -> bool:
        self._thread.join(PATIENCE)
        return self._gone


def test_disconnecting_while_another_thread_waits(server: Listener) -> None:
    connection = join(server)
    waiting = Waiting(connection)
    connection.close()
    assert waiting.has_lost_its_server()


def test_closing_while_a_call_is_in_progress(server: Listener, echo: Echo) -> None:
    connection = join(server)
    waiting = Waiting(connection)
    assert connection.is_open()
    closing = Thread(target=server.close)
    closing.start()
    assert waiting.has_lost_its_server()
    echo.go_on.set()
    closing.join(PATIENCE)
    assert not connection.is_open()


def test_a_closed_server_is_noticed_without_asking(server: Listener) -> None:
    connection = join(server)
    assert connection.is_open()
    server.close()
    assert until(lambda: not connection.is_open())
    with pytest.raises(NoServer):
        join(server)


def test_an_interrupted_call_leaves_the_connection_in_order(
    server: Listener, echo: Echo, monkeypatch: pytest.MonkeyPatch
) -> None:
    connection = join(server)
    with monkeypatch.context() as patched:

        def interrupt() -> Frame:
            raise KeyboardInterrupt

        patched.setattr(connection._reader, "frame", interrupt)
        with pytest.raises(KeyboardInterrupt):
            connection.call("late")
    assert connection.call("next") == "next"


def test_too_large_a_call_is_not_even_sent(server: Listener) -> None:
    connection = join(server)
    with pytest.raises(Malformed):
        connection.call(bytes(65 << 20))
    assert connection.call(1) == 1


def test_a_port_that_is_taken(server: Listener) -> None:
    with pytest.raises(OSError):
        Listener([("127.0.0.1", 0), server.addresses[0]], KEY, Echo())
