"""The messages to a page."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from carom.viewer.protocol.kinds import (
    FLAG,
    MATRIX,
    NUMBER,
    PAIR,
    QUATERNION,
    STRING,
    VECTOR,
    WHOLE,
    by_name,
    either,
    listed,
    maybe,
    record,
    several,
)
from carom.viewer.protocol.message import Message, declared, needed, optional

# What a shape of a body, a link of it, and an end of a constraint are told by.
_SHAPE = record(
    {
        "link": WHOLE,
        "meshes": listed(several(WHOLE, maybe(NUMBER))),
        "texture": WHOLE,
        "rgba": QUATERNION,
        "specular": VECTOR,
        "twoSided": FLAG,
        "position": VECTOR,
        "orientation": QUATERNION,
        "scale": VECTOR,
    },
    {"collision": FLAG, "site": FLAG, "group": WHOLE, "reflectance": NUMBER},
)
_LINK = record(
    {"name": STRING, "position": VECTOR, "orientation": QUATERNION, "moves": FLAG},
    {
        "joint": STRING,
        "kind": STRING,
        "axis": VECTOR,
        "parent": WHOLE,
        "limits": PAIR,
        "effort": NUMBER,
        "speed": NUMBER,
    },
)
_ACTUATOR = record({"name": STRING, "range": PAIR})
_SENSOR = record({"name": STRING, "kind": STRING, "size": WHOLE})
_SITE = record({"name": STRING, "link": WHOLE, "position": VECTOR, "orientation": QUATERNION})
_ON_STAGE = {"body": WHOLE, "link": WHOLE, "position": VECTOR}
_LIGHT = record(
    {
        **_ON_STAGE,
        "direction": VECTOR,
        "directional": FLAG,
        "cutoff": NUMBER,
        "exponent": NUMBER,
        "attenuation": VECTOR,
        "ambient": VECTOR,
        "diffuse": VECTOR,
        "specular": VECTOR,
        "shadow": FLAG,
    },
    {"target": several(WHOLE, WHOLE)},
)
_CAMERA = record(
    {**_ON_STAGE, "name": STRING, "orientation": QUATERNION, "angle": NUMBER, "aspect": NUMBER},
    {"target": several(WHOLE, WHOLE)},
)
_END = record({"body": WHOLE, "link": WHOLE, "position": VECTOR})

TITLE = Message(
    "title",
    "The run that the page shows: the first message of a connection.",
    {
        "title": needed(STRING, "Title of the page."),
        "run": needed(STRING, "Random name of the run."),
        "history": needed(WHOLE, "Memory for the past [bytes]; 0 for the page's own limit."),
        "watch": optional(STRING, "Token of spectators, for the link that they are given."),
    },
)
ENDING = Message(
    "ending",
    "The script ends by an exception.",
    {"error": needed(STRING, "The last line of the exception.")},
)
MESH = Message(
    "mesh",
    "A mesh that shapes use.",
    {
        "mesh": needed(WHOLE, "Its number."),
        "vertices": needed(WHOLE, "Number of its vertices."),
        "triangles": needed(WHOLE, "Number of its triangles."),
    },
    payload="Positions (3), normals (3) and texture coordinates (2) of all vertices as floats of four bytes, "
    "then the vertices (3) of all triangles as integers of four bytes.",
    kept="mesh",
)
NO_MESH = Message("no mesh", "A mesh is gone.", {"mesh": needed(WHOLE, "Its number.")}, kept="mesh")
TEXTURE = Message(
    "texture",
    "An image that shapes use.",
    {
        "texture": needed(WHOLE, "Its number."),
        "width": needed(WHOLE, "Its width [pixels]."),
        "height": needed(WHOLE, "Its height [pixels]."),
        "file": optional(STRING, "Its file type, if it is sent as a file."),
    },
    payload="Red, green and blue of its pixels, a byte each, the bottom row first; or a file.",
    kept="texture",
)
NO_TEXTURE = Message(
    "no texture", "An image is gone.", {"texture": needed(WHOLE, "Its number.")}, kept="texture"
)
BODY = Message(
    "body",
    "A body, without the poses of its links.",
    {
        "body": needed(WHOLE, "Its number."),
        "name": needed(STRING, "Its name."),
        "file": needed(maybe(STRING), "Name of its file."),
        "path": needed(maybe(STRING), "The folder of its file and its name."),
        "links": needed(listed(_LINK), "Its links, the base first: their frames, and their joints."),
        "shapes": needed(listed(_SHAPE), "Its shapes, each in the inertial frame of a link, 0 for the base."),
        "actuators": optional(listed(_ACTUATOR), "Its actuators, and the ranges of their sliders."),
        "sensors": optional(listed(_SENSOR), "Its sensors, and how many numbers each gives."),
        "sites": optional(listed(_SITE), "Its sites, each in the inertial frame of a link, 0 for the base."),
        "world": optional(WHOLE, "Its world, of many worlds of which another one is chosen."),
        "like": optional(WHOLE, "Number of the same body of the chosen world, if it is of another one."),
    },
    kept="body",
)
NO_BODY = Message("no body", "A body is gone.", {"body": needed(WHOLE, "Its number.")}, kept="body")
DYNAMICS = Message(
    "dynamics",
    "Masses of a body.",
    {
        "dynamics": needed(WHOLE, "Number of the body."),
        "body": needed(WHOLE, "The same."),
        "links": needed(
            listed(record({"mass": NUMBER, "inertia": listed(NUMBER)})),
            "Mass [kg] and principal moments of inertia [kg m²] of its links, the base first.",
        ),
    },
    kept="dynamics",
)
NO_DYNAMICS = Message(
    "no dynamics",
    "Masses of a body are not told any more.",
    {"dynamics": needed(WHOLE, "Number of the body.")},
    kept="dynamics",
)
LAYOUT = Message(
    "layout",
    "Whose poses frames have, and in which order.",
    {
        "layout": needed(WHOLE, "Number of the layout, which frames name."),
        "bodies": needed(listed(several(WHOLE, WHOLE)), "Number of each body, and of its links."),
    },
    kept="",
)
NO_LAYOUT = Message("no layout", "There is no layout at a moment of the past.", {}, kept="")
FRAME = Message(
    "frame",
    "The poses of all links at a time.",
    {
        "layout": needed(WHOLE, "Number of the layout of the poses."),
        "poses": needed(WHOLE, "Number of poses."),
        "time": needed(NUMBER, "Simulated time [s]."),
        "rate": optional(NUMBER, "Simulated time / real time; a replay has none."),
        "picture": optional(WHOLE, "Number of the picture that the script waits for."),
        "values": optional(by_name(NUMBER), "Values that the script plots, by name."),
        "blocks": optional(
            listed(several(STRING, WHOLE)),
            "Name and number of rows of each array of readings after the poses.",
        ),
        "number": optional(WHOLE, "Number of the frame in the history of the simulation."),
        "past": optional(FLAG, "Set by the page: whether it is shown as a moment of the past."),
    },
    payload="Poses (3 for the position, 4 for the orientation) and readings as floats of four bytes.",
)
PAST = Message(
    "past",
    "A part of the past that the page has asked for.",
    {
        "first": needed(WHOLE, "Number of its first frame."),
        "oldest": needed(WHOLE, "Number of the oldest frame that there is."),
        "versions": needed(
            listed(several(STRING, WHOLE, maybe(WHOLE))),
            "Name of each other message in it, and the frames from which and to which it was shown.",
        ),
    },
    payload="A recording: the other messages, then the frames.",
)
CONSTRAINTS = Message(
    "constraints",
    "Constraints of scripts.",
    {
        "constraints": needed(
            listed(record({"constraint": WHOLE, "kind": STRING, "parent": _END, "child": _END})),
            "All of them: number, kind, and the two frames; body -1 is the world.",
        )
    },
    kept="",
)
NO_CONSTRAINTS = Message("no constraints", "No constraints are told at a moment of the past.", {}, kept="")
STAGE = Message(
    "stage",
    "Lights, sky and cameras of files, each in the frame of a link, 0 for the base; body -1 is the world.",
    {
        "sky": needed(WHOLE, "Number of the texture of the cube around everything; -1 for none."),
        "haze": needed(VECTOR, "Colour of the horizon."),
        "headlight": needed(
            maybe(record({"ambient": VECTOR, "diffuse": VECTOR, "specular": VECTOR})),
            "The light at the viewer.",
        ),
        "lights": needed(
            listed(_LIGHT), "The other lights: angles [degrees], and at what link each is aimed."
        ),
        "cameras": needed(listed(_CAMERA), "The cameras: vertical angle [degrees], and width by height."),
        "tendons": needed(FLAG, "Whether tendons are seen at first."),
    },
    kept="",
)
NO_STAGE = Message("no stage", "No file says how the scene is seen.", {}, kept="")
HANDLE = Message(
    "handle",
    "A frame that the user can move.",
    {
        "handle": needed(WHOLE, "Its number."),
        "name": needed(STRING, "Its label."),
        "position": needed(VECTOR, "Its position in the world [m]."),
        "orientation": needed(QUATERNION, "Its orientation (x, y, z, w)."),
    },
)
PYRAMID = Message(
    "pyramid",
    "Where the camera of the script's last image was.",
    {"corners": needed(listed(VECTOR), "Corners of its frustum in the world [m]: four near, four far.")},
    kept="",
)
NO_PYRAMID = Message("no pyramid", "The script has no image at a moment of the past.", {}, kept="")
LENS = Message(
    "lens",
    "A camera that the page can look through.",
    {
        "lens": needed(WHOLE, "Its number."),
        "name": needed(STRING, "Its name."),
        "width": needed(WHOLE, "Columns of its image."),
        "height": needed(WHOLE, "Rows of its image."),
        "view": needed(MATRIX, "From the world to the eye, by columns."),
        "projection": needed(MATRIX, "From the eye to clip coordinates, by columns."),
    },
)
RAYS = Message(
    "rays",
    "The last rays that the script has cast.",
    {"count": needed(WHOLE, "Number of rays.")},
    payload="Start (3), end (3), normal at the hit (3) and fraction of each ray as floats of four bytes.",
    kept="",
)
NO_RAYS = Message("no rays", "No rays are told at a moment of the past.", {}, kept="")
PREVIEWS = Message(
    "previews",
    "The script's last image.",
    {"width": needed(WHOLE, "Width [pixels]."), "height": needed(WHOLE, "Height [pixels].")},
    payload="Red, green and blue, a byte each, of its colours, its depth and its segmentation.",
)
_ITEM = needed(WHOLE, "Number of the drawing.")
_ON = {
    "item": _ITEM,
    "body": needed(WHOLE, "Number of the body that the drawing is fixed to; -1 for the world."),
    "link": needed(WHOLE, "Link of that body, 0 for its base."),
}
LINE = Message(
    "line",
    "A line that the script draws.",
    {
        **_ON,
        "start": needed(VECTOR, "Start [m]."),
        "end": needed(VECTOR, "End [m]."),
        "colour": needed(VECTOR, "Red, green and blue, from 0 to 1."),
        "width": needed(NUMBER, "Width [pixels]."),
    },
    kept="item",
)
TEXT = Message(
    "text",
    "A text that the script draws.",
    {
        **_ON,
        "text": needed(STRING, "The text."),
        "position": needed(VECTOR, "Where it is [m]."),
        "colour": needed(VECTOR, "Red, green and blue, from 0 to 1."),
        "size": needed(NUMBER, "Size of the letters, relative to the usual one."),
        "orientation": needed(
            maybe(QUATERNION), "Its orientation (x, y, z, w); null if it faces the camera."
        ),
    },
    kept="item",
)
POINTS = Message(
    "points",
    "Points that the script draws.",
    {
        **_ON,
        "size": needed(NUMBER, "Size of each [pixels]."),
        "count": needed(WHOLE, "Number of points."),
    },
    payload="Positions (3) of all points, then their colours (3), as floats of four bytes.",
    kept="item",
)
NO_ITEM = Message("no item", "A drawing is gone.", {"item": _ITEM}, kept="item")
SLIDER = Message(
    "slider",
    "A control of the panel: a slider, a button, a list of texts or a checkbox.",
    {
        "slider": needed(WHOLE, "Its number."),
        "name": needed(STRING, "Its label."),
        "button": needed(FLAG, "Whether it is a button."),
        "lower": needed(NUMBER, "Its least value."),
        "upper": needed(NUMBER, "Its greatest value."),
        "value": needed(NUMBER, "Its value; of a button the number of clicks."),
        "options": optional(listed(STRING), "The texts of a list; none for a checkbox."),
        "panel": optional(WHOLE, "Number of the script's own panel that it is in."),
    },
    kept="slider",
)
PANEL = Message(
    "panel",
    "A panel of the script.",
    {"panel": needed(WHOLE, "Its number."), "title": needed(STRING, "Its title.")},
)
NO_PANEL = Message("no panel", "A panel of the script is gone.", {"panel": needed(WHOLE, "Its number.")})
FIELD = Message(
    "field",
    "A text of the panel.",
    {
        "field": needed(WHOLE, "Its number, among those of controls."),
        "name": needed(STRING, "Its label."),
        "text": needed(STRING, "The text."),
        "editable": needed(FLAG, "Whether users can type."),
        "panel": optional(WHOLE, "Number of the script's own panel that it is in."),
    },
)
NO_FIELD = Message("no field", "A text is gone.", {"field": needed(WHOLE, "Its number.")})
IMAGE = Message(
    "image",
    "An image of the panel.",
    {
        "image": needed(WHOLE, "Its number, among those of controls."),
        "name": needed(STRING, "Its label."),
        "width": needed(WHOLE, "Its width [pixels]."),
        "height": needed(WHOLE, "Its height [pixels]."),
        "panel": optional(WHOLE, "Number of the script's own panel that it is in."),
    },
    payload="The image as a PNG file.",
)
NO_IMAGE = Message("no image", "An image is gone.", {"image": needed(WHOLE, "Its number.")})
NO_SLIDER = Message(
    "no slider", "A control is gone.", {"slider": needed(WHOLE, "Its number.")}, kept="slider"
)
PAUSE = Message("pause", "Whether the simulation is paused.", {"paused": needed(FLAG, "Whether it is.")})
SPEED = Message(
    "speed",
    "The limit of the speed.",
    {"speed": needed(maybe(NUMBER), "Simulated time / real time; null for no limit.")},
)
MARK = Message(
    "mark",
    "A state that the user has marked.",
    {"mark": needed(WHOLE, "Its number."), "time": needed(NUMBER, "Simulated time [s].")},
)
NO_MARK = Message("no mark", "A mark is gone.", {"mark": needed(WHOLE, "Its number.")})
CAMERA = Message(
    "camera",
    "The view: set by the script, or that of another page.",
    {
        "distance": needed(NUMBER, "Distance of the eye from the target [m]."),
        "yaw": needed(NUMBER, "Angle about the upward axis [degrees]."),
        "pitch": needed(NUMBER, "Upward angle [degrees]; negative when the camera looks down."),
        "target": needed(VECTOR, "The point that the camera looks at [m]."),
        "chosen": needed(FLAG, "Whether a script or a user has set it."),
        "script": needed(FLAG, "Whether it was the script."),
    },
)
OPTIONS = Message(
    "options",
    "The display options of the script.",
    {
        "flags": optional(by_name(FLAG), "PyBullet's flags, by their `COV_*` numbers."),
        "names": optional(FLAG, "Whether the body under the mouse is named."),
        "colours": optional(
            listed(several(WHOLE, WHOLE, VECTOR)),
            "Colour in wireframe of links: body, link (0 for the base), colour.",
        ),
        "up_axis": optional(WHOLE, "1 if y points up, else 2."),
        "background": optional(maybe(VECTOR), "Colour of the background."),
        "light_position": optional(maybe(VECTOR), "Where the light is [m]."),
        "shadow_map_intensity": optional(maybe(NUMBER), "How bright shadows are, from 0 to 1."),
        "shadow_map_resolution": optional(maybe(NUMBER), "Side of the shadow map [pixels]."),
        "shadow_map_world_size": optional(maybe(NUMBER), "Side of the area with shadows [m]."),
        "remote_sync_transform_interval": optional(maybe(NUMBER), "Not used by the page."),
    },
)
WORLDS = Message(
    "worlds",
    "Which of many worlds are shown; bodies of the chosen one have their own numbers.",
    {
        "count": needed(WHOLE, "How many there are."),
        "shown": needed(listed(WHOLE), "Those that are shown."),
        "chosen": needed(WHOLE, "The one that is looked at."),
        "arrangement": needed(STRING, "grid: side by side; overlay: all in one place."),
        "cells": needed(listed(VECTOR), "The middle of the place of each [m]."),
        "size": needed(NUMBER, "Side of these places [m]; 0 if all are in one place."),
    },
)
SIMULATION = Message(
    "simulation",
    "What a simulation without a script shows; its page has sections that others have not.",
    {
        "files": needed(listed(STRING), "Names of its files."),
        "stated": needed(
            listed(several(STRING, STRING)), "What the files state besides bodies: name, value."
        ),
    },
)
KEYFRAMES = Message(
    "keyframes",
    "The keyframes of a simulation without a script.",
    {
        "keyframes": needed(
            listed(record({"name": STRING, "time": NUMBER, "text": STRING, "own": FLAG})),
            "Name, simulated time [s] and text to copy of each, and whether the user has saved it.",
        )
    },
)
SETTINGS = Message(
    "settings",
    "The parameters of a simulation that its user can change.",
    {
        "settings": needed(
            listed(
                record(
                    {"name": STRING, "title": STRING, "value": either(listed(NUMBER), FLAG, STRING)},
                    {"unit": STRING, "choices": listed(STRING)},
                )
            ),
            "Numbers, switches and choices, with their present values.",
        )
    },
)
ARGUMENTS = Message(
    "arguments",
    "The arguments that xacro files declare.",
    {"arguments": needed(listed(record({"name": STRING, "value": STRING})), "Their names and values.")},
)
CONSOLE = Message(
    "console",
    "Warnings and errors, and what of the files is not simulated.",
    {
        "lines": needed(
            listed(record({"level": STRING, "text": STRING, "count": WHOLE})),
            "Level (info, ignored, warning or error), text, and how often it was said in turn.",
        )
    },
)

OWN_OF_FRAMES: frozenset[str] = frozenset({"time", "rate", "picture", "number"})
"""Fields in which frames of the same run of a recording may differ; recordings keep the time only."""

ALL: dict[str, Message] = declared(globals())
"""The messages, by the names of their constants."""

MADE_BY_PAGE: frozenset[Message] = frozenset({NO_LAYOUT, NO_CONSTRAINTS, NO_PYRAMID, NO_RAYS})
"""Messages that no simulation sends: the page makes them itself, to show a moment before what they remove."""

_BY_TYPE = {message.type: message for message in ALL.values()}


def declaration(header: Mapping[str, Any]) -> Message:
    """What declares a message, by its header."""
    return _BY_TYPE[header["type"]]


def checked(header: Mapping[str, Any]) -> Message:
    """What declares a message; raises if nothing does, or if its fields are wrong or not declared.

    Raises:
        KeyError: There is no message of its type.
        ValueError: A field is missing, has a wrong kind of value, or is not declared.
    """
    message = declaration(header)
    message.check(header)
    if unknown := header.keys() - message.fields.keys() - {"type"}:
        raise ValueError(f"a {message.type!r} message has no fields {sorted(unknown)}")
    return message
