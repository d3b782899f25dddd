"""Pairs of bodies that MuJoCo keeps apart because one joint connects them."""

from __future__ import annotations

from collections.abc import Iterator

from carom.formats.mjcf.compiled.model import CompiledBody


def connected_pairs(world: CompiledBody) -> Iterator[tuple[str, str]]:
    """Names of bodies with shapes that move about each other by the joints of one body.

    Bodies without joints are one rigid piece with those around them. Pieces next to the world, which is
    fixed, collide with it; those next to a mocap body do not collide with that.
    """
    for child in world.children:
        if child.joints or child.is_free or child.is_mocap:
            yield from _below(child)
        else:
            for body in _others(child):
                yield from _below(body)


def _below(root: CompiledBody) -> Iterator[tuple[str, str]]:
    """The pairs in the piece of a body that moves, and in those that hang from it."""
    piece = [body.name for body in _piece(root) if body.collisions]
    for body in _others(root):
        below = [it.name for it in _piece(body) if it.collisions]
        yield from ((a, b) for a in piece for b in below)
        yield from _below(body)


def _piece(body: CompiledBody) -> Iterator[CompiledBody]:
    """A body and all that are fixed to it."""
    yield body
    for child in body.children:
        if not child.joints:
            yield from _piece(child)


def _others(body: CompiledBody) -> Iterator[CompiledBody]:
    """Bodies that hang by joints from the piece of a body."""
    for part in _piece(body):
        yield from (child for child in part.children if child.joints)
