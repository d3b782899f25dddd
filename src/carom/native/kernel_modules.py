"""The modules that contain kernels."""


def _modules(*names: str) -> tuple[str, ...]:
    return tuple(f"carom.kernels.{name}" for name in names)


# Kernels of the native library; those that take longest to translate come first.
KERNEL_MODULES = _modules(
    *("solver.stages", "contact.stages", "soft.stages", "linearization.solution"),
    *("dynamics.step", "dynamics.lane_stages", "queries.rays", "queries.closest", "linearization.motion"),
    *("newton.stages", "newton.inverse", "solver.sleeping", "dynamics.lane_motion", "dynamics.step_ends"),
    *("late.stages", "adhesion.stages", "integrators.implicit", "integrators.runge_kutta"),
    *("integrators.midpoint", "integrators.stages", "integrators.lane_stages"),
    *("inverse_kinematics.many_searches", "inverse_kinematics.search"),
    "inverse_kinematics.pybullet_search",
    *("mechanism.derivatives", "mechanism.many_bodies", "dynamics.kinematics", "mechanism.momentum"),
    *("mechanism.link_motion", "mechanism.stable_pd", "mechanism.task_control", "mechanism.dynamics"),
    "images.draw",
    *("mechanism.motion", "dynamics.lane_sweeps", "queries.contact_report", "queries.touching"),
    *("sensors.reading", "sensors.last_loads"),
)
# Those of several worlds in lanes.
LANE_MODULES = _modules("dynamics.lane_motion", "dynamics.lane_sweeps")
# Kernels of steps in fine launches, for GPUs; those that take longest to compile come first.
PARALLEL_MODULES = _modules(
    *("parallel.soft_motion", "parallel.detection", "parallel.contact_rows", "parallel.restless_sweeps"),
    *(
        "parallel.batches",
        "parallel.sweeps",
        "parallel.trees",
        "parallel.late_trees",
        "parallel.soft_contact",
        "parallel.joint_rows",
    ),
    *("parallel.soft_nodes", "parallel.runs"),
)
# Kernels that work on arrays on a GPU between steps.
ARRAY_MODULES = _modules("arrays.arithmetic")
# Kernels that take a world through a whole stage; on GPUs there are others for this.
_WHOLE_WORLDS = _modules(
    *(
        "adhesion.stages",
        "contact.stages",
        "dynamics.lane_motion",
        "dynamics.lane_stages",
        "dynamics.lane_sweeps",
        "dynamics.step",
        "dynamics.step_ends",
    ),
    *("integrators.implicit", "integrators.lane_stages", "integrators.midpoint"),
    *("integrators.runge_kutta", "integrators.stages"),
    *("late.stages", "newton.inverse", "newton.stages", "soft.stages", "solver.stages"),
    # Each thread has the workspace of one body.
    *("inverse_kinematics.many_searches", "mechanism.many_bodies"),
    *("mechanism.derivatives", "mechanism.link_motion", "mechanism.momentum"),
    *("linearization.motion", "linearization.solution"),
)
CUDA_MODULES = (
    *PARALLEL_MODULES,
    *ARRAY_MODULES,
    *(name for name in KERNEL_MODULES if name not in _WHOLE_WORLDS),
)
