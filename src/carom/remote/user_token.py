"""A token that stays the same for a user of a machine, and that no other user can read."""

from __future__ import annotations

import os
import secrets
from contextlib import suppress
from pathlib import Path

from carom.remote.errors import RemoteError
from carom.remote.private_folder import is_private, make_private, private_folder

TOKEN_BYTES = 16
_NAME = "token"
_GREATEST_SIZE = 64


def fresh_token() -> str:
    """A random token that cannot be guessed."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def user_token() -> str:
    """The user's token; made when it is first asked for.

    Where it cannot be kept, as without a place to write to, each call gives another one.
    """
    folder = private_folder()
    path = folder / _NAME
    with suppress(OSError, RemoteError):
        make_private(folder)
        # The first process writes it, and others read it.
        with suppress(FileExistsError):
            _write(path, fresh_token())
        if token := _read(path):
            return token
    return fresh_token()


def _write(path: Path, token: str) -> None:
    draft = path.with_name(f"{_NAME}-{os.getpid()}-{secrets.token_hex(4)}")
    handle = os.open(draft, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600)
    try:
        with os.fdopen(handle, "w", encoding="ascii") as file:
            file.write(token)
        # Unlike a replacement, a link never takes the place of a file that is there.
        os.link(draft, path)
    finally:
        draft.unlink()


def _read(path: Path) -> str:
    with path.open("rb") as file:
        if not is_private(os.fstat(file.fileno())):
            raise RemoteError(f"{path} is not a file that only you can read; remove it.")
        return file.read(_GREATEST_SIZE).decode("ascii", "ignore").strip()
