"""What can happen in a world is known before it happens."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

import pybullet as p
from pybullet._clients.clients import client_of

KINDS = ("bare", "scenery", "loose", "folding")
FOLDING = """<robot name="folding"><link name="a"><collision><geometry><sphere radius="0.1"/></geometry>
</collision></link><link name="b"><collision><geometry><sphere radius="0.1"/></geometry></collision></link>
<joint name="j" type="revolute"><parent link="a"/><child link="b"/><limit lower="-3" upper="3"/>
</joint></robot>"""


@pytest.fixture(scope="module")
def folding(tmp_path_factory: pytest.TempPathFactory) -> str:
    file = tmp_path_factory.mktemp("robots") / "folding.urdf"
    file.write_text(FOLDING)
    return str(file)


def add(kind: str, file: str) -> int:
    if kind == "folding":
        return p.loadURDF(file, flags=p.URDF_USE_SELF_COLLISION)
    shape = -1 if kind == "bare" else p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    return p.createMultiBody(float(kind == "loose"), shape)


@given(kinds=st.lists(st.sampled_from(KINDS), max_size=5), filtered=st.booleans())
def test_bodies_can_touch_unless_all_of_them_are_scenery(
    kinds: list[str], filtered: bool, folding: str
) -> None:
    client = p.connect(p.DIRECT)
    try:
        bodies = [add(kind, folding) for kind in kinds]
        solid = [body for body, kind in zip(bodies, kinds, strict=True) if kind != "bare"]
        if filtered and len(solid) > 1:
            p.setCollisionFilterPair(solid[0], solid[-1], -1, -1, 1)
        several = len(solid) > 1 and ("loose" in kinds or filtered)
        assert client_of(client).world.engine.can_collide == (several or "folding" in kinds)
    finally:
        p.disconnect(client)
