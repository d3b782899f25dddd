"""Models and meshes that files name on the network, as those that have been downloaded."""

from __future__ import annotations

from urllib.parse import unquote

_SCHEMES = ("http://", "https://")
_FILES = "/files/"


def is_remote(uri: str) -> bool:
    """Whether a URI is on the network."""
    return uri.startswith(_SCHEMES)


def local_name(uri: str) -> str:
    """The `model://` URI that a model or one of its files has in a directory of downloaded models.

    Such URIs are `https://SERVER/VERSION/OWNER/models/NAME`, then the version of the model and `files/` with
    the path of a file in it.
    """
    _, _, rest = unquote(uri).rstrip("/").partition("/models/")
    name, _, _ = rest.partition("/")
    _, _, file = rest.partition(_FILES)
    return f"model://{name}/{file}".rstrip("/")
