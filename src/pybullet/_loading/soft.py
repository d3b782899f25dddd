"""Loading soft bodies into a world."""

from __future__ import annotations

from collections.abc import Callable
from os.path import isfile
from pathlib import Path
from typing import Any

from carom.description.pose import Pose
from carom.errors import CaromError
from carom.files.unpacking import appears
from pybullet._calls.arguments import Vector, integer, moderate, real, rotation, text, vector3
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._clients.clients import Client, client_of
from pybullet._clients.origins import FileLoad
from pybullet._loading.new_bodies import add_bodies

__all__ = ["loadSoftBody"]

_CANNOT_LOAD = "Cannot load soft body."
_DEFAULT_MASS, _DEFAULT_MARGIN = 1.0, 0.02
# Arguments that are numbers, and their conversion.
_PARAMETERS: dict[str, Callable[[Any, str], Any]] = {
    "scale": real,
    "mass": real,
    "collisionMargin": real,
    "useMassSpring": integer,
    "useBendingSprings": integer,
    "useNeoHookean": integer,
    "springElasticStiffness": real,
    "springDampingStiffness": real,
    "springDampingAllDirections": integer,
    "springBendingStiffness": real,
    "NeoHookeanMu": real,
    "NeoHookeanLambda": real,
    "NeoHookeanDamping": real,
    "frictionCoeff": real,
    "useSelfCollision": integer,
}


@exported
def loadSoftBody(
    fileName: str,
    basePosition: Vector | None = None,
    baseOrientation: Vector | None = None,
    scale: float = -1,
    mass: float = -1,
    collisionMargin: float = -1,
    useMassSpring: int = 0,
    useBendingSprings: int = 0,
    useNeoHookean: int = 0,
    springElasticStiffness: float = 1,
    springDampingStiffness: float = 0.1,
    springDampingAllDirections: int = 0,
    springBendingStiffness: float = 0.1,
    NeoHookeanMu: float = 1,
    NeoHookeanLambda: float = 1,
    NeoHookeanDamping: float = 0.1,
    frictionCoeff: float = 0,
    useFaceContact: int = 0,
    useSelfCollision: int = 0,
    repulsionStiffness: float = 0.5,
    simFileName: str = "",
    physicsClientId: int = 0,
) -> int:
    """Loads a soft body: the surface of an OBJ file as cloth, the tetrahedra of a VTK file as a solid.

    After `resetSimulation(RESET_USE_DEFORMABLE_WORLD)` the parameters define the material. Otherwise,
    surfaces become cloth that hardly stretches, and the parameters of springs have no effect.

    Args:
        fileName: The file, `.obj` or `.vtk` (text, legacy format); searched for as by `loadURDF`.
        basePosition: Position of the origin of its mesh [m].
        baseOrientation: Orientation of the mesh (x, y, z, w).
        scale: Factor on all lengths; 1 when not greater than 0.
        mass: Total mass [kg], distributed equally over the nodes; 1 when not greater than 0.
        collisionMargin: Distance at which nodes and faces rest on other surfaces [m]; 0.02 when not greater
            than 0.
        useMassSpring: 1 for springs along all edges.
        useBendingSprings: 1 for bending springs between nodes with a common neighbour as well.
        useNeoHookean: 1 for elastic tetrahedra (neo-Hookean material).
        springElasticStiffness: [N/m].
        springDampingStiffness: [N s/m].
        springDampingAllDirections: 1: springs damp all relative motion of their ends.
        springBendingStiffness: Of bending springs [N/m].
        NeoHookeanMu: [Pa]; for small strains the shear modulus is 3/4 of it.
        NeoHookeanLambda: [Pa]; for small strains Lamé's first parameter is this minus 5/8 of `NeoHookeanMu`.
        NeoHookeanDamping: Viscosity divided by these moduli [s].
        frictionCoeff: Coulomb coefficient, multiplied by that of the other body.
        useFaceContact: No effect, as in PyBullet: faces collide with rigid bodies, as nodes do, in any case.
        useSelfCollision: 1: its nodes collide with its own faces.
        repulsionStiffness: No effect: the force that keeps nodes off faces has no limit.
        simFileName: A separate mesh for the simulation; the mesh of `fileName` is then only drawn.
        physicsClientId: The connection.

    Returns:
        The id of the body; -1 if the name is empty.

    Raises:
        pybullet.error: Not connected, the file is missing or cannot be used (the message gives the reason
            after PyBullet's text), a parameter is negative or not finite, or the pose is not three and four
            finite numbers. The world is then unchanged.

    Examples:
        >>> p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
        >>> cloth = p.loadSoftBody("cloth_z_up.obj", basePosition=[0, 0, 1], mass=1, useMassSpring=1,
        ...     springElasticStiffness=40)
        >>> p.getDynamicsInfo(cloth, -1)[10]
        3
    """
    given = locals()
    name, simulated = text(fileName, "fileName"), text(simFileName, "simFileName")
    position, orientation = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
    if basePosition is not None:
        position = vector3(basePosition, "Cannot convert basePosition.", "basePosition")
    if baseOrientation is not None:
        orientation = rotation(baseOrientation, "Cannot convert baseOrientation.", "baseOrientation")
    numbers = {parameter: convert(given[parameter], parameter) for parameter, convert in _PARAMETERS.items()}
    real(repulsionStiffness, "repulsionStiffness")
    integer(useFaceContact, "useFaceContact")
    client = client_of(physicsClientId)
    if not name:
        return -1
    factor, weight, margin = numbers["scale"], numbers["mass"], numbers["collisionMargin"]
    sizes = {
        "scale": moderate(factor, _CANNOT_LOAD, "scale") if factor > 0.0 else 1.0,
        "mass": weight if weight > 0.0 else _DEFAULT_MASS,
        "margin": margin if margin > 0.0 else _DEFAULT_MARGIN,
    }
    path = _found(client, name)
    # As in PyBullet, the mesh for the simulation may be in the folder of the visible mesh.
    inside = _found(client, simulated, path.parent) if simulated else None

    from carom.soft.files import older_cloth_from_file, soft_body_from_file

    try:
        if client.deformable:
            spec = soft_body_from_file(path, simulated=inside, **sizes, **_material(numbers))
        else:
            spec = older_cloth_from_file(inside or path, **sizes)
    except CaromError as problem:
        fail(_CANNOT_LOAD, str(problem))
    load = FileLoad("loadSoftBody", {**numbers, "simFileName": simulated}, takes_pose=True)
    return add_bodies(client, [(spec, Pose(position, orientation))], _CANNOT_LOAD, load)[0]


def _material(numbers: dict[str, Any]) -> dict[str, Any]:
    """The arguments of `soft_body_from_file` for the material."""
    from carom.soft.materials import NeoHookean, Springs

    springs = solid = None
    if numbers["useMassSpring"]:
        bending = numbers["springBendingStiffness"] if numbers["useBendingSprings"] else 0.0
        stiffness, damping = numbers["springElasticStiffness"], numbers["springDampingStiffness"]
        springs = Springs(stiffness, damping, bending, numbers["springDampingAllDirections"] != 0)
    if numbers["useNeoHookean"]:
        solid = NeoHookean(numbers["NeoHookeanMu"], numbers["NeoHookeanLambda"], numbers["NeoHookeanDamping"])
    return {
        "friction": numbers["frictionCoeff"],
        "springs": springs,
        "solid": solid,
        "self_collision": numbers["useSelfCollision"] != 0,
    }


def _found(client: Client, name: str, beside: Path | None = None) -> Path:
    """Find a file in the search path, or else in the folder `beside`."""
    path = client.search().find(name)
    # `Path.is_file` raises an error for names that are too long.
    if path is None and beside is not None and (appears(beside / name) or isfile(beside / name)):
        path = beside / name
    if path is None:
        fail(_CANNOT_LOAD, f"The file {name!r} was not found.")
    return path
