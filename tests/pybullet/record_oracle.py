"""Records facts of real PyBullet. Run with it: `.oracle/bin/python tests/pybullet/record_oracle.py`."""

import json
import random
from pathlib import Path

import pybullet

HERE = Path(__file__).parent


def surface():
    """Names of functions, and constants with their values."""
    public = {name: getattr(pybullet, name) for name in dir(pybullet) if not name.startswith("__")}
    functions = sorted(name for name, value in public.items() if callable(value) and name != "error")
    return {"functions": functions, "constants": {n: v for n, v in public.items() if not callable(v)}}


def maths():
    """Results of the math helpers for random and for special arguments."""
    generator = random.Random(7)

    def vector(scale=3.0):
        return [generator.uniform(-scale, scale) for _ in range(3)]

    def quaternion():
        numbers = [generator.gauss(0.0, 1.0) for _ in range(4)]
        length = sum(number * number for number in numbers) ** 0.5
        return [number / length for number in numbers]

    turns = [quaternion() for _ in range(12)] + [
        [0.0, 0.0, 0.0, 1.0],
        [1.0, 0.0, 0.0, 0.0],
        [0.0, 0.5**0.5, 0.0, 0.5**0.5],
        [0.0, -(0.5**0.5), 0.0, 0.5**0.5],
        [0.5, 0.5, 0.5, 0.5],
        [-0.5, 0.5, -0.5, 0.5],
        [0.0, 0.6, 0.0, -0.8],
    ]
    calls = []
    for _ in range(12):
        calls.append(("getQuaternionFromEuler", [vector()]))
        calls.append(("getQuaternionFromAxisAngle", [vector(), generator.uniform(-4.0, 4.0)]))
    calls.append(("getQuaternionFromAxisAngle", [[0.0, 0.0, 0.0], 1.0]))
    for turn in turns:
        other = generator.choice(turns)
        calls.append(("getEulerFromQuaternion", [turn]))
        calls.append(("getMatrixFromQuaternion", [turn]))
        calls.append(("getMatrixFromQuaternion", [[3.0 * number for number in turn]]))
        calls.append(("getAxisAngleFromQuaternion", [turn]))
        calls.append(("rotateVector", [turn, vector()]))
        calls.append(("invertTransform", [vector(), turn]))
        calls.append(("multiplyTransforms", [vector(), turn, vector(), other]))
        calls.append(("getQuaternionSlerp", [turn, other, generator.random()]))
        calls.append(("getDifferenceQuaternion", [turn, other]))
        calls.append(("getAxisDifferenceQuaternion", [turn, other]))
        if abs(sum(a * b for a, b in zip(turn, other, strict=True))) < 0.99:
            calls.append(("calculateVelocityQuaternion", [turn, other, 0.25]))
    for _ in range(6):
        calls.append(("computeViewMatrix", [vector(), vector(), [0.0, 0.0, 1.0]]))
        angles = [generator.uniform(-80.0, 80.0) for _ in range(3)]
        for axis in (1, 2):
            distance = generator.uniform(0.5, 3.0)
            calls.append(("computeViewMatrixFromYawPitchRoll", [vector(), distance, *angles, axis]))
        calls.append(
            (
                "computeProjectionMatrixFOV",
                [generator.uniform(20.0, 90.0), generator.uniform(0.5, 2.0), 0.1, 50.0],
            )
        )
    calls.append(("computeProjectionMatrix", [-1.0, 2.0, -0.5, 0.75, 0.1, 20.0]))
    return [
        {"function": name, "arguments": given, "result": getattr(pybullet, name)(*given)}
        for name, given in calls
    ]


def write(name, facts):
    """Writes one file beside this one."""
    (HERE / name).write_text(json.dumps(facts, indent=1) + "\n")


if __name__ == "__main__":
    write("surface.json", surface())
    write("maths.json", maths())
