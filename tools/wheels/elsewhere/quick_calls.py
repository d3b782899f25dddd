"""The memory that kernels of quick calls use: that of a connection's world and of one body."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

from tools.wheels.elsewhere.memory import Memory

from carom.layouts.contacts import RESETS_SEEN
from carom.layouts.programs import TreeCall
from carom.layouts.quick.bodies import (
    MOTOR_NUMBERS,
    POSE_NUMBERS,
    SPATIAL_NUMBERS,
    Body,
    Client,
    Joint,
    Link,
)
from carom.layouts.quick.calls import Call
from carom.layouts.quick.world import Scene

_DOUBLE, _INT = 8, 4


def add_call(memory: Memory, call: int, add_kernel: Callable[[int], None]) -> None:
    """Add what a kernel uses of a world.

    Args:
        memory: The memory of the call.
        call: Address of a `Call`.
        add_kernel: Adds a kernel, given by the address of its `KernelCall`.
    """
    memory.add(call, ctypes.sizeof(Call))
    client = memory.add_pointer(call + Call.client.offset, ctypes.sizeof(Client))
    body = memory.add_pointer(call + Call.body.offset, ctypes.sizeof(Body))
    record: Any = Body.from_address(body)
    motors = record.velocity_count * MOTOR_NUMBERS
    links = record.link_count + 1
    counts = {
        "position": record.position_count,
        "velocity": record.velocity_count,
        "pose": links * POSE_NUMBERS,
        "twist": links * SPATIAL_NUMBERS,
        "wrench": links * SPATIAL_NUMBERS,
        "motor": motors,
        "pd": motors,
        "torque": record.velocity_count,
        "motor_impulse": record.velocity_count,
        "reaction": links * SPATIAL_NUMBERS,
    }
    for name, count in counts.items():
        memory.add_pointer(body + getattr(Body, name).offset, count * _DOUBLE)
    memory.add_pointer(body + Body.links.offset, record.link_count * ctypes.sizeof(Link))
    memory.add_pointer(body + Body.joints.offset, record.link_count * ctypes.sizeof(Joint))
    scene = memory.add_pointer(client + Client.scene.offset, ctypes.sizeof(Scene))
    _add_scene(memory, scene, record.tree, add_kernel)


def _add_scene(memory: Memory, address: int, tree: int, add_kernel: Callable[[int], None]) -> None:
    scene: Any = Scene.from_address(address)
    for name in ("find_poses", "find_twists"):
        if getattr(scene, name).call.function:
            place = address + getattr(Scene, name).offset
            add_kernel(place)
            memory.add_pointer(place + TreeCall.tree.offset, _INT)
    memory.add_pointer(address + Scene.contact_count.offset, (RESETS_SEEN + 1) * _INT)
    memory.add_pointer(address + Scene.contact_warm_starts.offset, scene.contact_room * _DOUBLE)
    memory.add_pointer(address + Scene.tree_resets.offset, (tree + 1) * _INT)
