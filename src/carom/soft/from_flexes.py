"""Flexes of MJCF files as soft bodies."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from carom.soft.build import soft_body
from carom.soft.materials import NeoHookean
from carom.soft.ties import Ties

if TYPE_CHECKING:
    from pathlib import Path

    from carom.description.pose import Pose
    from carom.formats.mjcf.compiled.flexes.flex import FileFlex
    from carom.formats.mjcf.compiled.model import CompiledModel
    from carom.model.body_spec import BodySpec

# Nodes that touch nothing have this margin [m].
_LEAST_MARGIN = 1e-6
_CORNERS_OF_SOLIDS = 4


def flex_bodies(model: CompiledModel, source: Path) -> list[tuple[BodySpec, Pose]]:
    """The soft bodies of a file, and the world poses of their frames; raises `DescriptionError`."""
    time_step = model.options["timestep"]
    return [(_body(flex, source, time_step), flex.pose) for flex in model.flexes]


def _body(flex: FileFlex, source: Path, time_step: float) -> BodySpec:
    held = np.zeros(len(flex.nodes), np.bool_)
    held[list(flex.pins)] = True
    ties = Ties(flex.nodes, flex.cells, held)
    ties.add_edges(flex.edge_stiffness, flex.edge_damping)
    if flex.edges is not None:
        ties.add_constraint(flex.edges, flex.masses, time_step)
    solid = None
    if flex.young and flex.cells.shape[1] == _CORNERS_OF_SOLIDS:
        solid = NeoHookean.of(flex.young, flex.poisson, flex.damping)
    elif flex.young:
        ties.add_membrane(flex.young, flex.damping)
    spec = soft_body(
        flex.name,
        flex.nodes,
        flex.cells,
        mass=float(flex.masses.sum()),
        solid=solid,
        margin=max(flex.radius, _LEAST_MARGIN),
        friction=flex.friction,
        self_collision=flex.self_collision,
        source=source,
    )
    assert spec.soft is not None
    spec.soft.masses = flex.masses.copy()
    spec.soft.springs, spec.soft.spring_terms = ties.made()
    if flex.material is not None:
        spec.soft.checkered = False
        spec.base.visuals = tuple(replace(it, material=flex.material) for it in spec.base.visuals)
    return spec
