"""`<compiler>`: how the rest of the file is to be understood."""

from __future__ import annotations

from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import ALWAYS, AUTO, NEVER, CompiledContext
from carom.formats.robot.context import shown


def read_compiler(context: CompiledContext, element: Element) -> None:
    """Read a `<compiler>`; of several, the last that states an option counts."""
    options, attributes = context.compiler, element.attributes
    options.degrees = _choice(context, element, "angle", ("radian", "degree"), options.degrees)
    options.global_frames = _choice(
        context, element, "coordinate", ("local", "global"), options.global_frames
    )
    sequence = attributes.get("eulerseq", options.euler_sequence)
    if len(sequence) != 3 or set(sequence.lower()) - set("xyz"):
        raise context.error(element, f"eulerseq={shown(sequence)} needs three of x, y, z, X, Y and Z")
    options.euler_sequence = sequence
    assets = attributes.get("assetdir")
    options.mesh_directory = attributes.get("meshdir", options.mesh_directory if assets is None else assets)
    options.texture_directory = attributes.get(
        "texturedir", options.texture_directory if assets is None else assets
    )
    options.auto_limits = context.flag(element, attributes, "autolimits", options.auto_limits)
    options.strip_path = context.flag(element, attributes, "strippath", options.strip_path)
    options.fit_bounds = context.flag(element, attributes, "fitaabb", options.fit_bounds)
    options.align_free = context.flag(element, attributes, "alignfree", options.align_free)
    options.balance = context.flag(element, attributes, "balanceinertia", options.balance)
    options.from_geoms = attributes.get("inertiafromgeom", options.from_geoms)
    if options.from_geoms not in (AUTO, ALWAYS, NEVER):
        raise context.error(
            element, f"inertiafromgeom={shown(options.from_geoms)} must be auto, true or false"
        )
    options.least_mass = context.number(element, attributes, "boundmass", options.least_mass)
    options.least_inertia = context.number(element, attributes, "boundinertia", options.least_inertia)
    total = context.number(element, attributes, "settotalmass", -1.0)
    if total > 0.0:
        options.total_mass = total
    if "inertiagrouprange" in attributes:
        first, last = context.numbers(element, "inertiagrouprange", attributes["inertiagrouprange"], 2, 2)
        options.group_range = (int(first), int(last))


def _choice(
    context: CompiledContext, element: Element, name: str, words: tuple[str, str], default: bool
) -> bool:
    """Whether an attribute is the second of two words."""
    text = element.attributes.get(name)
    if text is None:
        return default
    if text not in words:
        raise context.error(element, f"{name}={shown(text)} must be {words[0]} or {words[1]}")
    return text == words[1]
