"""The plugins that are part of PyBullet; only `fileIOPlugin` has an effect here."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from carom.errors import DescriptionError
from pybullet._calls.arguments import integer, real, sequence, text
from pybullet._calls.builtin import exported
from pybullet._calls.constants import AddFileIOAction, PosixFileIO, RemoveFileIOAction, ZipFileIO
from pybullet._calls.errors import logger
from pybullet._clients.clients import Client, client_of
from pybullet._clients.plugin_registry import BUILT_IN, EGL_RENDERER, FILE_IO, is_egl_renderer

__all__ = ["executePluginCommand", "loadPlugin", "unloadPlugin"]

_FAILED = -1
_BAD_NUMBERS = "expected a sequence of numbers"
# Advice for scripts that load or use a plugin without effect.
_INSTEAD = {
    "pdControlPlugin": "use setJointMotorControl2 with PD_CONTROL",
    "collisionFilterPlugin": "use setCollisionFilterPair",
    "tinyRendererPlugin": "use getCameraImage",
    "eglRendererPlugin": "getCameraImage needs neither a display nor a plugin",
}


@exported
def loadPlugin(pluginPath: str, postFix: str | None = None, physicsClientId: int = 0) -> int:
    """Loads a plugin that is part of PyBullet; plugins in separate libraries need PyBullet's engine.

    Args:
        pluginPath: `fileIOPlugin`, which lets files be found in zip archives; `pdControlPlugin`,
            `collisionFilterPlugin`, `tinyRendererPlugin` or the file of the module `eglRenderer`, whose
            functions Carom has without plugins.
        postFix: Not used.
        physicsClientId: The connection.

    Returns:
        The id of the plugin; -1, with a warning, for other plugins.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.loadPlugin("fileIOPlugin") >= 0
        True
    """
    client = client_of(physicsClientId)
    name = text(pluginPath, "pluginPath")
    if postFix is not None:
        text(postFix, "postFix")
    if is_egl_renderer(name):
        client.plugins.loaded.add(EGL_RENDERER)
        return EGL_RENDERER
    if name not in BUILT_IN:
        renderer = "eglRenderer" in name
        advice = (
            _INSTEAD["eglRendererPlugin"]
            if renderer
            else "libraries made for PyBullet's engine cannot be used"
        )
        logger.warning("loadPlugin: %r is not part of Carom; %s.", name, advice)
        return _FAILED
    client.plugins.loaded.add(BUILT_IN[name])
    return BUILT_IN[name]


@exported
def unloadPlugin(pluginUniqueId: int, physicsClientId: int = 0) -> None:
    """Unloads a plugin. One that is not loaded is no error; for `fileIOPlugin` its archives are removed.

    Args:
        pluginUniqueId: The plugin.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> plugin = p.loadPlugin("fileIOPlugin")
        >>> p.unloadPlugin(plugin)
    """
    client = client_of(physicsClientId)
    number = integer(pluginUniqueId, "pluginUniqueId")
    with client.call_lock:
        client.plugins.loaded.discard(number)
        if number == FILE_IO:
            client.plugins.remove_all_places()


@exported
def executePluginCommand(
    pluginUniqueId: int,
    textArgument: str | None = None,
    intArgs: Sequence[int] | None = None,
    floatArgs: Sequence[float] | None = None,
    physicsClientId: int = 0,
) -> int:
    """Sends a command to a plugin.

    The commands of `fileIOPlugin` are `[AddFileIOAction, ZipFileIO]`, to look for files in the zip archive
    `textArgument` as well, which is itself found like any file; `[AddFileIOAction, PosixFileIO]`, to look in
    the folder `textArgument`; and `[RemoveFileIOAction, slot]`, to look there no longer.

    Args:
        pluginUniqueId: The plugin.
        textArgument: Text argument of the command.
        intArgs: Integers of the command.
        floatArgs: Numbers of the command; not used.
        physicsClientId: The connection.

    Returns:
        The slot of the archive or folder that was added or removed; -1, with a warning, if the command cannot
        be executed.

    Raises:
        pybullet.error: Not connected, or an argument is not a sequence of numbers.

    Examples:
        >>> plugin = p.loadPlugin("fileIOPlugin")
        >>> p.executePluginCommand(plugin, "missing.zip", [p.AddFileIOAction, p.ZipFileIO])
        -1
    """
    client = client_of(physicsClientId)
    number = integer(pluginUniqueId, "pluginUniqueId")
    words = "" if textArgument is None else text(textArgument, "textArgument")
    integers = [integer(item, "intArgs") for item in _items(intArgs, "intArgs")]
    for item in _items(floatArgs, "floatArgs"):
        real(item, "floatArgs")
    with client.call_lock:
        if number in client.plugins.loaded and number == FILE_IO and len(integers) > 1:
            return _file_command(client, words, integers[0], integers[1])
    name = next((name for name, built_in in BUILT_IN.items() if built_in == number), None)
    advice = f"; {_INSTEAD[name]}" if name in _INSTEAD else ""
    logger.warning("executePluginCommand: plugin %d did nothing%s.", number, advice)
    return _FAILED


def _items(values: Any, name: str) -> tuple[Any, ...]:
    return () if values is None else sequence(values, _BAD_NUMBERS, name)


def _file_command(client: Client, name: str, action: int, kind: int) -> int:
    plugins = client.plugins
    if action == RemoveFileIOAction:
        plugins.remove_place(kind)
        return kind
    if action != AddFileIOAction or kind not in (PosixFileIO, ZipFileIO):
        logger.warning("executePluginCommand: fileIOPlugin cannot do [%d, %d].", action, kind)
        return _FAILED

    from carom.formats.archives import Archive

    path = Path(name) if kind == PosixFileIO else client.search().find(name)
    if path is None:
        logger.warning("executePluginCommand: there is no file %r.", name)
        return _FAILED
    slot = plugins.slot_of(path)
    if slot is not None:
        return slot
    try:
        return plugins.add_place(path if kind == PosixFileIO else Archive(path))
    except DescriptionError as problem:
        logger.warning("executePluginCommand: %s.", problem)
        return _FAILED
