"""Keyframes of attached models, as keyframes of the model that attaches them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace

from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.model import CompiledModel, FileKeyframe
from carom.formats.robot.context import shown

Numbers = tuple[float, ...]
_COUNTS = {"free": (7, 6), "spherical": (4, 3)}
_READ = ("name", "time", "qpos", "qvel", "ctrl", "act")
_NAMELESS = "there is no telling which they are in the model that attaches it"


def add_attached_keyframes(
    model: CompiledModel,
    attached: Sequence[Scope],
    compiled: Callable[[CompiledContext], CompiledModel],
) -> None:
    """Add the keyframes of the models that a file attaches itself, with the prefixes of their names.

    What a key says holds for the joints and actuators of its model that are there; the others are at the
    reference of the whole, or 0. As in MuJoCo, the first of several copies by `<replicate>` counts, and keys
    of models that the model attaches keep the names that they have there. `compiled` compiles an attached
    model by itself.

    Raises:
        DescriptionError: A key is broken, or two have one name.
    """
    added: set[tuple[int, str]] = set()
    for scope in attached:
        if (id(scope.context), scope.prefix) in added or not has_keys(scope.context):
            continue
        added.add((id(scope.context), scope.prefix))
        part = compiled(scope.context)
        own = 0
        for element in scope.context.root.all("keyframe"):
            element.note()
            for key in element.all("key"):
                own += 1
                for name in _READ:
                    key.attributes.get(name)
        places = _Places(model, part, scope)
        for number, key in enumerate(part.keyframes.values()):
            name = f"{scope.prefix}{key.name}"
            if number >= own and key.name not in model.keyframes:
                name = key.name
            if name in model.keyframes:
                raise scope.context.error(scope.context.root, f"there are two keyframes {shown(name)}")
            model.keyframes[name] = replace(places.moved(key, model.reference), name=name)
        stated = (it.positions or it.velocities or it.controls for it in part.keyframes.values())
        if places.nameless and any(stated):
            where = scope.context.root.first("keyframe") or scope.context.root
            scope.context.leave_out(
                where, "joints and actuators without names stay at the reference", _NAMELESS
            )


def has_keys(context: CompiledContext) -> bool:
    """Whether a model, or one that it attaches, has keyframes."""
    return context.root.first("keyframe") is not None or any(map(has_keys, context.attached.values()))


class _Places:
    """Where the numbers of a model are among those of the one that attaches it.

    Attributes:
        nameless: Something of the model has no name to find it by.
    """

    def __init__(self, model: CompiledModel, part: CompiledModel, scope: Scope) -> None:
        def full(name: str) -> str:
            return f"{scope.prefix}{name}{scope.suffix}"

        whole, own = list(_joints(model)), list(_joints(part))
        stated = {it.attributes["name"] for it in _all(scope.context.root) if "name" in it.attributes}
        by_name = {name: at for name, _, at in whole if name}
        by_body = {body: at for _, body, at in whole}
        self.nameless = False
        self.positions: list[tuple[int, int]] = []
        self.velocities: list[tuple[int, int]] = []
        for name, (body, number), at in own:
            place = by_name.get(full(name)) if name in stated else None
            place = place or by_body.get((full(body), number))
            if place is None:
                self.nameless |= name not in stated and body not in stated
                continue
            for pairs, of, to in zip((self.positions, self.velocities), at, place, strict=True):
                pairs += zip(of, to, strict=True)
        self.controls: list[tuple[int, int]] = []
        self.activations: list[tuple[int, int]] = []
        into = dict(_actuators(model))
        for name, at in _actuators(part):
            place = into.get(full(name))
            if place is None:
                self.nameless |= name not in stated
                continue
            self.controls.append((at[0], place[0]))
            if at[1] is not None and place[1] is not None:
                self.activations.append((at[1], place[1]))
        self._rates = sum(len(rates) for _, _, (_, rates) in whole)
        self._actuators = len(model.actuators), sum(it.has_activation for it in model.actuators)

    def moved(self, key: FileKeyframe, reference: list[float]) -> FileKeyframe:
        """A keyframe of the model as one of the model that attaches it."""
        controls, activations = self._actuators
        return replace(
            key,
            positions=_put(key.positions, self.positions, reference),
            velocities=_put(key.velocities, self.velocities, [0.0] * self._rates),
            controls=_put(key.controls, self.controls, [0.0] * controls),
            activations=_put(key.activations, self.activations, [0.0] * activations),
        )


def _put(numbers: Numbers, places: list[tuple[int, int]], usual: list[float]) -> Numbers:
    if not numbers:
        return ()
    found = list(usual)
    for of, to in places:
        found[to] = numbers[of]
    return tuple(found)


def _joints(model: CompiledModel) -> Iterator[tuple[str, tuple[str, int], tuple[range, range]]]:
    """Name of each joint, its body and its number there, and where it is in `qpos` and in `qvel`."""
    position = rate = 0
    numbers: dict[str, int] = {}
    for name, body, kind in model.joints:
        positions, rates = _COUNTS.get(kind, (1, 1))
        number = numbers[body] = numbers.get(body, -1) + 1
        yield name, (body, number), (range(position, position + positions), range(rate, rate + rates))
        position, rate = position + positions, rate + rates


def _actuators(model: CompiledModel) -> Iterator[tuple[str, tuple[int, int | None]]]:
    """Name of each actuator, and where it is in `ctrl` and in `act`."""
    activation = 0
    for number, it in enumerate(model.actuators):
        yield it.name, (number, activation if it.has_activation else None)
        activation += it.has_activation


def _all(element: Element) -> Iterator[Element]:
    pending = [element]
    while pending:
        each = pending.pop()
        yield each
        pending += each.children
