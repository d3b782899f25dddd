"""Frames on a socket."""

import socket
import struct
from collections.abc import Iterator
from threading import Thread

import pytest
from hypothesis import given
from hypothesis import strategies as st

from carom.remote.errors import Malformed
from carom.remote.frames import _TRUSTED, OF_CALLS, OF_RESULTS, Limits, Reader, check_size, send
from carom.remote.values import padded

LIMITS = Limits(message=1 << 20, contents=80 << 20)
Sent = tuple[int, bytes, list[bytes]]


@pytest.fixture
def pair() -> Iterator[tuple[socket.socket, socket.socket]]:
    near, far = socket.socketpair()
    with near, far:
        far.settimeout(5.0)
        yield near, far


def pieces(arrays: list[bytes]) -> list[memoryview]:
    return [memoryview(one) for one in arrays]


def behind(arrays: list[bytes]) -> bytes:
    return b"".join(one + bytes(padded(len(one)) - len(one)) for one in arrays)


frames = st.tuples(
    st.integers(0, 2**32 - 1), st.binary(max_size=300), st.lists(st.binary(max_size=100), max_size=3)
)


@given(st.lists(frames, min_size=1, max_size=8), st.sampled_from([1, 7, 100_000]))
def test_frames_arrive_whole_and_in_order(sent: list[Sent], step: int) -> None:
    near, far = socket.socketpair()
    collected, out = socket.socketpair()
    with near, far, collected, out:
        for number, message, arrays in sent:
            send(out, number, message, pieces(arrays))
        out.shutdown(socket.SHUT_WR)
        stream = b""
        while piece := collected.recv(1 << 20):
            stream += piece
        reader = Reader(far, LIMITS)
        arrived = []

        def trickle() -> None:
            for start in range(0, len(stream), step):
                near.sendall(stream[start : start + step])

        thread = Thread(target=trickle)
        thread.start()
        for _ in sent:
            arrived.append(reader.frame())
        thread.join()
    for frame, (number, message, arrays) in zip(arrived, sent, strict=True):
        assert frame.number == number
        assert bytes(frame.message) == message
        assert bytes(frame.contents) == behind(arrays)


@pytest.mark.parametrize("size", [16_000, 65_519, 65_520, 65_521, 200_000, 40_000_000])
def test_frames_of_all_sizes_between_small_ones(pair: tuple[socket.socket, socket.socket], size: int) -> None:
    near, far = pair
    long = bytes(range(256)) * (size // 256) + bytes(size % 256)

    def talk() -> None:
        send(near, 1, b"before", [])
        send(near, 2, b"long", pieces([long]))
        send(near, 3, b"after", [])

    thread = Thread(target=talk)
    thread.start()
    reader = Reader(far, LIMITS)
    assert bytes(reader.frame().message) == b"before"
    frame = reader.frame()
    assert (bytes(frame.message), bytes(frame.contents)[:size]) == (b"long", long)
    assert bytes(reader.frame().message) == b"after"
    thread.join()


def test_waiting_can_be_interrupted_anywhere(pair: tuple[socket.socket, socket.socket]) -> None:
    near, far = pair
    far.settimeout(0.001)
    collected, out = socket.socketpair()
    with collected, out:
        send(out, 5, b"message", pieces([bytes(100)]))
        stream = collected.recv(1000)
    reader = Reader(far, LIMITS)
    for place in range(len(stream)):
        with pytest.raises(TimeoutError):
            reader.frame()
        near.sendall(stream[place : place + 1])
    assert bytes(reader.frame().message) == b"message"


@pytest.mark.parametrize(
    ("message", "contents"), [(LIMITS.message + 1, 0), (0, LIMITS.contents + 1), (2**32 - 1, 2**64 - 1)]
)
def test_a_header_that_promises_too_much(
    pair: tuple[socket.socket, socket.socket], message: int, contents: int
) -> None:
    near, far = pair
    near.sendall(struct.pack("<IIQ", 1, message, contents))
    with pytest.raises(Malformed):
        Reader(far, LIMITS).frame()


def test_a_promise_alone_takes_no_memory(pair: tuple[socket.socket, socket.socket]) -> None:
    near, far = pair
    far.settimeout(0.05)
    near.sendall(struct.pack("<IIQ", 1, 0, LIMITS.contents) + bytes(100_000))
    reader = Reader(far, LIMITS)
    with pytest.raises(TimeoutError):
        reader.frame()
    assert len(reader._long) <= _TRUSTED


def test_the_end_in_the_middle(pair: tuple[socket.socket, socket.socket]) -> None:
    near, far = pair
    near.sendall(struct.pack("<IIQ", 1, 10, 0) + b"abc")
    near.close()
    with pytest.raises(EOFError):
        Reader(far, LIMITS).frame()


def test_what_is_too_much_is_not_sent() -> None:
    check_size(bytes(LIMITS.message), [], LIMITS)
    with pytest.raises(Malformed):
        check_size(bytes(LIMITS.message + 1), [], LIMITS)
    with pytest.raises(Malformed):
        check_size(b"", [memoryview(bytes(LIMITS.contents + 1))], LIMITS)


def test_what_servers_and_clients_accept_is_what_scenes_need() -> None:
    landscape, texture = memoryview(bytes(8 * 1024**2)), memoryview(bytes(3 * 8192**2))
    for limits in (OF_CALLS, OF_RESULTS):
        check_size(b"loadTexture", [landscape], limits)
        check_size(bytes(limits.message), [texture], limits)
        with pytest.raises(Malformed):
            check_size(bytes(limits.message + 1), [], limits)
    # A call cannot fill the memory of the server.
    with pytest.raises(Malformed):
        check_size(b"", [texture, texture], OF_CALLS)
    assert OF_CALLS.message < OF_RESULTS.message < 2**30
