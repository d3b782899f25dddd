"""What is measured, and what we want to see: data, the same for every engine."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Case:
    """One thing to time.

    Attributes:
        key: Name of the function in an engine's module that prepares it.
        title: Its row in the table.
        speedup: PyBullet's time over Carom's that we want at least, if any.
        seconds: Time Carom may take at most, if any.
        slowdown: Carom's time over PyBullet's that we want at most, if any.
        no_slower_than: Another engine that Carom is to be no slower than, if any.
    """

    key: str
    title: str
    speedup: float | None = None
    seconds: float | None = None
    slowdown: float | None = None
    no_slower_than: str | None = None


IN_PROCESS = (
    Case("step_panda", "stepSimulation, Panda, default motors", speedup=5.0),
    Case("step_panda_free", "stepSimulation, Panda, motors off", speedup=5.0),
    Case("step_kuka", "stepSimulation, KUKA, default motors", speedup=5.0),
    Case("step_kuka_free", "stepSimulation, KUKA, motors off", speedup=5.0),
    Case("step_tree", "stepSimulation, floating tree of 20 links, motors off"),
    Case("step_r2d2", "stepSimulation, R2D2 at rest on the plane", speedup=5.0),
    Case("step_quadruped", "stepSimulation, quadruped standing on the plane", speedup=5.0),
    Case("step_humanoid", "stepSimulation, humanoid lying on the plane", speedup=5.0),
    Case("step_27_boxes", "stepSimulation, 9 towers of 3 boxes", speedup=5.0, no_slower_than="MuJoCo"),
    Case("step_125_boxes", "stepSimulation, 25 towers of 5 boxes", speedup=5.0, no_slower_than="MuJoCo"),
    Case("step_1000_balls", "stepSimulation, 1,000 balls in a pile", speedup=5.0),
    Case("step_1000_apart", "stepSimulation, 1,000 bodies side by side on the floor"),
    Case("step_cloth", "stepSimulation, cloth of 32 x 32 nodes on a ball", speedup=5.0),
    Case("step_soft_cube", "stepSimulation, soft cube of 1,050 tetrahedra on a plane", speedup=5.0),
    Case("step_towel", "stepSimulation, towel of 33 x 33 nodes in the Panda's hand", speedup=5.0),
    Case("rays", "rayTestBatch, 1,024 rays at a pile of 200 balls", speedup=3.0),
    Case("control_loop", "control loop: 9 targets by one call, step, read 9 joints", speedup=3.0),
    Case(
        "control_loop_one_by_one",
        "control loop of the original Panda: 9 targets one by one, step, read 9 joints",
        speedup=5.0,
    ),
    Case("get_joint_state", "getJointState", speedup=1.0),
    Case("get_joint_states", "getJointStates, 9 joints", speedup=1.0),
    Case("get_link_state", "getLinkState with velocity", speedup=1.0),
    Case("get_link_states", "getLinkStates with velocities, 9 links", speedup=1.0),
    Case("get_base_pose", "getBasePositionAndOrientation", speedup=1.0),
    Case("get_base_velocity", "getBaseVelocity", speedup=1.0),
    Case("set_motor", "setJointMotorControl2", speedup=1.0),
    Case("set_motors", "setJointMotorControlArray, 9 targets", speedup=1.0),
    Case("reset_joint", "resetJointState", speedup=1.0),
    Case("reset_base_pose", "resetBasePositionAndOrientation", speedup=1.0),
    Case("reset_base_velocity", "resetBaseVelocity", speedup=1.0),
    Case("apply_force", "applyExternalForce", speedup=1.0),
    Case("apply_torque", "applyExternalTorque", speedup=1.0),
    Case("change_friction", "changeDynamics, friction", speedup=1.0),
    Case("change_damping", "changeDynamics, damping", speedup=1.0),
    Case("change_mass", "changeDynamics, mass", speedup=1.0),
    Case("multiply_transforms", "multiplyTransforms", speedup=1.0),
    Case("invert_transform", "invertTransform", speedup=1.0),
    Case("euler_and_back", "getQuaternionFromEuler and getEulerFromQuaternion", speedup=1.0),
    Case("matrix_from_quaternion", "getMatrixFromQuaternion", speedup=1.0),
    Case("slerp", "getQuaternionSlerp", speedup=1.0),
    Case("axis_angle_and_back", "getAxisAngleFromQuaternion and getQuaternionFromAxisAngle", speedup=1.0),
    Case("difference_quaternion", "getDifferenceQuaternion", speedup=1.0),
    Case("change_gravity", "setGravity to another value, step, Panda", speedup=1.0),
    Case(
        "change_constraint",
        "createConstraint, step, removeConstraint, 10 boxes on a floor",
        speedup=1.0,
    ),
    Case("detect_collisions", "performCollisionDetection, 10 boxes on a floor", speedup=1.0),
    Case("contact_points", "getContactPoints of one box", speedup=1.0),
    Case("closest_points", "getClosestPoints of two boxes", speedup=1.0),
    Case("closest_points_moved", "getClosestPoints of two boxes, one of which has been moved", speedup=1.0),
    Case("overlapping", "getOverlappingObjects, 10 boxes on a floor", speedup=1.0),
    Case("inverse_dynamics", "calculateInverseDynamics, Panda", speedup=1.0),
    Case("inverse_dynamics_kuka", "calculateInverseDynamics, KUKA", speedup=1.0),
    Case("inverse_dynamics_tree", "calculateInverseDynamics, floating tree of 20 links", speedup=1.0),
    Case("jacobian", "calculateJacobian, Panda", speedup=1.0),
    Case("mass_matrix", "calculateMassMatrix, Panda"),
    Case("linearize_panda", "derivatives of a step by states and 9 torques, Panda"),
    Case("linearize_ant", "derivatives of a step by states and 8 torques, Ant in the air"),
    Case("linearize_pandas", "derivatives of a step of 64 Pandas by states and 9 torques"),
    Case("differentiate_pandas", "a step of 256 Pandas in PyTorch, forward and backward"),
    Case("stable_pd", "STABLE_PD_CONTROL, floating tree of 20 links", speedup=1.0),
    Case("inverse_kinematics", "calculateInverseKinematics, KUKA, to a point", speedup=3.0),
    Case("inverse_kinematics_oriented", "calculateInverseKinematics, Panda, to a pose", speedup=3.0),
    Case("save_1000", "saveState and removeState, 1,000 bodies", seconds=1e-3),
    Case("restore_1000", "restoreState, 1,000 bodies", seconds=1e-3),
    Case("image_84", "getCameraImage, 84 x 84, Panda on the plane", speedup=4.0),
    Case("image_320", "getCameraImage, 320 x 240", speedup=4.0),
    Case("image_640", "getCameraImage, 640 x 480", speedup=4.0),
    Case("image_shadow", "getCameraImage, 320 x 240, with shadows", speedup=4.0),
    Case("load_panda", "loadURDF, our Panda", speedup=1.0),
    Case("load_original_panda", "loadURDF, the original Panda with its meshes", speedup=1.0),
)

# Each is a new process; what it does is in start.py.
STARTS = (
    Case("start_import", "new process, import pybullet", slowdown=1.3),
    Case("start_step", "new process to its first step of the Panda", slowdown=1.5),
    Case("start_contact", "new process to its first contact", slowdown=2.0),
    Case("start_image", "new process to its first camera image", slowdown=2.0),
    Case("start_inverse_kinematics", "new process to its first inverse kinematics", slowdown=2.0),
    Case("start_ray", "new process to its first ray", slowdown=2.0),
)
COLD_BUILD = Case("cold_build", "all kernels built on a fresh machine", seconds=60.0)
