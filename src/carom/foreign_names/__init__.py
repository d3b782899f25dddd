"""Names that other simulators have for what Carom has under another one, for messages of errors."""

from __future__ import annotations

from types import ModuleType

from carom.foreign_names.of_bodies import PARTS, SET_BY
from carom.foreign_names.of_calls import ARGUMENTS as ARGUMENTS
from carom.foreign_names.of_calls import CALLS as CALLS
from carom.foreign_names.of_calls import INDEXED as INDEXED
from carom.foreign_names.of_calls import MODULES as MODULES
from carom.foreign_names.of_worlds import CAMERA, DESCRIPTION, IMAGE, MANY, PART, SCENE, WORLD

_MUJOCO = "`python -m carom docs from-mujoco` says what corresponds to what"

# What is done before a world becomes many.
_BEFORE = ("load", "add_", "constrain", "remove", "clear")

FOREIGN: dict[str, dict[str, str]] = {
    **PARTS,
    "World": WORLD,
    "Scene": SCENE,
    "Camera": CAMERA,
    "CameraImage": IMAGE,
    "Images": IMAGE,
    "Description": DESCRIPTION,
    "Part": PART,
}
for _many, _one in (
    ("Worlds", "World"),
    ("BodyBatch", "Body"),
    ("JointBatch", "Joint"),
    ("JointGroup", "Joints"),
    ("JointGroupBatch", "Joints"),
    ("LinkBatch", "Link"),
):
    FOREIGN[_many] = FOREIGN[_one]
    SET_BY.setdefault(_many, SET_BY.get(_one, {}))
SET_BY["ActuatorBatch"] = SET_BY["BodyActuator"]
FOREIGN["ActuatorBatch"] = FOREIGN["BodyActuator"]
FOREIGN["ShapeBatch"] = FOREIGN["BodyShape"]
FOREIGN["SensorBatch"] = FOREIGN["BodySensor"]
FOREIGN["Worlds"] = {
    name: f"{meant} of the world, before Worlds(world, count)" if meant.startswith(_BEFORE) else meant
    for name, meant in WORLD.items()
} | MANY


def attribute_error(it: object, name: str) -> AttributeError:
    """The error of an attribute that something does not have, with the one that was probably meant."""
    said = f"{type(it).__name__} has no attribute {name!r}"
    meant = foreign(it, name)
    if meant is not None:
        return AttributeError(f"{said}; here: {meant}")
    near = similar(it, name)
    return AttributeError(said if near is None else f"{said}; did you mean {near!r}?")


def foreign(it: object, name: str) -> str | None:
    """What is here under another name, if others have it under this one.

    Args:
        it: An object of Carom, a class of it or a module.
        name: The attribute that it does not have.
    """
    if isinstance(it, ModuleType):
        return MODULES.get(it.__name__, {}).get(name) or (_MUJOCO if name.startswith("mj") else None)
    kinds = it.__mro__ if isinstance(it, type) else type(it).__mro__
    found = (FOREIGN.get(base.__name__, {}).get(name) for base in kinds)
    meant = next((meant for meant in found if meant is not None), None)
    if meant is None and kinds[0].__name__ == "Part":
        return f"part[{name!r}], if it is an attribute of MJCF"
    return meant


def similar(it: object, name: str) -> str | None:
    """The attribute for users whose name is most alike, if any is."""
    if name[0] == "_":
        return None
    from difflib import get_close_matches

    from carom.internal_names import INTERNAL

    kind = type(it)
    hidden = {known for base in kind.__mro__ for known in INTERNAL.get(base.__name__, ())}
    own = getattr(it, "__dict__", {})
    there = [known for known in {*dir(kind), *own} - hidden if known[0] != "_"]
    near = get_close_matches(name, sorted(there), 1)
    return near[0] if near else None
