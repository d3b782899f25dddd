"""Who may talk to the server.

The server listens on this machine alone unless it is told otherwise, but that is not enough: any page in the
user's browser could open a socket to it, or reach it under a name of its own that it lets point here. So a
request has to name the server by an address no other site can have, and a socket has to come from the
server's own page.
"""

from __future__ import annotations

import socket
from ipaddress import ip_address
from urllib.parse import urlsplit

LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "::1"})


def is_loopback(host: str) -> bool:
    """Whether a server bound to this host can be reached from this machine only."""
    if host in LOOPBACK_NAMES:
        return True
    try:
        return ip_address(host).is_loopback
    except ValueError:
        return False


def host_allowed(bound_to: str, host_header: str | None) -> bool:
    """Whether a request names this server.

    Args:
        bound_to: Host the server was told to listen on.
        host_header: `Host` of the request. Its port may differ, as it does through an SSH tunnel.
    """
    name = _name(f"//{host_header}") if host_header else None
    if name is None:
        return False
    if name in LOOPBACK_NAMES or name == bound_to.lower():
        return True
    if is_loopback(bound_to):
        return False
    # Addresses cannot be made to point elsewhere; of names only those of this machine count.
    machine = socket.gethostname().lower()
    return _is_address(name) or name in (machine, machine.partition(".")[0], socket.getfqdn().lower())


def origin_allowed(host_header: str | None, origin: str | None) -> bool:
    """Whether a socket comes from the server's own page. Programs that are no browsers name no origin."""
    if origin is None:
        return True
    parts = urlsplit(origin)
    return parts.scheme in ("http", "https") and parts.netloc.lower() == (host_header or "").lower()


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
