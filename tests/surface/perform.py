"""Makes the calls of a function, each in a scene of its own, and tells what came of them."""

from __future__ import annotations

from typing import Any

from .call import Call, Calls
from .observe import observe
from .scene import ROOT, build

DIGITS = 7


class Places:
    """What stands for folders in arguments and results.

    Args:
        folder: An empty one.
    """

    def __init__(self, folder: str) -> None:
        self._folders = {"<repo>": str(ROOT), "<temp>": folder}

    def real(self, value: Any) -> Any:
        """With the folders of this machine."""
        if isinstance(value, str):
            for sign, folder in self._folders.items():
                value = value.replace(sign, folder)
        elif isinstance(value, list):
            value = [self.real(item) for item in value]
        return value

    def general(self, text: str) -> str:
        """Without them."""
        for sign, folder in self._folders.items():
            text = text.replace(folder, sign)
        return text


def layout_of(value: Any) -> str:
    """Types and lengths: `(int, 3 float, bytes)`."""
    if isinstance(value, tuple):
        return f"({_items(value)})"
    if isinstance(value, list):
        return f"[{_items(value)}]"
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {layout_of(item)}" for key, item in value.items()) + "}"
    if hasattr(value, "dtype"):
        return f"{value.dtype} array {'x'.join(map(str, value.shape))}"
    return type(value).__name__


def _items(values: Any) -> str:
    runs: list[list[Any]] = []
    for layout in map(layout_of, values):
        if runs and runs[-1][1] == layout:
            runs[-1][0] += 1
        else:
            runs.append([1, layout])
    return ", ".join(layout if count == 1 else f"{count} {layout}" for count, layout in runs)


def plain(value: Any, places: Places) -> Any:
    """The same in what JSON has, floats with as many digits as are compared."""
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}")
    if isinstance(value, bytes):
        return places.general(value.decode("latin-1"))
    if isinstance(value, str):
        return places.general(value)
    if isinstance(value, (tuple, list)):
        return [plain(item, places) for item in value]
    if isinstance(value, dict):
        return {str(key): plain(item, places) for key, item in value.items()}
    if hasattr(value, "dtype"):
        return "array"
    return value


def prepare(p: Any, calls: Calls, places: Places) -> None:
    """Connects, makes the scene, and does what comes first."""
    p.connect(p.DIRECT)
    build(p)
    for function, *arguments in calls.first:
        getattr(p, function)(*places.real(arguments))


def outcome_of(p: Any, function: str, call: Call, places: Places) -> dict[str, Any]:
    """What a call returns or raises, in a scene that is prepared."""
    arguments = places.real(list(call.arguments))
    keywords = {name: places.real(value) for name, value in call.keywords.items()}
    try:
        result = getattr(p, function)(*arguments, **keywords)
    except Exception as problem:  # whatever it is, it is what is recorded
        kind = type(problem)
        name = "pybullet.error" if kind.__name__ == "error" else kind.__name__
        return {"raises": name, "text": places.general(str(problem))}
    return {"returns": layout_of(result), "value": plain(result, places)}


def tried(p: Any, function: str, calls: Calls, call: Call, places: Places) -> dict[str, Any]:
    """What a call returns or raises, and all that can be seen afterwards."""
    prepare(p, calls, places)
    try:
        result = outcome_of(p, function, call, places)
        result["seen"] = plain(observe(p), places)
        return result
    finally:
        for client in range(4):
            if p.isConnected(client):
                p.disconnect(client)


def untouched(p: Any, calls: Calls, places: Places) -> dict[str, Any]:
    """All that can be seen when the function is not called."""
    prepare(p, calls, places)
    try:
        return plain(observe(p), places)
    finally:
        p.disconnect()


def changed(before: dict[str, Any], after: dict[str, Any]) -> dict[str, Any]:
    """What is not as before; what has gone is None."""
    return {
        name: after.get(name)
        for name in sorted({*before, *after})
        if before.get(name, "none") != after.get(name, "none")
    }
