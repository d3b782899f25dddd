"""What boxes around two shapes rule out is no contact: pairs touch where their nearest points say so."""

from __future__ import annotations

import numpy as np
import pytest

from carom import World

_TILE = (
    "-.04 -.03 -.015  .04 -.03 -.015  -.04 .03 -.015  .04 .03 -.015  0 -.02 .02  .02 .01 .02  -.02 .01 .02"
)
_SHAPES = {
    "box": 'type="box" size=".05 .03 .01"',
    "capsule": 'type="capsule" size=".02 .05"',
    "cylinder": 'type="cylinder" size=".04 .02"',
    "ellipsoid": 'type="ellipsoid" size=".05 .03 .02"',
    # Off the middle of its file, so that the middle of its bounds is not its frame.
    "tile": 'type="mesh" mesh="tile" pos=".01 .02 0"',
}
_PAIRS = [(a, b) for a in _SHAPES for b in _SHAPES if a <= b and (a, b) != ("box", "box")]


@pytest.mark.parametrize(("first", "second"), _PAIRS)
def test_pairs_touch_where_their_nearest_points_say_so(first: str, second: str) -> None:
    world = World()
    world.load(f"""<mujoco><option gravity="0 0 0"/><asset><mesh name="tile" vertex="{_TILE}"/></asset>
      <worldbody>
        <body name="a"><freejoint/><geom {_SHAPES[first]}/></body>
        <body name="b"><freejoint/><geom {_SHAPES[second]}/></body>
      </worldbody></mujoco>""")
    a, b = world["a"], world["b"]
    random = np.random.default_rng(len(first) + 10 * len(second))
    outcomes = []
    for _ in range(60):
        turns = random.normal(size=(2, 4))
        way = random.normal(size=3)
        a.pose = (0.0, 0.0, 0.0), turns[0] / np.linalg.norm(turns[0])
        b.pose = random.uniform(0.02, 0.09) * way / np.linalg.norm(way), turns[1] / np.linalg.norm(turns[1])
        distance = min((point.distance for point in world.nearest(a, b, 1.0)), default=1.0)
        if abs(distance) > 2e-6:
            outcomes.append(distance < 0.0)
            assert bool(world.contacts(a, b, now=True)) == outcomes[-1]
    assert 10 < sum(outcomes) < 55
