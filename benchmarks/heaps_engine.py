"""Builds the heaps of a file in one engine, steps them when asked, and says where the bodies are.

    python heaps_engine.py pybullet|mujoco|carom SCENE

`heaps.py` starts it. Each line of input has a number of steps whose processor time is printed; after the
first also all heights and speeds.
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from heap_scenes import mjcf

Stepping = Callable[[int], None]
Found = Callable[[], tuple[list[float], list[float]]]
"""Heights [m] and speeds [m/s] of all bodies."""


def in_pybullet(scene: dict[str, Any]) -> tuple[Stepping, Found]:
    """With PyBullet's interface, whoever provides it."""
    import pybullet as p

    p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81)
    p.setTimeStep(scene["time_step"])
    friction = scene["friction"] ** 0.5
    fixed = [p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))]
    shapes: dict[str, int] = {}
    for centre, half in scene["walls"]:
        if str(half) not in shapes:
            shapes[str(half)] = p.createCollisionShape(p.GEOM_BOX, halfExtents=half)
        fixed.append(p.createMultiBody(0, shapes[str(half)], basePosition=centre))
    for kind, size, _, _ in scene["bodies"]:
        if kind not in shapes:
            shapes[kind] = _pybullet_shape(p, kind, size)
    bodies = [
        p.createMultiBody(1, shapes[kind], basePosition=position, baseOrientation=turn)
        for kind, _, position, turn in scene["bodies"]
    ]
    for body in fixed + bodies:
        p.changeDynamics(body, -1, lateralFriction=friction)

    def step(count: int) -> None:
        for _ in range(count):
            p.stepSimulation()

    def found() -> tuple[list[float], list[float]]:
        heights = [p.getBasePositionAndOrientation(body)[0][2] for body in bodies]
        return heights, [_length(p.getBaseVelocity(body)[0]) for body in bodies]

    return step, found


def _pybullet_shape(p: Any, kind: str, size: list[float]) -> int:
    if kind == "box":
        return p.createCollisionShape(p.GEOM_BOX, halfExtents=size)
    if kind == "sphere":
        return p.createCollisionShape(p.GEOM_SPHERE, radius=size[0])
    name = p.GEOM_CAPSULE if kind == "capsule" else p.GEOM_CYLINDER
    return p.createCollisionShape(name, radius=size[0], height=2.0 * size[1])


def in_mujoco(scene: dict[str, Any]) -> tuple[Stepping, Found]:
    """As MuJoCo steps the MJCF file."""
    import mujoco  # pyright: ignore[reportMissingImports]

    model = mujoco.MjModel.from_xml_string(mjcf(scene))
    data = mujoco.MjData(model)

    def step(count: int) -> None:
        mujoco.mj_step(model, data, count)

    def found() -> tuple[list[float], list[float]]:
        speeds = [_length(row[:3]) for row in data.qvel.reshape(-1, 6)]
        return data.qpos.reshape(-1, 7)[:, 2].tolist(), speeds

    return step, found


def in_carom(scene: dict[str, Any]) -> tuple[Stepping, Found]:
    """As Carom steps the MJCF file."""
    from carom import World

    world = World(contact="compliant")
    world.load(mjcf(scene))
    bodies = [body for body in world if not body.fixed_base]

    def found() -> tuple[list[float], list[float]]:
        heights = [float(body.pose.position[2]) for body in bodies]
        return heights, [_length(body.velocity.linear) for body in bodies]

    return world.step, found


def _length(vector: Any) -> float:
    return sum(float(part) ** 2 for part in vector) ** 0.5


def main() -> None:
    """Build the scene, then do what is asked."""
    engine, scene = sys.argv[1], json.loads(Path(sys.argv[2]).read_text(encoding="utf-8"))
    step, found = {"pybullet": in_pybullet, "mujoco": in_mujoco, "carom": in_carom}[engine](scene)
    settled = False
    for line in sys.stdin:
        start = time.process_time()
        step(int(line))
        answer: dict[str, Any] = {"processor": time.process_time() - start}
        if not settled:
            answer["heights"], answer["speeds"] = found()
        settled = True
        sys.stdout.write(f"answer: {json.dumps(answer)}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
