"""What programs are about, and programs themselves: the same for the same seed and theme."""

from __future__ import annotations

from collections.abc import Callable

from tools.differ.kinds import (
    algorithms,
    bodies,
    books,
    constraints,
    getters,
    motion,
    questions,
    resting,
    settings,
    shapes,
)
from tools.differ.maker import Maker, Theme
from tools.differ.programs import Call

KINDS: dict[str, Callable[[Maker], None]] = {
    "algorithm": algorithms.algorithm,
    "body": bodies.body,
    "book": books.book,
    "camera": questions.camera,
    "constraint": constraints.constraint,
    "contacts": getters.contacts,
    "debug": books.debug,
    "dynamics": settings.dynamics,
    "engine": settings.engine,
    "filter": settings.filtering,
    "force": motion.force,
    "joint": motion.joint,
    "kinematics": algorithms.kinematics,
    "look": getters.look,
    "maths": books.maths,
    "motor": motion.motor,
    "multi": motion.multi,
    "query": questions.query,
    "remove": bodies.remove,
    "reset": motion.reset,
    "save": settings.save,
    "shape": shapes.shape,
    "state": getters.state,
    "step": motion.step,
    "texture": questions.texture,
}
"""Kinds of calls; each adds a few to a program."""


def _kinds(text: str) -> dict[str, int]:
    """Kinds and how often they come, from a text such as `step*8 reset`."""
    words = (word.partition("*") for word in text.split())
    return {kind: int(times or 1) for kind, _, times in words}


_FREE = (
    "step*8 motor*4 force*2 dynamics*2 engine constraint*2 joint*2 state*4 reset algorithm look multi*2 "
    "query save"
)
_CONTACT = "step*8 motor*2 force dynamics*3 engine*2 constraint filter joint state*3 contacts*4 reset save"
_TOUCH = "step*8 motor dynamics*4 engine*3 force reset state contacts*2"
_MIXED = (
    "step*5 motor*2 force*2 dynamics*2 engine constraint joint state*3 reset algorithm look multi query*2 "
    "contacts*2 save filter remove book camera body"
)
_RESTING = "step*6 contacts*4 dynamics*3 engine*3 force*2 state*2"
THEMES: dict[str, Theme] = {
    "free": Theme(_kinds(_FREE), bodies=3, space=25),
    "contact": Theme(_kinds(_CONTACT), bodies=4, space=0.5, floor=True),
    "touch": Theme(
        _kinds(_TOUCH),
        bodies=3,
        space=0.25,
        plain=True,
    ),
    "resting": Theme(_kinds(_RESTING), bodies=4, space=0.9, rests=True),
    "query": Theme(
        _kinds("query*10 contacts*2 filter reset joint step state dynamics shape"), bodies=5, space=0.4
    ),
    "algorithm": Theme(
        _kinds("algorithm*8 joint*3 state*2 reset step motor dynamics engine multi"),
        bodies=1,
        space=5,
        robots=True,
    ),
    "kinematics": Theme(_kinds("kinematics*4 joint*2"), bodies=1, space=5, robots=True),
    "camera": Theme(_kinds("camera*5 look*3 reset joint step texture"), bodies=4, space=1, floor=True),
    "books": Theme(
        _kinds("book*8 save*3 remove*2 look*2 debug*3 state*2 engine*2 step*2 constraint*2 maths*3"),
        bodies=3,
        space=3,
    ),
    "files": Theme(_kinds("state*4 look*4 step*2 query*2 joint motor"), bodies=2, space=8, scenes=True),
    "dynamics": Theme(_kinds("dynamics*6 step*4 state*4 motor*2 force reset joint"), bodies=2, space=25),
    "constraints": Theme(
        _kinds("constraint*6 step*6 motor force state*3 reset"), bodies=4, space=2, apart=True
    ),
    "mixed": Theme(_kinds(_MIXED), bodies=6, space=1.5, floor=True),
}
_GRAVITIES = ((0, 0, -9.81), (0, 0, -10), (0, 0, 0), (1, -2, -9.81))
_FEW = 4


def program(seed: int, theme: str) -> list[Call]:
    """A random program about a theme."""
    maker = Maker(seed, theme, THEMES[theme])
    maker.call("setGravity", *maker.one(_GRAVITIES))
    if maker.theme.rests or maker.chance(0.3):
        settings.engine(maker)
    floor, body = (resting.ground, resting.resting) if maker.theme.rests else (bodies.floor, bodies.body)
    floor(maker)
    for _ in range(maker.random.randint(1, maker.theme.bodies)):
        body(maker)
    if maker.theme.rests:
        resting.first_steps(maker)
    if maker.theme.apart:
        for body in maker.bodies:
            for link in range(-1, len(body.joints)):
                maker.call("setCollisionFilterGroupMask", body.reference, link, 0, 0)
    kinds = dict(maker.theme.kinds)
    # In half of the programs there are only a few kinds: what they do to each other is then easier to see.
    if maker.chance(0.5):
        few = {*maker.random.sample(sorted(kinds), min(_FEW, len(kinds))), "step", "state"}
        kinds = {kind: times for kind, times in kinds.items() if kind in few}
    for kind in maker.random.choices(list(kinds), list(kinds.values()), k=maker.random.randint(5, 30)):
        KINDS[kind](maker)
    motion.step(maker)
    return maker.calls
