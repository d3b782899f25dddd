"""The messages from a page.

Each number has bounds, within which no simulation breaks. Pages keep to them; what is beyond is refused.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from typing import Any

from carom.viewer.protocol.kinds import (
    FLAG,
    STRING,
    by_name,
    either,
    listed,
    maybe,
    number,
    one_of,
    record,
    several,
    whole,
)
from carom.viewer.protocol.message import Message, declared, needed, optional

# Numbers that JavaScript knows exactly: of things, and those of links, of which -1 is the base.
_MOST = 2**53 - 1
_NUMBER_OF = whole(0, _MOST)
_LINKS = whole(-1, _MOST)
# Any finite number: the slider has a range.
_FINITE = number(-sys.float_info.max, sys.float_info.max)
# In the world and in links [m]: further than the moon.
_COORDINATE = number(-1e9, 1e9)
_POINT = several(_COORDINATE, _COORDINATE, _COORDINATE)
# Of about length 1.
_PART = number(-2.0, 2.0)
_ORIENTATION = several(_PART, _PART, _PART, _PART)
# [degrees]
_ANGLE = number(-1e9, 1e9)
_PIXEL = number(-1e6, 1e6)
_PIXELS = whole(0, 2**16)
# Positions, velocities, torques and forces, in units of metres, radians and newtons.
_EFFORT = number(-1e6, 1e6)
# Sticks and triggers go from -1 to 1, but some browsers say 3.3 for a hat that is not pressed.
_AXIS = number(-10.0, 10.0)

_BODY = needed(_NUMBER_OF, "Number of the body.")
_LINK = needed(_LINKS, "Link of the body, -1 for its base.")
_JOINT = needed(_NUMBER_OF, "Number of the joint.")

SLIDER = Message(
    "slider",
    "The user has moved a slider, or chosen from a list.",
    {"slider": needed(_NUMBER_OF, "Number of the slider."), "value": needed(_FINITE, "Its new value.")},
)
PRESS = Message(
    "press", "The user has clicked a button.", {"slider": needed(_NUMBER_OF, "Number of the button.")}
)
FIELD = Message(
    "field",
    "The user has typed a text.",
    {"field": needed(_NUMBER_OF, "Number of the text."), "text": needed(STRING, "The new text.")},
)
KEY = Message(
    "key",
    "The user has pressed or released a key.",
    {
        "key": needed(STRING, "What the key writes, as in `KeyboardEvent.key`."),
        "code": needed(STRING, "Which key it is, as in `KeyboardEvent.code`."),
        "down": needed(FLAG, "Whether it is pressed."),
    },
)
BLUR = Message("blur", "The page has lost the keyboard: all its keys are released.", {})
MOUSE = Message(
    "mouse",
    "The mouse has moved or, with a button, a button has been pressed or released.",
    {
        "x": needed(_PIXEL, "Pixels from the left edge of the view."),
        "y": needed(_PIXEL, "Pixels from its upper edge."),
        "button": optional(
            whole(-1, 31), "0 for the left button, 1 for the middle one, 2 for the right one."
        ),
        "down": optional(FLAG, "Whether the button is pressed."),
    },
)
CAMERA = Message(
    "camera",
    "The view of the page has changed.",
    {
        "distance": needed(number(1e-6, 1e9), "Distance of the eye from the target [m]."),
        "yaw": needed(_ANGLE, "Angle about the upward axis [degrees]."),
        "pitch": needed(_ANGLE, "Upward angle [degrees]; negative when the camera looks down."),
        "target": needed(_POINT, "The point that the camera looks at [m]."),
        "chosen": optional(FLAG, "Whether the user has set the view, and not the page itself."),
    },
)
SIZE = Message(
    "size",
    "The size of the view.",
    {"width": needed(_PIXELS, "Width [pixels]."), "height": needed(_PIXELS, "Height [pixels].")},
)
VISIBLE = Message(
    "visible",
    "The page has come into view, or has gone out of it.",
    {"visible": needed(FLAG, "Whether it is in view.")},
)
DRAWN = Message(
    "drawn",
    "The page has drawn a picture that the script waits for.",
    {"picture": needed(_NUMBER_OF, "The number of the picture, from the frame.")},
)
PAST = Message(
    "past",
    "The page asks for frames of the past.",
    {
        "before": needed(_NUMBER_OF, "Number of the frame before which they are."),
        "known": needed(FLAG, "Whether the page knows what was shown with that frame."),
    },
)
PREVIEW_WIDTH = Message(
    "preview width",
    "The width of previews that the page needs.",
    {"width": needed(_PIXELS, "Width [pixels].")},
)
WANT = Message(
    "want",
    "The data besides poses that the page needs.",
    {
        "collisions": optional(FLAG, "Collision shapes."),
        "contacts": optional(FLAG, "Contacts and their forces."),
        "joints": optional(
            either(one_of("all"), listed(_NUMBER_OF)), "Bodies whose joints are read, or all of them."
        ),
        "links": optional(listed(several(_LINKS, _LINKS)), "Bodies and links whose velocities are read."),
        "dynamics": optional(FLAG, "Masses and inertias."),
        "constraints": optional(FLAG, "Constraints of scripts."),
        "rays": optional(FLAG, "Rays that scripts cast."),
        "sensors": optional(listed(_NUMBER_OF), "Bodies whose sensors are read."),
        "tendons": optional(FLAG, "Paths of tendons."),
    },
)
DRIVE = Message(
    "drive",
    "The user drives a joint.",
    {
        "body": _BODY,
        "joint": _JOINT,
        "mode": optional(
            one_of("position", "velocity", "torque"), "What the target is; a position if missing."
        ),
        "target": needed(_EFFORT, "Target in units of the mode [m or rad, m/s or rad/s, N or N m]."),
    },
)
CONTROL = Message(
    "control",
    "The user sets the control of an actuator.",
    {
        "body": _BODY,
        "actuator": needed(_NUMBER_OF, "Number of the actuator among those of the body."),
        "control": needed(_EFFORT, "Its control."),
    },
)
GIVE_BACK = Message(
    "give back", "The user gives a joint back to the script.", {"body": _BODY, "joint": _JOINT}
)
HANDLE = Message(
    "handle",
    "The user has moved a handle.",
    {
        "handle": needed(_NUMBER_OF, "Number of the handle."),
        "position": needed(_POINT, "Its new position in the world [m]."),
        "orientation": needed(_ORIENTATION, "Its new orientation (x, y, z, w)."),
    },
)
SLEEP = Message("sleep", "The user lets bodies sleep, or wakes them.", {})
PROFILE = Message(
    "profile",
    "The user starts or ends a timing profile.",
    {"running": needed(FLAG, "Whether it starts.")},
)
GRASP = Message(
    "grasp",
    "The user has grabbed a body at a point.",
    {
        "body": _BODY,
        "link": _LINK,
        "point": needed(_POINT, "The point in the inertial frame of the link [m]."),
        "target": needed(_POINT, "Where it is to be, in the world [m]."),
    },
)
PULL = Message(
    "pull",
    "The user pulls what is grabbed.",
    {"target": needed(_POINT, "Where the grabbed point is to be, in the world [m].")},
)
TURN = Message(
    "turn",
    "The user turns a body.",
    {
        "body": _BODY,
        "link": _LINK,
        "orientation": needed(_ORIENTATION, "Orientation that its inertial frame is to have (x, y, z, w)."),
    },
)
LET_GO = Message("let go", "The user lets go of what is pulled or turned.", {})
GAMEPADS = Message(
    "gamepads",
    "The state of the gamepads at the page's machine.",
    {
        "gamepads": needed(
            listed(
                record({"name": STRING, "axes": listed(_AXIS), "buttons": listed(_AXIS), "standard": FLAG})
            ),
            "All of them: see `Gamepad`.",
        )
    },
)
PAUSE = Message(
    "pause", "The user pauses the simulation, or continues it.", {"paused": needed(FLAG, "Whether to pause.")}
)
STEP = Message("step", "The user lets a paused simulation make a step.", {})
SPEED = Message(
    "speed",
    "The user limits the speed.",
    {"speed": needed(maybe(number(1e-4, 1e4)), "Simulated time / real time; null for no limit.")},
)
RESET = Message("reset", "The user goes back to the start state.", {})
MARK = Message("mark", "The user marks the present state.", {})
RESTORE = Message(
    "restore", "The user goes back to a mark.", {"mark": needed(_NUMBER_OF, "The number of the mark.")}
)
WORLDS = Message(
    "worlds",
    "The user chooses which of many worlds are shown.",
    {
        "chosen": optional(_NUMBER_OF, "The one to look at."),
        "shown": optional(whole(1, 256), "How many are shown."),
        "arrangement": optional(one_of("grid", "overlay"), "Side by side, or all in one place."),
    },
)
CLOSE = Message("close", "The user ends the script's viewer.", {})
KEYFRAME = Message(
    "keyframe",
    "The user goes to a keyframe, keeps the present state as one, or drops one that was kept so.",
    {
        "action": needed(one_of("reset", "save", "forget"), "What is done."),
        "name": needed(STRING, "Name of the keyframe."),
    },
)
SETTING = Message(
    "setting",
    "The user changes a parameter of the simulation.",
    {
        "name": needed(STRING, "Its name, from the settings that the page was told."),
        "value": needed(either(listed(number(-1e9, 1e9)), FLAG, STRING), "Its new value."),
    },
)
ARGUMENTS = Message(
    "arguments",
    "The user gives a xacro file other arguments, with which it is loaded again.",
    {"values": needed(by_name(STRING), "Their values, by name.")},
)
RELOAD = Message("reload", "The user loads the files again.", {})
UPLOAD = Message(
    "upload",
    "A piece of a file that the user has dropped on the page.",
    {
        "name": needed(STRING, "Its path among what was dropped, with slashes."),
        "start": needed(FLAG, "Whether it is the first piece of the file."),
        "data": needed(STRING, "Its bytes, in base 64."),
    },
)
OPEN = Message(
    "open", "All that the user has dropped has been sent: it is shown instead of what there is.", {}
)

ALL: dict[str, Message] = declared(globals())
"""The messages, by the names of their constants."""

SPECTATING: frozenset[str] = frozenset({PAST.type, PREVIEW_WIDTH.type, WANT.type})
"""Types of those by which a page asks to be shown something: all that spectators may send.

`VISIBLE` and `DRAWN` are none of them, so that no script waits for a spectator's picture.
"""

_BY_TYPE = {message.type: message for message in ALL.values()}


def checked(header: Mapping[str, Any]) -> Message:
    """What declares a message that has come; `ValueError` if nothing does, or its fields are wrong."""
    message = _BY_TYPE.get(header["type"])
    if message is None:
        raise ValueError(f"there is no message {str(header['type'])[:60]!r} from a page")
    message.check(header)
    return message
