"""Geoms whose contacts mix what both say; `record_mixed.py` asks MuJoCo how a ball then accelerates."""

import random

_DIMENSIONS = (1, 3, 4, 6)
COUNT = 60
STEP = 1e-7


def _geom(rng: random.Random) -> str:
    friction = [
        rng.choice((0.0, 0.2, 0.5, 1.3)),
        rng.choice((0.0, 0.005, 0.02)),
        rng.choice((0.0, 0.0001, 0.01)),
    ]
    words = {
        "condim": rng.choice(_DIMENSIONS),
        "friction": " ".join(map(str, friction)),
        "priority": rng.choice((0, 0, 0, 1, -2)),
        "solmix": rng.choice((1, 1, 0, 0.3, 4)),
        "solref": rng.choice((".02 1", ".01 .7", ".05 2", "-900 -20", "-4000 -10")),
        "solimp": rng.choice((".9 .95 .001 .5 2", ".5 .8 .01 .3 1", ".2 .99 .02 .5 3")),
        "margin": rng.choice((0, 0, 0.002, 0.01)),
        "gap": rng.choice((0, 0, 0.004)),
    }
    return " ".join(f'{name}="{value}"' for name, value in words.items())


def mixed(number: int) -> str:
    """A ball that slides and spins on a floor, in it by 1 mm or beside it by 1 mm."""
    rng = random.Random(number)
    options = f'cone="{rng.choice(("elliptic", "pyramidal"))}" impratio="{rng.choice((1, 1, 5))}"'
    if rng.random() < 0.15:
        options += ' o_margin=".004" o_friction=".4 .4 .01 .002 .002" o_solref=".03 1"'
        options += '><flag override="enable"/></option'
    else:
        options += "/"
    height = rng.choice((0.099, 0.099, 0.0985, 0.101))
    return (
        f'<mujoco><option integrator="Euler" timestep="{STEP}"/><option tolerance="1e-12" iterations="300" '
        f'{options}><worldbody><geom type="plane" size="9 9 .1" {_geom(rng)}/><body name="b" '
        f'pos="0 0 {height}"><freejoint/><geom size=".1" {_geom(rng)}/></body></worldbody>'
        f'<keyframe><key qpos="0 0 {height} 1 0 0 0" qvel="{rng.uniform(-1, 1)} {rng.uniform(-1, 1)} '
        f'{rng.uniform(-0.2, 0.1)} {rng.uniform(-5, 5)} {rng.uniform(-5, 5)} {rng.uniform(-5, 5)}"/>'
        "</keyframe></mujoco>"
    )


MIXED = {str(number): mixed(number) for number in range(COUNT)}
