"""Gymnasium, or what stands in for it where it is not installed.

Scripts use parts of this package, such as robots, without any environment. These must not ask for Gymnasium
before it is needed: for an environment, or for the spaces of its actions and observations.
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, NoReturn

INSTALLED = find_spec("gymnasium") is not None


def _raise(*arguments: Any, **keywords: Any) -> NoReturn:
    raise ImportError(
        "the environments of pybullet_envs need Gymnasium; install it with: pip install carom[envs]",
        name="gymnasium",
    )


def require_gymnasium() -> None:
    """Raises `ImportError`, with the cure, where Gymnasium is not installed."""
    if not INSTALLED:
        _raise()


class _Env:
    """Base class of environments, which cannot be made."""

    __init__ = _raise

    def __class_getitem__(cls, item: Any) -> Any:
        return cls


class _Spaces:
    """Where the spaces should be."""

    Box = Discrete = staticmethod(_raise)


class _StandIn:
    """What the modules of this package use of Gymnasium while they are imported."""

    Env = _Env
    spaces = _Spaces


if TYPE_CHECKING or INSTALLED:
    import gymnasium
else:
    gymnasium = _StandIn

__all__ = ["INSTALLED", "gymnasium", "require_gymnasium"]
