"""Texts with `${expression}` and `$(command ...)` in them."""

from __future__ import annotations

import os
import re
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path

from carom.formats.search import AssetSearch
from carom.formats.xacro.expression import evaluate
from carom.formats.xacro.functions import XACRO_FUNCTIONS, Namespace
from carom.formats.xacro.limits import Allowance, ExpressionError
from carom.formats.xacro.scope import Scope, Unevaluated
from carom.formats.xacro.values import Value, text_of
from carom.formats.xacro.yaml_files import load_yaml
from carom.logger import Logger

_log = Logger("carom.formats.xacro")
_PART = re.compile(r"\$\$+(?=[({])|\$\{|\$\(|[^$]+|\$")
_CLOSING = {"${": "}", "$(": ")"}
_OPENING = {"${": "{", "$(": "("}


class Texts:
    """Evaluates the texts of one document and all files that it includes.

    Args:
        search: Where packages and files are searched.
        given: Arguments that the user gave, by name.

    Attributes:
        arguments: All arguments known so far.
        file: The file whose text is evaluated now.
        read: Called with each further file that is read.
        is_lasting: Whether the results depend on files only, not on the environment.
        packages: Packages that were looked for, and the folder of each that was found.
    """

    def __init__(self, file: Path, search: AssetSearch, given: Mapping[str, str], budget: Allowance) -> None:
        self.file = file
        self.search = search
        self.budget = budget
        self.arguments: dict[str, str] = dict(given)
        self.used: set[str] = set()
        self.read: Callable[[Path], bytes] = Path.read_bytes
        self.is_lasting = True
        self.packages: dict[tuple[str, Path], Path | None] = {}

    def evaluate(self, text: str, scope: Scope) -> Value:
        """The value of a text; one that is a single expression keeps its type, others are texts."""
        if isinstance(text, Unevaluated):
            before, self.file = self.file, text.file
            try:
                return self._value(text, scope)
            finally:
                self.file = before
        return self._value(text, scope)

    def as_text(self, text: str, scope: Scope) -> str:
        """The text with all expressions and commands replaced."""
        if "$" not in text:
            return text
        result = text_of(self.evaluate(text, scope))
        self.budget.text(len(result))
        return result

    def _value(self, text: str, scope: Scope) -> Value:
        if "$" not in text:
            return str(text)
        # Each level of nesting goes through the text again.
        self.budget.step(len(text))
        results: list[Value] = []
        at = 0
        while at < len(text):
            match = _PART.match(text, at)
            assert match is not None
            part, at = match.group(), match.end()
            if part in _CLOSING:
                inside, at = _inside(text, at, part)
                work = self._expression if part == "${" else self._command
                results.append(work(inside, scope))
            elif part.startswith("$$"):
                # One of them goes, and what follows is a text.
                results.append(part[1:] + text[at])
                at += 1
            else:
                results.append(part)
        if len(results) == 1:
            return results[0]
        joined = "".join(map(text_of, results))
        self.budget.step(len(joined))
        return joined.replace("file://package://", "package://")

    def _expression(self, text: str, scope: Scope) -> Value:
        if "$" in text:
            text = text_of(self._value(text, scope))
        return evaluate(text, _Names(scope, self), self.budget)

    def _command(self, text: str, scope: Scope) -> Value:
        if "$" in text:
            text = text_of(self._value(text, scope))
        self.budget.step(len(text))
        words = text.split()
        name, values = (words[0], words[1:]) if words else ("", [])
        if name == "eval" and values:
            return evaluate(text.strip()[len("eval") :], _Names(scope, self, commands=True), self.budget)
        if name == "optenv" and values:
            return self.environment(values[0], " ".join(values[1:]))
        if name == "dirname" and not values:
            return str(self.file.parent)
        single = {"arg": self.argument, "find": self.find, "env": self.environment}.get(name)
        if single is None:
            raise ExpressionError(
                f"$({text[:60]}) is not known; there are arg, find, env, optenv, dirname and eval"
            )
        if len(values) != 1:
            raise ExpressionError(f"$({text[:60]}): {name} needs one name")
        return single(values[0])

    def argument(self, name: str) -> str:
        """An argument of the document."""
        self.used.add(name)
        if name not in self.arguments:
            known = ", ".join(self.arguments) or "none"
            raise ExpressionError(
                f"argument {name!r} has no value: give it by xacro_args={{{name!r}: ...}} (known: {known})"
            )
        return self.arguments[name]

    def find(self, package: str) -> str:
        """The folder of a package; `package://` and its name where it is not found."""
        key = package, self.file
        if key not in self.packages:
            self.packages[key] = self.search.find_package(package, self.file)
        found = self.packages[key]
        return f"package://{package}" if found is None else str(found)

    def environment(self, name: str, default: str | None = None) -> str:
        """A variable of the environment."""
        self.is_lasting = False
        value = os.environ.get(name, default)
        if value is None:
            raise ExpressionError(f"the environment variable {name!r} is not set")
        return value

    def located(self, name: str) -> Path | None:
        """The file of a name in the present file: relative to it, or in a package."""
        if name.startswith("package://"):
            return self.search.find_referenced(name, self.file)
        path = self.file.parent / name.removeprefix("file://")
        # `os.path`, for which names that no file can have are those of no file.
        return path if os.path.isfile(path) else None

    def yaml(self, name: str) -> Value:
        """The content of a YAML file."""
        path = self.located(name)
        if path is None:
            raise ExpressionError(f"there is no YAML file {name!r}")
        return load_yaml(self.read(path), path)

    def xacro_functions(self) -> Namespace:
        """The functions behind `xacro.` in expressions."""
        return Namespace(
            XACRO_FUNCTIONS,
            arg=self.argument,
            load_yaml=self.yaml,
            abs_filename=lambda name: str(self.located(name) or self.file.parent / name),
            message=lambda *texts: self._say(_log.info, texts),
            warning=lambda *texts: self._say(_log.warning, texts),
            error=lambda *texts: self._say(_log.warning, texts),
            fatal=_fail,
            print_location=lambda: "",
        )

    def _say(self, log: Callable[..., None], texts: tuple[Value, ...]) -> str:
        log("%s: %s", self.file, " ".join(text_of(text)[:200] for text in texts))
        return ""


class _Names(dict[str, Value]):
    """What an expression may name: properties, then functions that need the document."""

    def __init__(self, scope: Scope, texts: Texts, *, commands: bool = False) -> None:
        super().__init__(xacro=texts.xacro_functions(), load_yaml=texts.yaml)
        if commands:
            self.update(
                arg=texts.argument, find=texts.find, env=texts.environment, optenv=texts.environment,
                dirname=lambda: str(texts.file.parent),
            )  # fmt: skip
        self._scope = scope

    def __contains__(self, name: object) -> bool:
        return name in self._scope or super().__contains__(name)

    def __getitem__(self, name: str) -> Value:
        return self._scope[name] if name in self._scope else super().__getitem__(name)

    def __iter__(self) -> Iterator[str]:
        yield from self._scope
        yield from super().__iter__()


def _inside(text: str, at: int, opening: str) -> tuple[str, int]:
    """The text up to the bracket that closes one, and where the rest begins."""
    deep, closing, other = 1, _CLOSING[opening], _OPENING[opening]
    for end in range(at, len(text)):
        if text[end] == closing:
            deep -= 1
        elif text[end] == other:
            deep += 1
        if not deep:
            return text[at:end], end + 1
    raise ExpressionError(f"{text[at - 2 : at + 40]!r} is never closed by {closing!r}")


def _fail(*texts: Value) -> Value:
    raise ExpressionError(" ".join(text_of(text)[:200] for text in texts))
