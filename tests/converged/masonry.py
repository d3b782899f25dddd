"""What stands by friction and shape alone: an arch of wedges, and houses of cards."""

from __future__ import annotations

from math import cos, pi, radians, sin
from pathlib import Path

from carom import World
from carom.scene.body import Body

INNER, OUTER, DEPTH, DENSITY = 0.9, 1.1, 0.2, 1000.0
HEIGHT, THICKNESS, WIDTH, CARD = 0.1, 0.001, 0.05, 0.02
"""Half extents of a card [m], and its mass [kg]."""
QUADS = ((1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4))


def wedge(file: Path, count: int) -> Path:
    """Write a voussoir of an arch of so many about the point that is 1 m inwards along x."""
    half = 0.5 * pi / count
    corners = [
        (r * cos(angle) - 1.0, y, r * sin(angle))
        for angle in (-half, half)
        for r in (INNER, OUTER)
        for y in (-0.5 * DEPTH, 0.5 * DEPTH)
    ]
    lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in corners] + [f"f {a} {b} {c} {d}" for a, b, c, d in QUADS]
    file.write_text("\n".join(lines) + "\n")
    return file


def arch(world: World, folder: Path, count: int = 15, friction: float = 0.7) -> list[Body]:
    """Half a circle of voussoirs on a plane, from right to left; friction is that of each joint."""
    world.add_plane(friction=friction**0.5)
    file = wedge(folder / "wedge.obj", count)
    step = pi / count
    mass = DENSITY * DEPTH * 0.5 * (OUTER**2 - INNER**2) * sin(step)
    stones = []
    for i in range(count):
        angle = (i + 0.5) * step
        place, turn = (cos(angle), 0.0, sin(angle)), (0.0, -sin(0.5 * angle), 0.0, cos(0.5 * angle))
        stones.append(world.add_mesh(file, place, turn, mass=mass, friction=friction**0.5, name=f"stone{i}"))
    return stones


def pair(world: World, angle: float, friction: float, place: tuple[float, float] = (0.0, 0.0)) -> list[Body]:
    """Two cards that lean on each other above a place (x, z) [m], each by an angle from upright [rad]."""
    s, c = sin(angle), cos(angle)
    x, z = place[0] + HEIGHT * s + THICKNESS * c, place[1] + HEIGHT * c + THICKNESS * s
    return [
        world.add_box(
            (THICKNESS, WIDTH, HEIGHT),
            (place[0] + side * (x - place[0]), 0.0, z),
            (0.0, -side * sin(0.5 * angle), 0.0, cos(0.5 * angle)),
            mass=CARD,
            friction=friction**0.5,
        )
        for side in (1, -1)
    ]


def house(world: World, storeys: int, angle: float = radians(15.0), friction: float = 0.5) -> list[Body]:
    """So many storeys of cards, with as many pairs in the lowest one, on a plane."""
    world.add_plane(friction=friction**0.5)
    cards: list[Body] = []
    foot = 2.0 * (HEIGHT * sin(angle) + THICKNESS * cos(angle))
    pitch, storey, base = 2.1 * foot, 2.0 * (HEIGHT * cos(angle) + THICKNESS * sin(angle)), 0.0
    for count in range(storeys, 0, -1):
        for i in range(count):
            cards += pair(world, angle, friction, ((i - 0.5 * (count - 1)) * pitch, base))
        base += storey
        for i in range(count - 1):
            place = ((i - 0.5 * (count - 2)) * pitch, 0.0, base + THICKNESS)
            half_extents = (0.49 * pitch, WIDTH, THICKNESS)
            cards.append(world.add_box(half_extents, place, mass=CARD, friction=friction**0.5))
        base += 2.0 * THICKNESS
    return cards
