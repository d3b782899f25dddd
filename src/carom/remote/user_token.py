"""A permanent token of a user on a machine, which no other user can read."""

from __future__ import annotations

import os
import secrets
from contextlib import suppress
from pathlib import Path

from carom.remote.errors import RemoteError
from carom.remote.private_folder import is_private, make_private, private_folder

TOKEN_BYTES = 16
_NAME = "token"
_MAX_SIZE = 64


def fresh_token() -> str:
    """A random token that cannot be guessed."""
    return secrets.token_urlsafe(TOKEN_BYTES)


def user_token() -> str:
    """The user's token, created by the first call.

    If the token cannot be saved, for example without a writable folder, each call returns another one.
    """
    folder = private_folder()
    path = folder / _NAME
    with suppress(OSError, RemoteError):
        make_private(folder)
        # The first process writes the token; all others read it.
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
        # Unlike `os.replace`, `os.link` never replaces an existing file.
        os.link(draft, path)
    finally:
        draft.unlink()


def _read(path: Path) -> str:
    with path.open("rb") as file:
        if not is_private(os.fstat(file.fileno())):
            raise RemoteError(f"{path} is not a file that only you can read; remove it.")
        return file.read(_MAX_SIZE).decode("ascii", "ignore").strip()
