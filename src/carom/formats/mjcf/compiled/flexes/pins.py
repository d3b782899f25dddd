"""`<pin>`: the points of a flex that the body around it holds."""

from __future__ import annotations

from itertools import product

from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.context import CompiledContext


def read_pins(context: CompiledContext, element: Element, kind: str, dimensions: int, count: int) -> set[int]:
    """Numbers of the points that any `<pin>` of a flex holds; raises `DescriptionError`."""
    counts = [1, 1, 1]
    if kind == "grid":
        given = context.numbers(element, "count", element.attributes.get("count", "10 10 10"), 1, 3)
        counts[:dimensions] = [int(each) for each in (*given, 1, 1)[:dimensions]]
    found: set[int] = set()
    for pin in element.all("pin"):

        def rows(name: str, width: int, of: Element = pin) -> list[list[int]]:
            numbers = [int(each) for each in context.singles(of, name, of.attributes.get(name, ""))]
            if len(numbers) % width:
                raise context.error(of, f"{name} needs {width} numbers for each pin or range")
            return [numbers[at : at + width] for at in range(0, len(numbers), width)]

        def number(place: list[int], of: Element = pin) -> int:
            whole = [*place, 0, 0][:3]
            if any(not 0 <= it < most for it, most in zip(whole, counts, strict=True)):
                raise context.error(of, f"there is no point {place} in a grid of {counts[:dimensions]}")
            return (whole[0] * counts[1] + whole[1]) * counts[2] + whole[2]

        here = {each for (each,) in rows("id", 1)}
        for first, last in rows("range", 2):
            _check(context, pin, (first, last), count)
            here |= set(range(first, last + 1))
        on_grid = [*rows("grid", dimensions)], [*rows("gridrange", 2 * dimensions)]
        if any(on_grid) and kind != "grid":
            raise context.error(pin, 'grid and gridrange are for type="grid"; use id or range')
        here |= {number(place) for place in on_grid[0]}
        for both in on_grid[1]:
            first, last = both[:dimensions], both[dimensions:]
            for corner in (first, last):
                number(corner)
            spans = [range(a, b + 1) for a, b in zip(first, last, strict=True)]
            here |= {number([*place]) for place in product(*spans)}
        _check(context, pin, here, count)
        found |= here
    return found


def _check(context: CompiledContext, pin: Element, numbers: set[int] | tuple[int, ...], count: int) -> None:
    wrong = next((each for each in numbers if not 0 <= each < count), None)
    if wrong is not None:
        raise context.error(pin, f"there is no point {wrong}; there are {count}, from 0")
