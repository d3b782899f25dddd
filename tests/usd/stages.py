"""Small stages as text."""

from __future__ import annotations

from pathlib import Path

HEADER = """#usda 1.0
(
    defaultPrim = "World"
    metersPerUnit = {unit}
    kilogramsPerUnit = {mass}
    upAxis = "{up}"
)
def Xform "World"
{{
{content}
}}
"""


def stage(folder: Path, content: str, *, unit: float = 1.0, mass: float = 1.0, up: str = "Z") -> Path:
    """Write a stage; statements of the content end with lines or with `;`."""
    content = content.replace(";", "\n").replace("}", "\n}\n")
    file = folder / "stage.usda"
    file.write_text(HEADER.format(unit=unit, mass=mass, up=up, content=content))
    return file


def prim(
    kind: str, name: str, content: str = "", apis: tuple[str, ...] = (), at: tuple[float, ...] = ()
) -> str:
    """A prim with applied schemas, at a place."""
    listed = ", ".join(f'"Physics{api}"' for api in apis)
    schemas = f"(prepend apiSchemas = [{listed}])" if apis else ""
    place = (
        f'double3 xformOp:translate = {at}; uniform token[] xformOpOrder = ["xformOp:translate"];'
        if at
        else ""
    )
    return f'def {kind} "{name}" {schemas}\n{{\n{place}{content}\n}}\n'


def body(name: str, content: str = "", at: tuple[float, ...] = (0, 0, 0), mass: float = 2.0) -> str:
    """A rigid body of a mass, with the same moment about each axis."""
    stated = f"float physics:mass = {mass}; float3 physics:diagonalInertia = (0.1, 0.1, 0.1);"
    return prim("Xform", name, stated + content, ("RigidBodyAPI", "MassAPI"), at)


def joint(kind: str, name: str, ends: str, content: str = "", apis: tuple[str, ...] = ()) -> str:
    """A joint between two bodies of the world, such as `"a b"`; `-` is the world."""
    rels = "".join(
        f"rel physics:body{number} = </World/{end}>;" for number, end in enumerate(ends.split()) if end != "-"
    )
    return prim(f"Physics{kind}Joint", name, rels + content, apis)
