"""What Pinocchio says of URDF files: python ask_pinocchio.py FILES ANSWERS, with pin and numpy only.

FILES has a path on each line. A line of ANSWERS is the answer for one file, as JSON: what `ask_carom_urdf.py`
compares. The base is fixed, and joints that mimic others move freely.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio  # pyright: ignore[reportMissingImports]

STATES = 3
MAX_DOFS = 250


def main() -> None:
    files, answers = map(Path, sys.argv[1:3])
    with answers.open("w") as out:
        for file in files.read_text().splitlines():
            begin = time.process_time()
            try:
                answer = answered(file)
            except Exception as error:
                answer = {"error": str(error).splitlines()[0][:200] if str(error) else type(error).__name__}
            answer |= {"file": file, "seconds": time.process_time() - begin}
            out.write(json.dumps(answer) + "\n")


def answered(file: str) -> dict[str, Any]:
    model = pinocchio.buildModelFromUrdf(file)
    joints = [number for number in range(1, model.njoints) if model.joints[number].nv == 1]
    answer = {
        "joints": [model.names[number] for number in joints],
        "others": [model.names[number] for number in range(1, model.njoints) if number not in joints],
        "links": [frame.name for frame in model.frames if frame.type == pinocchio.FrameType.BODY],
    }
    if not answer["others"] and model.nv <= MAX_DOFS:
        answer["states"] = [state(model, joints, seed) for seed in range(STATES)]
    return answer


def state(model: Any, joints: list[int], seed: int) -> dict[str, Any]:
    """Poses of links, mass matrix, and forces without acceleration, by joints in a random state."""
    random = np.random.default_rng(seed)
    values, rates = random.uniform(-1, 1, len(joints)), random.normal(size=len(joints))
    q, v = pinocchio.neutral(model), np.zeros(model.nv)
    for number, value, rate in zip(joints, values, rates, strict=True):
        joint = model.joints[number]
        # Joints without limits have a cosine and a sine.
        q[joint.idx_q : joint.idx_q + joint.nq] = [value] if joint.nq == 1 else [np.cos(value), np.sin(value)]
        v[joint.idx_v] = rate
    data = model.createData()
    places = [model.joints[number].idx_v for number in joints]
    pinocchio.framesForwardKinematics(model, data, q)
    bodies = [i for i, frame in enumerate(model.frames) if frame.type == pinocchio.FrameType.BODY]
    poses = [[*data.oMf[i].translation, *data.oMf[i].rotation.ravel()] for i in bodies]
    upper = np.triu(pinocchio.crba(model, data, q))
    matrix = upper + np.triu(upper, 1).T
    bias = pinocchio.nonLinearEffects(model, data, q, v)
    return {
        "values": values.tolist(),
        "rates": rates.tolist(),
        "poses": np.array(poses).tolist(),
        "matrix": matrix[np.ix_(places, places)].tolist(),
        "bias": bias[places].tolist(),
    }


if __name__ == "__main__":
    main()
