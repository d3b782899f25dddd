"""Access control of the server.

By default the server listens on this machine only, but that is not enough: other users may work on the
machine, and any page in the user's browser could open a socket to the server, or reach it by a host name of
its own that resolves to this machine (DNS rebinding). So each request needs a token, which is part of the
address printed for the user; the browser then keeps it in a cookie. A request with the cookie, or with an
allowed host name, also has to name the server by a host that no other site can have, and a socket has to come
from the server's own page (origin). Behind a proxy, such as that of a notebook, host names differ: there the
token alone is enough.

*Spectators* have another token, which is computed from the first by a function that cannot be reversed. With
it a page is shown everything, and what it sends is not listened to, but for what it asks to be shown. No
cookie comes of it, and a request that has it is one of a spectator whatever cookies come with it.
"""

from __future__ import annotations

import hmac
import secrets
import socket
from base64 import urlsafe_b64encode
from dataclasses import dataclass, field
from ipaddress import ip_address
from urllib.parse import parse_qs, urlsplit

from carom.remote.user_token import fresh_token

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})
# No data is sent to this address: connecting to it makes the system choose this machine's network address.
_ANYWHERE = ("192.0.2.1", 9)
_EVERYWHERE = frozenset({"0.0.0.0", "::"})
# What the token of spectators is computed for, and how much of the result it has [bytes].
_FOR_SPECTATORS = b"carom spectators"
_TOKEN_BYTES = 16


@dataclass(frozen=True, slots=True)
class Access:
    """Access control of a server.

    Attributes:
        host: The address that the server listens on.
        token: The token that requests need.
        names: Additional host names of the server.
    """

    host: str = "127.0.0.1"
    token: str = field(default_factory=fresh_token)
    names: frozenset[str] = frozenset()

    def address(self, port: int) -> str:
        """The address to open in a browser: on this machine, or on any machine that can reach it."""
        return self._address(port, self.token)

    def spectator_address(self, port: int) -> str:
        """The address for those who watch and change nothing."""
        return self._address(port, self.spectator_token)

    def _address(self, port: int, token: str) -> str:
        host = reachable_host(self.host)
        name = f"[{host}]" if ":" in host else host
        return f"http://{name}:{port}/?token={token}"

    @property
    def spectator_token(self) -> str:
        """The token of spectators, by which nobody finds the other one if that is random."""
        digest = hmac.digest(self.token.encode(), _FOR_SPECTATORS, "sha256")
        return urlsafe_b64encode(digest[:_TOKEN_BYTES]).decode().rstrip("=")

    def may_connect(
        self, path: str, host_header: str | None, origin: str | None, cookies: str | None = None
    ) -> bool:
        """Whether a socket may be opened, by the path with the query, and three headers of the request."""
        if self.knows_token(path) or self.is_spectator(path):
            return True
        own = self.is_own(host_header) and origin_allowed(host_header, origin)
        return own and self.is_known(path, host_header, cookies)

    def may_read(self, path: str, host_header: str | None, cookies: str | None) -> bool:
        """Whether the page may be served, by the path with the query, and two headers of the request."""
        if self.knows_token(path) or self.is_spectator(path):
            return True
        return self.is_own(host_header) or self.has_cookie(cookies)

    def is_known(self, path: str, host_header: str | None, cookies: str | None) -> bool:
        """Whether a request has a token, the cookie, or a host name that the user has allowed."""
        named = _name(f"//{host_header}") in self.names
        return named or self.knows_token(path) or self.is_spectator(path) or self.has_cookie(cookies)

    @property
    def cookie(self) -> str:
        """The cookie for a browser that has sent the token."""
        return f"carom-{self.token[:4]}={self.token}"

    def has_cookie(self, cookies: str | None) -> bool:
        """Whether a browser has the cookie."""
        return any(
            secrets.compare_digest(cookie.encode(), self.cookie.encode())
            for cookie in (cookies or "").split("; ")
        )

    def is_own(self, host_header: str | None) -> bool:
        """Whether the host of a request is this server."""
        return host_allowed(self.host, host_header) or _name(f"//{host_header}") in self.names

    def knows_token(self, path: str) -> bool:
        """Whether a request has the token."""
        return secrets.compare_digest(_stated_token(path).encode(), self.token.encode())

    def is_spectator(self, path: str) -> bool:
        """Whether a request has the token of spectators."""
        return secrets.compare_digest(_stated_token(path).encode(), self.spectator_token.encode())

    def guesses_token(self, path: str) -> bool:
        """Whether a request has a wrong token: it is for another server, or a guess."""
        return bool(_stated_token(path)) and not self.knows_token(path) and not self.is_spectator(path)


def reachable_host(host: str) -> str:
    """An address at which a server bound to this host can be reached."""
    if host not in _EVERYWHERE:
        return host
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as way:
        try:
            way.connect(_ANYWHERE)
            return str(way.getsockname()[0])
        except OSError:
            return socket.gethostname()


def is_loopback(host: str) -> bool:
    """Whether a server bound to this host can be reached from this machine only."""
    if host in LOOPBACK_NAMES:
        return True
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False


def host_allowed(bound_to: str, host_header: str | None) -> bool:
    """Whether the host of a request is this server; its port may differ, as through an SSH tunnel."""
    name = _name(f"//{host_header}") if host_header else None
    if name is None:
        return False
    if name in LOOPBACK_NAMES or name == bound_to.lower():
        return True
    if is_loopback(bound_to):
        return False
    # Numeric addresses cannot be rebound; of names only those of this machine are allowed.
    machine = socket.gethostname().lower()
    return _is_address(name) or name in (machine, machine.partition(".")[0], socket.getfqdn().lower())


def origin_allowed(host_header: str | None, origin: str | None) -> bool:
    """Whether a socket comes from the server's own page. Only browsers send an origin."""
    if origin is None:
        return True
    parts = urlsplit(origin)
    return parts.scheme in ("http", "https") and parts.netloc.lower() == (host_header or "").lower()


def _stated_token(path: str) -> str:
    return parse_qs(urlsplit(path).query).get("token", [""])[0]


def _name(address: str) -> str | None:
    try:
        return urlsplit(address).hostname
    except ValueError:
        return None


def _is_address(name: str) -> bool:
    try:
        ip_address(name)
    except ValueError:
        return False
    return True
