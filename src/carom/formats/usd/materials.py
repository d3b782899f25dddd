"""Materials of USD: friction, restitution and density of colliders, and colours."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from carom.description import ContactParameters, Material
from carom.formats.usd.stage import Stage

_USUAL = 0.5
"""Coefficient of friction where no material is bound."""


@dataclass(frozen=True, slots=True)
class Surface:
    """A physics material.

    Attributes:
        friction: Coefficient of friction.
        restitution: Coefficient of restitution.
        density: [kg/m³]; 0 for none.
    """

    friction: float = _USUAL
    restitution: float = 0.0
    density: float = 0.0

    @property
    def contact(self) -> ContactParameters:
        """What it means for contacts: of two surfaces the greater friction counts."""
        return ContactParameters(
            lateral_friction=self.friction, restitution=self.restitution, friction_rank=1
        )


def read_surface_of(stage: Stage, prim: Any) -> Surface:
    """The physics material bound to a collider; raises `DescriptionError` if a number is negative."""
    material = _bound(stage, prim, "physics")
    if material is None or not material.HasAPI(stage.pxr.UsdPhysics.MaterialAPI):
        return Surface()
    names = ("staticFriction", "dynamicFriction", "restitution", "density")
    values = [stage.number(material, f"physics:{name}", 0.0) for name in names]
    for name, value in zip(names, values, strict=True):
        if not 0.0 <= value < float("inf"):
            raise stage.error(material, f"physics:{name} is {value:g}; expected 0 or more")
    still, sliding, restitution, density = values
    if still != sliding and stage.is_stated(material, "physics:staticFriction"):
        stage.leave_out(
            material,
            "the dynamic friction counts at rest too",
            "surfaces have one coefficient",
            "physics:staticFriction",
        )
    return Surface(sliding, restitution, density * stage.mass_unit / stage.unit**3)


def read_colour(stage: Stage, prim: Any) -> Material | None:
    """The colour of a shape: of its preview surface, else its `displayColor`; None if there is none."""
    opacity = 1.0
    material = _bound(stage, prim, "")
    if material is not None:
        shader = stage.pxr.UsdShade.Material(material).ComputeSurfaceSource()[0]
        if shader:
            given = shader.GetPrim()
            colour = stage.value(given, "inputs:diffuseColor")
            opacity = stage.number(given, "inputs:opacity", 1.0)
            if colour is not None:
                return Material(str(material.GetName()), (*map(float, colour), opacity))  # pyright: ignore
    colours, opacities = (
        stage.value(prim, f"primvars:{name}") for name in ("displayColor", "displayOpacity")
    )
    if not colours:
        return None
    if opacities:
        opacity = float(opacities[0])
    red, green, blue = map(float, colours[0])
    return Material("", (red, green, blue, opacity))


def _bound(stage: Stage, prim: Any, purpose: str) -> Any | None:
    """The prim of the material bound for a purpose, directly, by a collection or from above."""
    for it in stage.above(prim):
        for name in ("material:binding", "material:binding:physics"):
            stage.note(it, name)
    binding = stage.pxr.UsdShade.MaterialBindingAPI(prim)
    material, _ = binding.ComputeBoundMaterial(purpose) if purpose else binding.ComputeBoundMaterial()
    return material.GetPrim() if material else None
