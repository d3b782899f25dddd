"""Spherical and free joints as two sites, between which actuators act."""

from __future__ import annotations

from carom.description.pose import IDENTITY, Pose
from carom.description.transform import compose
from carom.formats.mjcf.compiled.elements import WORLD
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledModel, Site

BALL = "spherical"
_SIZE = (0.005, 0.005, 0.005)


def add_ball_sites(model: CompiledModel, body: CompiledBody, around: str, joint: str) -> tuple[str, str]:
    """Names of the sites at a spherical joint of a body: on the body, and on the body `around` it.

    Where the joint is not turned, both coincide, with the axes of the body. They are made once.
    """
    anchor = next(it.anchor for it in body.joints if it.joint.name == joint)
    ball, socket = f"{joint}@ball", f"{joint}@socket"
    if ball not in model.sites:
        place = Pose(anchor)
        model.sites[ball] = Site(ball, body.name, place, "sphere", _SIZE)
        model.sites[socket] = Site(socket, around, compose(body.pose, place), "sphere", _SIZE)
    return ball, socket


def add_free_sites(model: CompiledModel, body: str) -> tuple[str, str]:
    """Names of the sites at a free body: on its frame, and one of the world with the axes of that."""
    own, world = f"{body}@free", "world@free"
    if own not in model.sites:
        model.sites[own] = Site(own, body, IDENTITY, "sphere", _SIZE)
        model.sites[world] = Site(world, WORLD, IDENTITY, "sphere", _SIZE)
    return own, world
