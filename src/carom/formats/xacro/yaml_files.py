"""YAML files that expressions load, by PyYAML where that is installed."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

from carom.files.budget import charge
from carom.formats.xacro.expression import evaluate
from carom.formats.xacro.functions import Namespace
from carom.formats.xacro.limits import Allowance, ExpressionError
from carom.formats.xacro.values import Value

_MAX_VALUES = 100_000
_DEEPEST = 18
_BYTES_PER_STEP = 4
_ANGLES = {"!degrees": math.pi / 180.0, "!radians": 1.0}


def load_yaml(data: bytes, file: Path) -> Value:
    """The content of a YAML file; its mappings are reached by `['name']` and `.name`.

    Raises:
        ExpressionError: It is broken, or PyYAML is not installed.
    """
    try:
        import yaml  # pyright: ignore
    except ImportError:
        raise ExpressionError(
            f"{file} is a YAML file, which needs PyYAML: pip install 'carom[xacro]'"
        ) from None

    class Loader(yaml.SafeLoader):
        """A loader of plain values, which also knows the angles of robot files."""

        def flatten_mapping(self, node: Any) -> None:
            """Merge what `<<` names; each level may name the one before twice."""
            super().flatten_mapping(node)
            charge("elements", len(node.value))

    def angle(factor: float) -> Any:
        def construct(loader: Any, node: Any) -> float:
            return factor * float(evaluate(str(loader.construct_scalar(node)), {}, Allowance()))

        return construct

    for tag, factor in _ANGLES.items():
        Loader.add_constructor(tag, angle(factor))
    charge("steps", len(data) // _BYTES_PER_STEP)
    try:
        content = yaml.load(data, Loader)
    except (yaml.YAMLError, ValueError, TypeError, RecursionError) as error:
        raise ExpressionError(f"{file} cannot be read: {' '.join(str(error).split())}") from None
    return _Plain(file).value(content, 0)


class _Plain:
    """Makes plain values of the content of a file; what several places share, it makes once for each."""

    def __init__(self, file: Path) -> None:
        self.file = file
        self.count = 0

    def value(self, content: Any, depth: int) -> Value:
        """The plain value of a content."""
        self.count += 1
        if self.count > _MAX_VALUES or depth > _DEEPEST:
            raise ExpressionError(
                f"{self.file} has more than {_MAX_VALUES} values, or is nested deeper than {_DEEPEST}"
            )
        if isinstance(content, dict):
            return Namespace({key: self.value(entry, depth + 1) for key, entry in content.items()})
        if isinstance(content, (list, tuple)):
            return [self.value(entry, depth + 1) for entry in content]
        return content if isinstance(content, (bool, int, float, str, type(None))) else str(content)
