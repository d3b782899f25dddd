"""Functions of PyBullet that this version of Carom does not have.

They exist, so that scripts which only name them run, and check their arguments' names; calling one raises
`pybullet.error`. The table below is all there is to them.
"""

from __future__ import annotations

import ast
from collections.abc import Callable
from inspect import Parameter, Signature
from typing import Any

from pybullet._calls.builtin import exported_as
from pybullet._calls.errors import fail

__all__ = [
    "loadSoftBody",
]


def _later(name: str, parameters: str) -> Callable[..., Any]:
    """A function that is not there yet.

    Args:
        name: Its name.
        parameters: Its parameters as they stand in a `def`.
    """
    signature = _signature(parameters)

    def unavailable(*arguments: Any, **keywords: Any) -> Any:
        try:
            signature.bind(*arguments, **keywords)
        except TypeError as problem:
            raise TypeError(f"{name}(): {problem}") from None
        fail(f"{name} is not available in this version of Carom, which has no soft bodies.")

    unavailable.__name__ = unavailable.__qualname__ = name
    unavailable.__doc__ = "Not available in this version of Carom: raises `pybullet.error`."
    return exported_as(str(signature))(unavailable)


def _signature(parameters: str) -> Signature:
    definition = ast.parse(f"def _({parameters}): ...").body[0]
    assert isinstance(definition, ast.FunctionDef)
    arguments = definition.args
    result = []
    defaults = [None] * (len(arguments.args) - len(arguments.defaults)) + list(arguments.defaults)
    for argument, default in zip(arguments.args, defaults, strict=True):
        result.append(_parameter(argument, default, Parameter.POSITIONAL_OR_KEYWORD))
    if arguments.vararg is not None:
        result.append(Parameter(arguments.vararg.arg, Parameter.VAR_POSITIONAL))
    for argument, default in zip(arguments.kwonlyargs, arguments.kw_defaults, strict=True):
        result.append(_parameter(argument, default, Parameter.KEYWORD_ONLY))
    return Signature(result)


def _parameter(argument: ast.arg, default: ast.expr | None, kind: Any) -> Parameter:
    value = Parameter.empty if default is None else ast.literal_eval(default)
    return Parameter(argument.arg, kind, default=value)


loadSoftBody: Callable[..., Any] = _later(
    "loadSoftBody",
    "fileName, basePosition=None, baseOrientation=None, scale=-1, mass=-1, collisionMargin=-1, "
    "useMassSpring=0, useBendingSprings=0, useNeoHookean=0, springElasticStiffness=1, "
    "springDampingStiffness=0.1, springDampingAllDirections=0, springBendingStiffness=0.1, "
    "NeoHookeanMu=1, NeoHookeanLambda=1, NeoHookeanDamping=0.1, frictionCoeff=0, useFaceContact=0, "
    'useSelfCollision=0, repulsionStiffness=0.5, simFileName="", physicsClientId=0',
)
