"""Controllers that use dynamics and kinematics: LQR, iLQR, control in task space, IK by tasks."""

from carom.controllers.box_qp import BoxQP, solve_box_qp
from carom.controllers.configuration import Configuration
from carom.controllers.equilibrium import Equilibrium, find_equilibrium
from carom.controllers.ik_constraints import EqualityTask, FreezeTask
from carom.controllers.ik_limits import (
    Bounds,
    CollisionAvoidanceLimit,
    ConfigurationLimit,
    Inequalities,
    Limit,
    VelocityLimit,
)
from carom.controllers.ilqr import ILQR, Plan
from carom.controllers.joint_space import ComputedTorque, gravity_compensation
from carom.controllers.lqr import LQR
from carom.controllers.riccati import lqr_gains, solve_discrete_are
from carom.controllers.state_space import StateSpace, WorldState, state_of
from carom.controllers.task_ik import NoSolutionError, TaskIK
from carom.controllers.task_space import (
    ImpedanceControl,
    OperationalSpaceControl,
    TaskDynamics,
    TaskSpaceControl,
)
from carom.controllers.tasks import (
    CenterOfMassTask,
    DampingTask,
    FrameTask,
    LookAtTask,
    PostureTask,
    RelativeFrameTask,
    Task,
    TaskRows,
)

__all__ = [
    "ILQR",
    "LQR",
    "Bounds",
    "BoxQP",
    "CenterOfMassTask",
    "CollisionAvoidanceLimit",
    "ComputedTorque",
    "Configuration",
    "ConfigurationLimit",
    "DampingTask",
    "EqualityTask",
    "Equilibrium",
    "FrameTask",
    "FreezeTask",
    "ImpedanceControl",
    "Inequalities",
    "Limit",
    "LookAtTask",
    "NoSolutionError",
    "OperationalSpaceControl",
    "Plan",
    "PostureTask",
    "RelativeFrameTask",
    "StateSpace",
    "Task",
    "TaskDynamics",
    "TaskIK",
    "TaskRows",
    "TaskSpaceControl",
    "VelocityLimit",
    "WorldState",
    "find_equilibrium",
    "gravity_compensation",
    "lqr_gains",
    "solve_box_qp",
    "solve_discrete_are",
    "state_of",
]
