"""What MuJoCo makes of two files each: run by its own Python, with a list of pairs of paths as JSON on stdin.

Prints the greatest differences of the mass matrix and the forces at random states, relative to the greatest
entry. With the argument `state`: mass matrix and bias forces of a file at a position and velocity.
"""

import json
import sys

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np

SIZES = [
    *("nq", "nv", "nu", "na", "nbody", "njnt", "ngeom", "nsite"),
    *("ncam", "nsensor", "ntendon", "neq", "nkey", "npair", "nexclude"),
]
FORCES = ["qfrc_bias", "qfrc_passive", "qfrc_actuator", "sensordata"]


def load(path):
    return mujoco.MjModel.from_xml_path(path)


def answers(model, position, velocity, control):
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:], data.ctrl[:] = position, velocity, control
    mujoco.mj_normalizeQuat(model, data.qpos)
    mujoco.mj_forward(model, data)
    matrix = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, matrix)
    return {"qM": matrix, **{name: getattr(data, name).copy() for name in FORCES}}


def differences(first, second):
    one, other = load(first), load(second)
    for name in SIZES:
        if getattr(one, name) != getattr(other, name):
            return {f"{name}: {getattr(one, name)} and {getattr(other, name)}": 1.0}
    rng = np.random.default_rng(7)
    greatest = {"keys": 0.0}
    if one.nkey:
        greatest["keys"] = float(np.abs(one.key_qpos - other.key_qpos).max(initial=0.0))
    for _ in range(3):
        state = rng.normal(size=one.nq), rng.normal(size=one.nv), rng.normal(size=one.nu)
        found = answers(one, *state), answers(other, *state)
        for name, expected in found[0].items():
            scale = max(1.0, np.abs(expected).max(initial=0.0))
            difference = float(np.abs(found[1][name] - expected).max(initial=0.0)) / scale
            greatest[name] = max(difference, greatest.get(name, 0.0))
    return greatest


asked = json.load(sys.stdin)
if sys.argv[1:] == ["state"]:
    found = []
    for path, position, velocity in asked:
        answer = answers(load(path), position, velocity, 0.0)
        found.append([answer["qM"].tolist(), answer["qfrc_bias"].tolist()])
else:
    found = [differences(*pair) for pair in asked]
print(json.dumps(found))
