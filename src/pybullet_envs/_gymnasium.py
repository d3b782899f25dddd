"""Gymnasium, or a stand-in for it if it is not installed: made of its predecessor, gym, if there is that.

Scripts use parts of this package, such as robots, without any environment. These parts must not require
Gymnasium before it is needed: for an environment, or for the spaces of its actions and observations.
"""

from __future__ import annotations

from importlib.util import find_spec
from typing import TYPE_CHECKING, Any, NoReturn

from pybullet_envs import _old_gym

INSTALLED = find_spec("gymnasium") is not None


def _raise(*arguments: Any, **keywords: Any) -> NoReturn:
    raise ImportError(
        "the environments of pybullet_envs need Gymnasium; install it with: pip install 'carom[envs]'",
        name="gymnasium",
    )


def require_gymnasium() -> None:
    """Raises `ImportError`, with the command for installing it, if neither Gymnasium nor gym is installed."""
    if not INSTALLED and not _old_gym.INSTALLED:
        _raise()


class _Env:
    """Stand-in for `gymnasium.Env`: subclasses can be defined, but not instantiated."""

    __init__ = _raise

    def __class_getitem__(cls, item: Any) -> Any:
        return cls


class _Spaces:
    """Stand-in for `gymnasium.spaces`."""

    Box = Discrete = staticmethod(_raise)


class _StandIn:
    """The parts of Gymnasium that modules of this package use while they are imported."""

    Env = _Env
    spaces = _Spaces


if TYPE_CHECKING or INSTALLED:
    import gymnasium
    import gymnasium.utils.seeding
elif _old_gym.INSTALLED:
    gymnasium = _old_gym.stand_in()
else:
    gymnasium = _StandIn

__all__ = ["INSTALLED", "gymnasium", "require_gymnasium"]
