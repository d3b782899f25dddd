"""Physics clients: independent worlds, selected by `physicsClientId`."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, ClassVar, Protocol

from pybullet._calls.arguments import integer
from pybullet._calls.detours import remove_detour
from pybullet._calls.errors import NOT_CONNECTED, fail
from pybullet._clients.locks import let_go
from pybullet._clients.log_registry import Logs
from pybullet._clients.plugin_registry import Plugins
from pybullet._clients.shape_registry import ShapeRegistry

if TYPE_CHECKING:
    from pathlib import Path

    from carom.formats.search import AssetSearch
    from carom.scene.body import Body
    from carom.scene.snapshot import Snapshot
    from carom.world.world import World
    from pybullet._access.body_access import BodyTable
    from pybullet._clients.origins import Origin
    from pybullet._clients.real_time import RealTimeClock
    from pybullet._window.window import Window

MAX_CLIENTS = 1024


class Server(Protocol):
    """A server of a connection's world for other processes."""

    def close(self) -> None:
        """Ends all connections."""
        ...


class Remote(Protocol):
    """A connection to a world in another process.

    Attributes:
        method: Connection method: `SHARED_MEMORY`, `UDP`, ...
    """

    method: int

    def is_open(self) -> bool:
        """Whether the server is still connected."""
        ...

    def set_timeout(self, seconds: float) -> None:
        """Sets how long to wait for answers [s]."""
        ...

    def close(self) -> None:
        """Ends the connection; the server and its world continue."""
        ...


class Client:
    """One connection and its world.

    Attributes:
        method: Connection method: `DIRECT`, `GUI`, ...
        bodies: Direct access to the state of bodies, by id; made on first use and dropped whenever bodies are
            added or removed, because that moves the rows of the state arrays.
        origins: The calls that loaded bodies from files, by body id.
        maximal: Ids of the bodies for which the script asked for maximal coordinates; external forces act
            twice on them in a deformable world.
        flags_of_colours: Flags of the last `loadURDF` that say which colours meshes have; 0 after `loadSDF`.
        real_time: `useRealTimeSimulation` as the script set it.
        server: The server for other processes, if there is one.
        latest_search_path: The last search directory set in this process: PyBullet has only one for all
            connections, and keeps it when they end.
        clock: Steps the world in real time; None if that is not enabled.
        deformable: Whether the last `resetSimulation` had a flag for deformable worlds.
        lock: Held from the arguments of a call to its results, and by other threads that use the world.
        call_lock: The same as calls take it: handlers of signals wait for the end of the outermost one.
    """

    latest_search_path: ClassVar[Path | None] = None

    def __init__(self, method: int, world: World, bodies: BodyTable, window: Window) -> None:
        self.method = method
        self.world = world
        self.bodies = bodies
        self.window = window
        self.real_time = 0
        self.deformable = False
        self.search_path: Path | None = None
        self.shapes = ShapeRegistry()
        self.logs = Logs()
        self.plugins = Plugins()
        self.origins: dict[int, Origin] = {}
        self.maximal: set[int] = set()
        self.flags_of_colours = 0
        self.states: dict[int, Snapshot] = {}
        self.clock: RealTimeClock | None = None
        self.server: Server | None = None
        self.lock: Any = world.lock
        self.call_lock: Any = world.call_lock
        bodies.belong_to(self)
        self.time_step = world.parameters.time_step

    @property
    def time_step(self) -> float:
        """`fixedTimeStep` [s]."""
        return self.bodies.quick.record.time_step

    @time_step.setter
    def time_step(self, value: float) -> None:
        self.bodies.quick.record.time_step = value

    @property
    def report_analytics(self) -> bool:
        """Whether `stepSimulation` returns the statistics of the solver."""
        return bool(self.bodies.quick.record.reports_analytics)

    @report_analytics.setter
    def report_analytics(self, value: bool) -> None:
        self.bodies.quick.record.reports_analytics = value

    def body(self, body_id: Any) -> Body | None:
        """The body with an id, or None; raises `TypeError` if the id is not an integer."""
        return self.world.bodies.get(integer(body_id, "bodyUniqueId"))

    def search(self) -> AssetSearch:
        """The directories that are searched for files."""
        return self.plugins.search(self.search_path, Client.latest_search_path)

    def set_search_path(self, path: Path) -> None:
        """Adds a search directory; other connections search it after their own."""
        self.search_path = Client.latest_search_path = path

    def set_timeout(self, seconds: float) -> None:
        """Does nothing: a world in the same process answers at once."""

    def close(self) -> None:
        """Stops background threads, finishes files, and frees the world with the last reference to it."""
        self.bodies.quick.close()
        if self.server is not None:
            self.server.close()
            self.server = None
        if self.clock is not None:
            self.clock.stop()
            self.clock = None
        self.logs.stop_all(self.world)
        self.plugins.remove_all_places()
        self.window.close()
        self.world.let_go()


closed_by_users: set[int] = set()
"""Ids of clients whose window the user has closed, until the script disconnects them or connects again."""

clients: dict[int, Client] = {}
"""Every client with a world in this process, by its id."""

remote_clients: dict[int, Remote] = {}
"""Every client with a world in another process, by its id."""

_being_connected: dict[int, object] = {}


def living_client(physics_client_id: Any) -> Client | None:
    """The client with an id, an integer; None if there is none, or its window was closed, which ends it."""
    number = integer(physics_client_id, "physicsClientId")
    client = clients.get(number)
    if client is not None and not client.window.is_open():
        forget(number)
        closed_by_users.add(number)
        return None
    return client


def why_not_connected(physics_client_id: Any) -> str:
    """Error message: the reason why there is no such connection."""
    if physics_client_id in closed_by_users:
        return f"The window of client {physics_client_id} has been closed."
    return f"There is no client {physics_client_id}: call connect(DIRECT) or connect(GUI) first."


def client_of(physics_client_id: Any) -> Client:
    """The client with an id; raises `pybullet.error` if there is none, `TypeError` if it is no integer."""
    client = clients.get(physics_client_id) if type(physics_client_id) is int else None
    if client is None or not client.window.is_open():
        client = living_client(physics_client_id)
    if client is None:
        fail(NOT_CONNECTED, why_not_connected(physics_client_id))
    return client


def connection_of(physics_client_id: Any) -> Client | Remote | None:
    """The client with an id, local or remote; None if there is none, or its server or window is gone."""
    number = integer(physics_client_id, "physicsClientId")
    client = remote_clients.get(number)
    if client is not None and not client.is_open():
        forget(number)
        return None
    return client or living_client(number)


def forget(number: int) -> None:
    """Closes a client and frees its id."""
    remove_detour(number)
    let_go(number)
    client = clients.pop(number, None) or remote_clients.pop(number, None)
    if client is not None:
        client.close()


@contextmanager
def free_slot() -> Iterator[int | None]:
    """The lowest free id, which nobody else gets meanwhile; None if there is none.

    Until the context is left nobody can know the id, and `is_being_connected` is true for it.
    """
    slot = next(filter(_claimed, range(MAX_CLIENTS)), None)
    try:
        yield slot
    finally:
        if slot is not None:
            _being_connected.pop(slot, None)


def is_being_connected(number: int) -> bool:
    """Whether an id belongs to a call of `connect` that has not returned yet."""
    return number in _being_connected


def _claimed(slot: int) -> bool:
    """Claims an id if it is free. Without a lock, because garbage collection can begin anywhere in here."""
    if slot in clients or slot in remote_clients:
        return False
    claim = object()
    if _being_connected.setdefault(slot, claim) is not claim:
        return False
    if slot in clients or slot in remote_clients:
        # Another thread has connected meanwhile.
        del _being_connected[slot]
        return False
    return True
