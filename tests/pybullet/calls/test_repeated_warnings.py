"""Warnings of calls that a control loop makes in every step."""

from __future__ import annotations

import pytest

import pybullet as p


@pytest.mark.insides
def test_each_line_is_warned_once_of_each_missing_body_and_link(caplog: pytest.LogCaptureFixture) -> None:
    p.connect(p.DIRECT)
    body = p.createMultiBody(1, p.createCollisionShape(p.GEOM_SPHERE, radius=0.1))
    for missing in (77, 78):
        for _ in range(3):
            p.changeDynamics(missing, -1, mass=1)
            p.applyExternalForce(missing, -1, [0, 0, 1], [0, 0, 0], p.WORLD_FRAME)
            p.changeDynamics(body, missing, mass=1)
    p.changeDynamics(77, -1, mass=1)
    p.disconnect()
    told = [record.getMessage() for record in caplog.records]
    assert told == [
        "changeDynamics: There is no body 77.",
        "applyExternalForce: There is no body 77.",
        "changeDynamics: Body 0 () has 0 joints, so there is no joint 77.",
        "changeDynamics: There is no body 78.",
        "applyExternalForce: There is no body 78.",
        "changeDynamics: Body 0 () has 0 joints, so there is no joint 78.",
        "changeDynamics: There is no body 77.",
    ]
