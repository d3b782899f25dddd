"""The fuzzers of files: `python -m tests.fuzz.files --cases 100000 --seed 1 [--kinds urdf obj ...]`.

Each case damages a good file and loads it by the function scripts would use, of the drop-in or, for the kinds
of `readers.py`, of `carom`. It is refused with `pybullet.error` or an error of Carom's, and the world is as
it was; or it is loaded, and steps and getters give numbers. Nothing takes 5 s or a gigabyte: files are read
in child processes, which are ended (`guard.py`); `--here` reads them in this one.
"""

from __future__ import annotations

import argparse
import io
import json
import struct
import sys
from collections import Counter
from collections.abc import Callable
from hashlib import sha256
from pathlib import Path
from random import Random
from time import process_time
from typing import Any

import numpy as np
from tests.fuzz import readers
from tests.fuzz.api import LONGEST, own_folder
from tests.fuzz.damage import damaged
from tests.fuzz.guard import begin, in_children, one_file
from tests.fuzz.invariants import Broken, check_finite
from tests.soft.scenes import obj_text, vtk_text

import pybullet as p
import pybullet_data
from carom.soft.shapes import ball, box, grid
from carom.world_files import container

_DATA = Path(pybullet_data.getDataPath())
_TEST_DATA = Path(__file__).parents[1] / "formats" / "data"
_LARGEST = 30_000
_MAX_SEEDS = 25

Load = Callable[[str], Any]


def _files(*patterns: str) -> list[bytes]:
    """Contents of small files of ours."""
    found = [
        file
        for folder in (_TEST_DATA, _DATA)
        for pattern in patterns
        for file in sorted(folder.rglob(pattern))
    ]
    return [file.read_bytes() for file in found if file.stat().st_size < _LARGEST][:_MAX_SEEDS]


def _images(kind: str) -> list[bytes]:
    from PIL import Image

    images = []
    for mode in ("RGB", "L", "RGBA") if kind == "PNG" else ("RGB", "L"):
        stream = io.BytesIO()
        Image.new(mode, (13, 7), 100).save(stream, kind)
        images.append(stream.getvalue())
    return images


def _worlds() -> list[bytes]:
    """A few saved worlds."""
    contents = []
    for robot in ("r2d2.urdf", "cube_small.urdf", "kuka_iiwa/model.urdf"):
        client = p.connect(p.DIRECT)
        p.setAdditionalSearchPath(str(_DATA), physicsClientId=client)
        p.loadURDF("plane.urdf", physicsClientId=client)
        p.loadURDF(robot, [0, 0, 0.5], physicsClientId=client)
        for _ in range(5):
            p.stepSimulation(physicsClientId=client)
        p.saveBullet("seed.bullet", physicsClientId=client)
        p.disconnect(client)
        contents.append(Path("seed.bullet").read_bytes())
    return contents


def _mesh(name: str) -> Any:
    return p.createMultiBody(1, p.createCollisionShape(p.GEOM_MESH, fileName=name))


def _soft(name: str) -> Any:
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(0, 0, -10)
    return p.loadSoftBody(
        name, mass=1, useMassSpring=1, useBendingSprings=1, useNeoHookean=1, NeoHookeanMu=100,
        NeoHookeanLambda=100, springElasticStiffness=40, useSelfCollision=1,
    )  # fmt: skip


def _soft_urdf(name: str) -> Any:
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    return p.loadURDF(name)


def _soft_robots() -> list[bytes]:
    """Files that say what soft bodies of our meshes are like."""
    springs = '<spring elastic_stiffness="40" damping_stiffness="0.1" bending_stiffness="2"/>'
    inertial = '<inertial><mass value="1"/></inertial><collision_margin value="0.01"/>'
    lame = '<neohookean mu="100" lambda="100" damping="0.1"/><corotated mu="10" lambda="10"/>'
    reduced = '<mass value="2"/><stiffness_scale value="10"/><damping_coefficient value="0.1"/>'
    form = '<robot name="r"><{0} name="a">{1}<visual filename="{2}"/></{0}></robot>'
    return [
        form.format(tag, inside, _DATA / mesh).encode()
        for tag, inside, mesh in (
            ("deformable", inertial + springs, "cloth_z_up.obj"),
            ("deformable", inertial + lame + '<gravity_factor value="0.5"/>', "reduced_cube/cube_mesh.vtk"),
            ("reduced_deformable", reduced, "reduced_cube/cube_mesh.vtk"),
        )
    ]


def _solids() -> list[bytes]:
    """Meshes of tetrahedra: one, cubes and a ball."""
    one = np.eye(4, 3, -1), np.arange(4, dtype=np.int32)[None]
    return [
        vtk_text(*mesh).encode()
        for mesh in (one, box((1, 1, 1), (2, 2, 2)), box((1, 2, 3), (1, 1, 1)), ball(1, 4))
    ]


def _cloths() -> list[bytes]:
    """Rectangles, and small meshes that are not made for it."""
    made = [obj_text(*grid((1, 1), (side, side))).encode() for side in (1, 3, 8)]
    return made + [content for content in _files("*.obj") if len(content) < 10_000][:5]


SEEDS: dict[str, Callable[[], list[bytes]]] = {
    "urdf": lambda: _files("*.urdf"),
    "sdf": lambda: _files("*.sdf"),
    "xml": lambda: _files("mjcf/*.xml"),
    "obj": lambda: _files("*.obj"),
    "stl": lambda: _files("*.stl"),
    "dae": lambda: _files("*.dae"),
    "soft.obj": _cloths,
    "soft.urdf": _soft_robots,
    "vtk": _solids,
    "png": lambda: _images("PNG"),
    "jpg": lambda: _images("JPEG"),
    "bullet": _worlds,
    **readers.SEEDS,
}
LOADERS: dict[str, Load] = {
    "urdf": p.loadURDF,
    "sdf": p.loadSDF,
    "xml": p.loadMJCF,
    "obj": _mesh,
    "stl": _mesh,
    "dae": _mesh,
    "soft.obj": _soft,
    "soft.urdf": _soft_urdf,
    "vtk": _soft,
    "png": p.loadTexture,
    "jpg": p.loadTexture,
    "bullet": p.loadBullet,
}


def _damaged_world(content: bytes, random: Random) -> bytes:
    """A saved world with a damaged document whose checksum is right, or with any damage."""
    if random.random() < 0.1:
        return damaged(content, random)
    document, blocks = container.unpacked(content, Path("seed"))
    text = damaged(json.dumps(document).encode(), random)
    payload = struct.pack("<Q", len(text)) + text + bytes(blocks)
    header = struct.pack("<8sIIQ32s", container.MAGIC, 1, 0, len(payload), sha256(payload).digest())
    return header + payload


HARM: dict[str, Callable[[bytes, Random], bytes]] = {
    "bullet": _damaged_world, "carom": _damaged_world, "glb": readers.damaged_glb,
    "height.png": readers.damaged_png, "png": readers.damaged_png,
}  # fmt: skip
"""Harm that fits kinds of files; others have any."""


def fuzz(kind: str, cases: int, seed: int, first: int = 0, note: Path | None = None) -> Counter[str]:
    """Loads so many damaged files of a kind, from the first case on; raises `Broken` at one that does harm.

    `note` is a file for the number of the case.
    """
    with own_folder():
        seeds = SEEDS[kind]()
        client = p.connect(p.DIRECT)
        assert client == 0, "the first connection of the process"
        p.setAdditionalSearchPath(str(_DATA))
        outcomes: Counter[str] = Counter()
        try:
            for number in range(first, first + cases):
                random = Random(f"{kind} {seed} {number}")
                content = random.choice(seeds)
                harm = HARM.get(kind, damaged)
                # Another name each time, so that nothing is served from a cache.
                file = Path(f"{number}.{kind}")
                file.write_bytes(harm(content, random))
                try:
                    with one_file(note, number):
                        outcomes[_load(kind, str(file))] += 1
                except Exception:
                    print(f"kind {kind}, seed {seed}, case {number}: {file.read_bytes()!r}", file=sys.stderr)
                    raise
                file.unlink()
        finally:
            p.disconnect(client)
    return outcomes


def _load(kind: str, name: str) -> str:
    start = process_time()
    try:
        if kind in readers.LOADERS:
            return readers.load(kind, name)
        LOADERS[kind](name)
        outcome = "loaded"
    except p.error:
        if p.getNumBodies():
            raise Broken("it was refused, and yet there are bodies") from None
        return "refused"
    except Exception as problem:
        raise Broken(f"{type(problem).__name__}: {problem}") from problem
    finally:
        if process_time() - start > LONGEST:
            raise Broken(f"it took {process_time() - start:.1f} s")
    if kind not in ("png", "jpg"):
        try:
            p.stepSimulation()
        except p.error:
            # Some damage makes robots that nothing can simulate; the step says so.
            outcome = "loaded, cannot be stepped"
        check_finite()
        p.resetSimulation()
    return outcome


def main() -> None:
    """Does what the command line says."""
    parser = argparse.ArgumentParser(description="Loads damaged files.")
    parser.add_argument("--cases", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--kinds", nargs="*", default=list(SEEDS))
    parser.add_argument("--first", type=int, default=0, help="number of the first case")
    parser.add_argument("--here", action="store_true", help="read the files in this process")
    parser.add_argument("--note", type=Path, help="where the number of the case is written; for children")
    asked = parser.parse_args()
    if asked.here or asked.note is not None:
        begin()
        for kind in asked.kinds:
            start = process_time()
            outcomes = fuzz(kind, asked.cases, asked.seed, asked.first, asked.note)
            seconds = process_time() - start
            print(f"{kind}: {asked.cases} files in {seconds:.0f} s: {dict(outcomes)}", flush=True)
        return
    command = [sys.executable, "-m", "tests.fuzz.files"]
    problems = [in_children(command, kind, asked.cases, asked.seed) for kind in asked.kinds]
    for problem in filter(None, problems):
        print(problem, file=sys.stderr)
    sys.exit(any(problems))


if __name__ == "__main__":
    main()
