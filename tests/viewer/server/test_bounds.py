"""Numbers that a page sends have bounds, declared once; what is beyond is refused, and ends no script."""

import math

import pytest
from tests.viewer.watcher import Watcher

import pybullet as p
import pybullet_data
from carom.viewer.protocol import from_page
from carom.viewer.viewer import Viewer

HUGE = 1e200
DRIVE = {"body": 0, "joint": 0}
GRASP = {"body": 0, "link": 0, "point": [0, 0, 0], "target": [0, 0, 1]}
CAMERA = {"distance": 1, "yaw": 0, "pitch": 0, "target": [0, 0, 0]}


def test_every_number_has_bounds():
    unbounded = [
        f"{name}.{field}"
        for name, message in from_page.ALL.items()
        for field, facts in message.fields.items()
        if "number" in facts.kind.typescript and facts.kind.bounds is None
    ]
    assert unbounded == []


def test_bounds_belong_to_what_they_bound_and_nothing_beyond_does():
    for lower, upper, header in (
        (1e-4, 1e4, lambda x: from_page.SPEED(speed=x)),
        (-1e6, 1e6, lambda x: from_page.DRIVE(**DRIVE, target=x)),
        (-1e6, 1e6, lambda x: from_page.CONTROL(body=0, actuator=0, control=x)),
        (1e-6, 1e9, lambda x: from_page.CAMERA(**{**CAMERA, "distance": x})),
        (-1e9, 1e9, lambda x: from_page.CAMERA(**{**CAMERA, "target": [0, x, 0]})),
        (-1e9, 1e9, lambda x: from_page.GRASP(**{**GRASP, "point": [x, 0, 0]})),
        (-1e9, 1e9, lambda x: from_page.PULL(target=[0, 0, x])),
        (-10.0, 10.0, lambda x: from_page.GAMEPADS(gamepads=[_pad(x)])),
        (0, 2**53 - 1, lambda x: from_page.RESTORE(mark=x)),
    ):
        for bound in (lower, upper):
            from_page.checked(header(bound))
        below = lower - 1 if isinstance(lower, int) else math.nextafter(lower, -math.inf)
        above = upper + 1 if isinstance(upper, int) else math.nextafter(upper, math.inf)
        for value in (below, above, -math.inf, math.inf, math.nan, 10**400):
            with pytest.raises(ValueError, match=r"has to be .* from \S+ to \S+, not "):
                from_page.checked(header(value))


def _pad(axis: float) -> dict[str, object]:
    return {"name": "pad", "axes": [0.0, axis], "buttons": [], "standard": True}


def test_a_script_goes_on_whatever_numbers_a_page_sends(viewer: Viewer):
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    slider = p.addUserDebugParameter("told", 0, 1, 0)
    p.stepSimulation()
    with Watcher(viewer.address) as page:
        for speed in (1e-320, 1e-12, 0, -1, 1e300):
            page.tell("speed", speed=speed)
        page.tell("camera", **{**CAMERA, "distance": HUGE})
        for mode in ("position", "velocity", "torque"):
            page.tell("drive", **DRIVE, target=HUGE, mode=mode)
        page.tell("grasp", **{**GRASP, "target": [HUGE, 0, 0]})
        page.tell("grasp", **{**GRASP, "point": [0, HUGE, 0]})
        page.tell("slider", slider=slider, value=1)
        page.wait_for(lambda: page.shown.get(("slider", slider), {}).get("value") == 1)
        # What a page wants is done before the next frame.
        frames = page.frame.get("number", 0)
        page.wait_for(lambda: page.frame.get("number", 0) > frames or p.stepSimulation())
    for _ in range(20):
        p.stepSimulation()
    assert viewer.pause_control.speed is None
    assert viewer.camera.orbit.distance == 5
    assert abs(p.getJointState(0, 0)[1]) < 1
