"""Suggestions for misspelt arguments and attributes, printed below the error that ends a script."""

from __future__ import annotations

import sys
from collections.abc import Callable
from types import ModuleType, TracebackType
from typing import Any

_UNKNOWN = r"^([\w.]+)\(\) got an unexpected keyword argument '(\w+)'"
_MISSING = r"^([\w.]+)\(\) missing \d+ required "
_NO_ATTRIBUTE = r"^'(\w+)' object has no attribute '(\w+)'"
_NOT_CALLED = r"^'(\w+)' object is not callable$"
_READ_ONLY = r"^property '(\w+)' of '(\w+)' object has no setter$"
_PACKAGES = ("carom", "pybullet")
_LIKENESS = 0.6

Hook = Callable[[type[BaseException], BaseException, TracebackType | None], Any]


def suggestion(problem: BaseException) -> str | None:
    """The argument or attribute that was probably meant; None for other errors, and if no name is similar.

    Computed only after a script has failed, so calls take no longer.
    """
    if isinstance(problem, AttributeError):
        return _attribute(problem)
    if not isinstance(problem, TypeError):
        return None
    import re

    if called := re.match(_NOT_CALLED, str(problem)):
        from carom.foreign_names import INDEXED

        return INDEXED.get(called[1])
    if str(problem).endswith("object cannot be interpreted as an integer") and _is_raised_by_step(problem):
        from carom.foreign_names import CALLS

        return CALLS["Stepping.step"]
    if lacking := re.match(_MISSING, str(problem)):
        from carom.foreign_names import CALLS

        return CALLS.get(lacking[1])
    found = re.match(_UNKNOWN, str(problem))
    if found is None:
        return None
    function = _function_called(found[1])
    return None if function is None else _argument(function, found[1], found[2])


def _is_raised_by_step(problem: BaseException) -> bool:
    """Whether an error comes from the very function that steps a world, or many."""
    last = problem.__traceback__
    while last is not None and last.tb_next is not None:
        last = last.tb_next
    if last is None:
        return False
    frame = last.tb_frame
    return frame.f_code.co_name == "step" and str(frame.f_globals.get("__name__")).startswith("carom.")


def _argument(function: Callable[..., Any], called: str, given: str) -> str:
    """The argument of a function for one that it does not have, or all of them."""
    import inspect
    from difflib import get_close_matches

    from carom.foreign_names import ARGUMENTS, CALLS

    names = [name for name in inspect.signature(function).parameters if name != "self"]
    meant = next((name for name in ARGUMENTS.get(given, ()) if name in names), None)
    if meant is not None:
        return f"Did you mean {meant!r}?"
    if called in CALLS:
        return CALLS[called]
    # The parameter with the highest similarity ratio of `difflib`.
    near = get_close_matches(given, names, 1, _LIKENESS)
    return f"Did you mean {near[0]!r}?" if near else f"Its arguments are {', '.join(names)}."


def _attribute(problem: AttributeError) -> str | None:
    """What is here for an attribute that an object of Carom does not have, or what sets one that it has."""
    import re

    it, name = problem.obj, problem.name
    read_only = re.match(_READ_ONLY, str(problem))
    if read_only is not None:
        from carom.foreign_names import SET_BY

        setter = SET_BY.get(read_only[2], {}).get(read_only[1])
        return None if setter is None else f"It is set by {setter}."
    if name is None:
        # Objects with slots do not say what they are when an attribute is set.
        from carom.foreign_names import FOREIGN

        unknown = re.match(_NO_ATTRIBUTE, str(problem))
        meant = None if unknown is None else FOREIGN.get(unknown[1], {}).get(unknown[2])
        return None if meant is None else f"Here: {meant}."
    if not _is_ours(it) or hasattr(type(it), name):
        return None
    from carom.foreign_names import foreign, similar

    meant = foreign(it, name)
    if meant is not None:
        return f"Here: {meant}."
    if isinstance(it, (type, ModuleType)):
        # Python itself, or the module, says what is alike.
        return None
    near = similar(it, name)
    return None if near is None else f"Did you mean {near!r}?"


def _is_ours(it: object) -> bool:
    """Whether something is of Carom: an object, a class or a module."""
    home = (
        it.__name__ if isinstance(it, ModuleType) else (it if isinstance(it, type) else type(it)).__module__
    )
    return home.partition(".")[0] in _PACKAGES


def install() -> None:
    """Add suggestions to the errors that Python or a notebook prints; calling it again changes nothing."""
    _install_in_notebook()
    if getattr(sys.excepthook, "suggests", False):
        return
    before: Hook = sys.excepthook

    def hook(kind: type[BaseException], problem: BaseException, traceback: TracebackType | None) -> None:
        before(kind, problem, traceback)
        said = suggestion(problem)
        # Python itself names attributes that are alike.
        if said and not (kind is AttributeError and said.startswith("Did you mean")):
            print(said, file=sys.stderr)

    hook.suggests = True  # pyright: ignore[reportFunctionMemberAccess]
    sys.excepthook = hook


def _install_in_notebook() -> None:
    ipython: Any = sys.modules.get("IPython")
    shell = None if ipython is None else ipython.get_ipython()
    if shell is None or shell.custom_exceptions:
        return

    def show(
        shell: Any,
        kind: type[BaseException],
        problem: BaseException,
        traceback: TracebackType | None,
        tb_offset: int | None = None,
    ) -> None:
        shell.showtraceback((kind, problem, traceback), tb_offset=tb_offset)
        if said := suggestion(problem):
            print(said, file=sys.stderr)

    shell.set_custom_exc((TypeError, AttributeError), show)


def _function_called(name: str) -> Callable[..., Any] | None:
    """The function of Carom or the drop-in with this qualified name."""
    for module_name in sorted(sys.modules):
        if module_name.partition(".")[0] not in _PACKAGES:
            continue
        found: Any = sys.modules[module_name]
        for part in name.split("."):
            found = getattr(found, "__dict__", {}).get(part)
            if found is None:
                break
        if callable(found):
            return found
    return None
