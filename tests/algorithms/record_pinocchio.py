"""Asks Pinocchio for dynamics and their derivatives, and writes its answers to `pinocchio.json`.

Run it with a Python that has Pinocchio (`pip install pin`, in an environment of its own), not Carom:

    python tests/algorithms/record_pinocchio.py
"""

from __future__ import annotations

import importlib
import json
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

HERE = Path(__file__).parent
ANSWERS = HERE / "pinocchio.json"
DATA = HERE.parents[1] / "src" / "pybullet_data"
# Files, whether the base is fixed, and the link whose motion is asked for.
CASES = {
    "panda": (DATA / "franka_panda" / "panda.urdf", True, "panda_hand"),
    "floating tree": (HERE / "floating_tree.urdf", False, "tool"),
    "screws": (HERE / "screws.sdf", True, "tool"),
}
GRAVITY = (0.4, -0.2, -9.81)
DIGITS = 12


def chain_of_sdf(pin: Any, path: Path) -> Any:
    """A model of an SDF file whose joints are a chain, and whose poses have no rotations."""
    root = ElementTree.parse(path).getroot()[0]
    links: dict[str | None, Any] = {it.get("name"): it for it in root.iter("link")}
    model, parent, before = pin.Model(), 0, np.zeros(3)
    for joint in root.iter("joint"):
        if joint.get("type") == "fixed":
            continue
        axis, link = numbers(joint, "axis/xyz"), links[joint.findtext("child")]
        kinds = {"revolute": pin.JointModelRevoluteUnaligned, "prismatic": pin.JointModelPrismaticUnaligned}
        kind, arguments = kinds.get(joint.get("type", ""), pin.JointModelHelicalUnaligned), [axis]
        if joint.get("type") == "screw":
            arguments.append(numbers(joint, "screw_thread_pitch")[0] / (2.0 * np.pi))
        at = numbers(link, "pose")[:3]
        frame = pin.SE3(np.eye(3), at - before)
        parent = model.addJoint(parent, kind(*arguments), frame, joint.get("name"))
        before, body = at, link.find("inertial")
        xx, yy, zz, xy, xz, yz = (
            numbers(body, f"inertia/i{it}")[0] for it in ["xx", "yy", "zz", "xy", "xz", "yz"]
        )
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        inertia = pin.Inertia(numbers(body, "mass")[0], numbers(body, "pose")[:3], tensor)
        model.appendBodyToJoint(parent, inertia, pin.SE3.Identity())
        model.addBodyFrame(link.get("name"), parent, pin.SE3.Identity(), 0)
    return model


def numbers(element: Any, path: str) -> Any:
    return np.array(element.findtext(path).split(), dtype=float)


def ask(pin: Any, path: Path, link: str, *, is_fixed: bool) -> dict[str, Any]:
    root = [] if is_fixed else [pin.JointModelFreeFlyer()]
    model = chain_of_sdf(pin, path) if path.suffix == ".sdf" else pin.buildModelFromUrdf(str(path), *root)
    model.gravity.linear = np.array(GRAVITY)
    data = model.createData()
    rng = np.random.default_rng(7)
    q = pin.integrate(model, pin.neutral(model), rng.uniform(-0.9, 0.9, model.nv))
    # Joints without limits have cosine and sine of the angle.
    angles = [
        float(np.arctan2(q[joint.idx_q + 1], q[joint.idx_q])) if (joint.nq, joint.nv) == (2, 1) else None
        for joint in model.joints
    ]
    v, a, tau = rng.normal(size=(3, model.nv))
    frame, aligned = model.getFrameId(link), pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
    answers: dict[str, Any] = {"joints": list(model.names)[1:], "v": v, "a": a, "tau": tau}
    answers["q"] = [
        number
        for joint, angle in zip(model.joints, angles, strict=True)
        for number in ([angle] if angle is not None else q[joint.idx_q : joint.idx_q + joint.nq])
        if joint.nq > 0
    ]
    answers["rnea"] = pin.rnea(model, data, q, v, a)
    names = ("dtau_dq", "dtau_dv", "mass")
    # These are views of memory that later calls overwrite.
    found = [np.array(each) for each in pin.computeRNEADerivatives(model, data, q, v, a)]
    answers |= dict(zip(names, found, strict=True))
    answers["mass"] = pin.crba(model, data, q)
    answers["aba"] = pin.aba(model, data, q, v, tau)
    pin.computeABADerivatives(model, data, q, v, tau)
    answers |= {"da_dq": np.array(data.ddq_dq), "da_dv": np.array(data.ddq_dv)}
    answers["da_dtau"] = np.array(pin.computeMinverse(model, data, q))
    answers["coriolis"] = pin.computeCoriolisMatrix(model, data, q, v)
    answers["gravity"] = pin.computeGeneralizedGravity(model, data, q)
    answers["bias"] = pin.nonLinearEffects(model, data, q, v)
    answers["center_of_mass"] = pin.centerOfMass(model, data, q)
    answers["center_of_mass_jacobian"] = pin.jacobianCenterOfMass(model, data, q)
    answers["kinetic_energy"] = pin.computeKineticEnergy(model, data, q, v)
    answers["potential_energy"] = pin.computePotentialEnergy(model, data, q)
    answers["momentum"] = pin.computeCentroidalMomentum(model, data, q, v).vector
    answers["momentum_rate"] = pin.computeCentroidalMomentumTimeVariation(model, data, q, v, a).vector
    names = ("dh_dq", "drate_dq", "drate_dv", "dh_dv")
    found = [np.array(each) for each in pin.computeCentroidalDynamicsDerivatives(model, data, q, v, a)]
    answers |= dict(zip(names, found, strict=True))
    answers["regressor"] = pin.computeJointTorqueRegressor(model, data, q, v, a)
    pin.forwardKinematics(model, data, q, v, a)
    pin.updateFramePlacements(model, data)
    answers["link_velocity"] = pin.getFrameVelocity(model, data, frame, aligned).vector
    answers["link_acceleration"] = pin.getFrameClassicalAcceleration(model, data, frame, aligned).vector
    return {name: rounded(values) for name, values in answers.items()}


def rounded(values: Any) -> Any:
    """Numbers with as many digits as the tests need."""
    if isinstance(values, str):
        return values
    if np.ndim(values) > 0 or isinstance(values, list):
        return [rounded(value) for value in values]
    return float(f"{float(values):.{DIGITS}g}")


def main() -> None:
    pin: Any = importlib.import_module("pinocchio")
    answers = {"pinocchio": pin.__version__, "gravity": GRAVITY}
    for name, (path, is_fixed, link) in CASES.items():
        answers[name] = ask(pin, path, link, is_fixed=is_fixed)
    ANSWERS.write_text(json.dumps(answers, separators=(",", ":")) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
