"""Rollouts on the nodes of a Ray cluster: a vector environment on each; losing a node changes no episode."""

from __future__ import annotations

try:
    import gymnasium as _gymnasium  # noqa: F401
    import ray as _ray  # noqa: F401  # pyright: ignore[reportMissingImports]
except ImportError as missing:
    raise ImportError(
        f"carom.cluster needs {missing.name}; install it with: pip install 'carom[ray]'", name=missing.name
    ) from missing

from carom.cluster.collection import Collection, Part, Reduction, Report, Steps
from carom.cluster.episode import Episode
from carom.cluster.errors import ClusterError, EpisodeError
from carom.cluster.policies import Policy, PolicyWithMemory
from carom.cluster.rollouts import Rollouts

__all__ = [
    "ClusterError",
    "Collection",
    "Episode",
    "EpisodeError",
    "Part",
    "Policy",
    "PolicyWithMemory",
    "Reduction",
    "Report",
    "Rollouts",
    "Steps",
]
