"""State of a reading of MJCF as MuJoCo compiles it: double precision, all options of the compiler."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from carom.description import ContactParameters, Heightfield
from carom.description.texture import Texture
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.shapes.mesh_mass import Hull
from carom.formats.mjcf.context import CompilerOptions, MjcfContext
from carom.formats.reading.cursor import layered
from carom.formats.robot.context import shown
from carom.formats.search import AssetSearch

AUTO, ALWAYS, NEVER = "auto", "true", "false"
LAST_GROUP = 5
# Of these a file may state the first numbers only; the others are then those of the defaults.
_PARTLY_STATED = frozenset((
    "biasprm", "damping", "dynprm", "fluidcoef", "friction", "gainprm", "gear", "size", "solimp",
    "solimpfriction", "solimplimit", "solref", "solreffriction", "solreflimit", "stiffness", "surfacevel",
))  # fmt: skip
# These may not be blank.
_WORDS = frozenset(("class", "childclass", "type"))
_INFINITE = ("inf", "infinity")


@dataclass
class Compiler(CompilerOptions):
    """The options of `<compiler>`, with MuJoCo's defaults.

    Attributes:
        from_geoms: `auto`: bodies without `<inertial>` get their inertia from geoms; `true`: all do; `false`:
            none does.
        group_range: First and last group of geoms that have mass.
        balance: Moments that no body has become their mean.
        least_mass: Lower bound of masses of bodies [kg].
        least_inertia: Lower bound of principal moments [kg m²].
        total_mass: Mass to which that of all bodies is scaled [kg]; None for as it is.
        fit_bounds: Primitive geoms are fitted to the bounds of a mesh, not to its inertia.
        texture_directory: Prefix of the file names of textures.
        strip_path: Only the last parts of file names count.
        align_free: Frames of free bodies are put at their centres of mass.
    """

    degrees: bool = True
    auto_limits: bool = True
    from_geoms: str = AUTO
    group_range: tuple[int, int] = (0, LAST_GROUP)
    balance: bool = False
    least_mass: float = 0.0
    least_inertia: float = 0.0
    total_mass: float | None = None
    fit_bounds: bool = False
    texture_directory: str = ""
    strip_path: bool = False
    align_free: bool = False


@dataclass
class NamedAssets:
    """Elements of `<asset>` by name: meshes, materials, textures and height fields."""

    mesh: dict[str, Element] = field(default_factory=dict)
    material: dict[str, Element] = field(default_factory=dict)
    texture: dict[str, Element] = field(default_factory=dict)
    hfield: dict[str, Element] = field(default_factory=dict)


class CompiledContext(MjcfContext):
    """State of one reading of an MJCF file, or of one that it attaches.

    Attributes:
        compiler: Options of `<compiler>`.
        named: Assets by name.
        attached: Contexts of the models that it attaches, by name: that of the asset, or the model's own.
        hull: Makes convex hulls.
        textures: What has been read of textures, by the `id` of the element, with the element.
        terrains: Height fields that have been read, by size and file, or by size and `id` of the element.
        contacts: How geoms touch others, by the texts of their attributes.
        latest: The element whose attributes were looked for last, its class of defaults, and these.
    """

    def __init__(self, file: Path, root: Element, search: AssetSearch, hull: Hull) -> None:
        super().__init__(file, root, search)
        self.hull: Hull = hull
        self.compiler: Compiler = Compiler()  # pyright: ignore[reportIncompatibleVariableOverride]
        self.named: NamedAssets = NamedAssets()
        self.attached: dict[str, CompiledContext] = {}
        self.textures: dict[int, tuple[Element, Texture | None]] = {}
        self.terrains: dict[tuple[object, ...], Heightfield] = {}
        self.contacts: dict[tuple[str | None, ...], ContactParameters] = {}
        self.latest: tuple[Element, str | None, dict[str, str]] | None = None
        self.implicit = True

    def singles(self, element: Element, attribute: str, text: str) -> list[float]:
        """The numbers in a text, in double precision."""
        return [self.parse_number(element, attribute, word) for word in text.split()]

    def over(self, defaults: Mapping[str, str], attributes: Mapping[str, str]) -> dict[str, str]:
        """Attributes over their defaults; of some, numbers that are not stated are those of the defaults.

        Blank ones state nothing, as in MuJoCo.
        """
        joined: dict[str, str] = {}
        for name in _PARTLY_STATED.intersection(attributes) if defaults else ():
            # Going through items is no look-up, which would count as a use.
            usual = next((text for key, text in defaults.items() if key == name), None)
            if usual is not None:
                words, others = dict(attributes.items())[name].split(), usual.split()
                if len(words) < len(others):
                    joined[name] = " ".join([*words, *others[len(words) :]])
        found = layered(defaults, attributes, joined)
        for name in [key for key, text in found.items() if not text.strip() and key not in _WORDS]:
            # Looked up, both count as read.
            attributes.get(name)
            usual = defaults.get(name, "")
            if usual.strip():
                found[name] = usual
            else:
                del found[name]
        return found

    def numbers(self, element: Element, attribute: str, text: str, least: int, most: int) -> list[float]:
        """The numbers in a text; raises `DescriptionError` unless there are `least` to `most` of them."""
        found = self.singles(element, attribute, text)
        if not least <= len(found) <= most:
            expected = str(least) if least == most else f"{least} to {most}"
            raise self.error(element, f"{attribute}={shown(text)} needs {expected} numbers")
        return found

    def number(self, element: Element, attributes: dict[str, str], name: str, default: float) -> float:
        """The first number of an attribute."""
        text = attributes.get(name)
        return default if text is None else self.numbers(element, name, text, 1, 1000)[0]

    def bounds(self, element: Element, attribute: str, text: str) -> tuple[float, float]:
        """The two numbers of a range, which may be infinite."""
        words = text.split()
        if len(words) != 2:
            raise self.error(element, f"{attribute}={shown(text)} needs 2 numbers")
        lower, upper = (
            float(word)
            if word.lower().lstrip("+-") in _INFINITE
            else self.parse_number(element, attribute, word)
            for word in words
        )
        return lower, upper

    def flag(self, element: Element, attributes: dict[str, str], name: str, default: bool) -> bool:
        """An attribute that is `true` or `false`."""
        text = attributes.get(name)
        if text is None:
            return default
        if text not in ("true", "false"):
            raise self.error(element, f"{name}={shown(text)} must be true or false")
        return text == "true"

    def asset_file(self, element: Element, name: str, directory: str) -> Path | None:
        """The file of an asset: beside the main file, that which states it, or in a folder above.

        `directory` is that of the compiler's options. As for MuJoCo, it does not count beside a file that is
        included; where MuJoCo finds nothing, it is tried there, too.
        """
        base = Path(name.replace("\\", "/"))
        name = base.name if self.compiler.strip_path else str(base)
        below = Path(directory.replace("\\", "/")) / name
        path = reversed(self.root.path_to(element))
        stating = next((self.origins[id(e)] for e in path if id(e) in self.origins), self.file).parent
        for place in (self.file.parent / below, stating / name, stating / below):
            if place.is_file():
                return place
        return self.find_file(str(below)) or self.find_file(name)
