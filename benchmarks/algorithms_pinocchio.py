"""Pinocchio's side of `algorithms.py`: answers to its questions, or how long they take.

.pinocchio/bin/python benchmarks/algorithms_pinocchio.py answers|times PANDA
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

GRAVITY = (0.4, -0.2, -9.81)
LINK = "panda_hand"
TURNS, SECONDS = 10, 4e-3
# How numbers are read from objects, which is no part of the time.
READ: dict[str, Callable[[Any], Any]] = {
    "link_frames": lambda found: found[0].oMf[found[1]].translation,
    "centroidal_momentum": lambda momentum: momentum.vector,
    "link_motions": lambda motion: motion.linear,
}


def questions(joints: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Positions, velocities, accelerations and forces of the arm."""
    rng = np.random.default_rng(3)
    return (rng.uniform(-0.5, 0.5, joints), *rng.normal(size=(3, joints)))


def least_time(call: Callable[[], Any]) -> float:
    """Processor time of a call [s]: the least of several turns."""
    call()
    begun = time.process_time()
    for _ in range(50):
        call()
    count = max(20, int(SECONDS / (time.process_time() - begun) * 50))
    turns: list[float] = []
    for _ in range(TURNS):
        begun = time.process_time()
        for _ in range(count):
            call()
        turns.append((time.process_time() - begun) / count)
    return min(turns)


def say(cases: dict[str, Callable[[], Any]], wanted: str) -> None:
    """Print the answers of cases, or their times, by name as JSON."""
    if wanted == "times":
        print(json.dumps({name: least_time(call) for name, call in cases.items()}))
        return
    answers = {
        # Later calls overwrite what these return.
        name: np.asarray(READ.get(name, np.asarray)(call())).ravel().tolist()
        for name, call in cases.items()
    }
    print(json.dumps(answers))


def cases(path: str) -> dict[str, Callable[[], Any]]:
    import pinocchio as pin  # pyright: ignore[reportMissingImports]

    model = pin.buildModelFromUrdf(path)
    model.gravity.linear = np.array(GRAVITY)
    data = model.createData()
    q, v, a, tau = questions(model.nv)
    frame, aligned = model.getFrameId(LINK), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED

    def poses() -> Any:
        pin.forwardKinematics(model, data, q)
        pin.updateFramePlacements(model, data)
        return data, frame

    def motion() -> Any:
        pin.forwardKinematics(model, data, q, v, a)
        return pin.getFrameVelocity(model, data, frame, aligned)

    def motion_derivatives() -> Any:
        pin.computeForwardKinematicsDerivatives(model, data, q, v, a)
        return pin.getFrameVelocityDerivatives(model, data, frame, aligned)[1]

    return {
        "mass_matrix": lambda: pin.crba(model, data, q),
        "inverse_dynamics": lambda: pin.rnea(model, data, q, v, a),
        "forward_dynamics": lambda: pin.aba(model, data, q, v, tau),
        "jacobian": lambda: pin.computeFrameJacobian(model, data, q, frame, aligned),
        "link_frames": poses,
        "center_of_mass": lambda: pin.centerOfMass(model, data, q),
        "jacobian_center_of_mass": lambda: pin.jacobianCenterOfMass(model, data, q),
        "centroidal_momentum": lambda: pin.computeCentroidalMomentum(model, data, q, v),
        "centroidal_map": lambda: pin.computeCentroidalMap(model, data, q),
        "kinetic_energy": lambda: pin.computeKineticEnergy(model, data, q, v),
        "potential_energy": lambda: pin.computePotentialEnergy(model, data, q),
        "coriolis_matrix": lambda: pin.computeCoriolisMatrix(model, data, q, v),
        "gravity_forces": lambda: pin.computeGeneralizedGravity(model, data, q),
        "bias_forces": lambda: pin.nonLinearEffects(model, data, q, v),
        "inverse_dynamics_derivatives": lambda: pin.computeRNEADerivatives(model, data, q, v, a)[0],
        "forward_dynamics_derivatives": lambda: pin.computeABADerivatives(model, data, q, v, tau)[0],
        "centroidal_derivatives": lambda: pin.computeCentroidalDynamicsDerivatives(model, data, q, v, a)[0],
        "joint_torque_regressor": lambda: pin.computeJointTorqueRegressor(model, data, q, v, a)[:, 0],
        "link_motions": motion,
        "link_motion_derivatives": motion_derivatives,
    }


if __name__ == "__main__":
    say(cases(sys.argv[2]), sys.argv[1])
