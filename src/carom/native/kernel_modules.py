"""The modules that contain kernels."""

# Kernels of the native library.
KERNEL_MODULES = (
    "carom.kernels.contact.stages",
    "carom.kernels.dynamics.kinematics",
    "carom.kernels.dynamics.motor_commands",
    "carom.kernels.dynamics.step",
    "carom.kernels.dynamics.step_ends",
    "carom.kernels.images.draw",
    "carom.kernels.inverse_kinematics.search",
    "carom.kernels.mechanism.dynamics",
    "carom.kernels.mechanism.motion",
    "carom.kernels.mechanism.stable_pd",
    "carom.kernels.queries.closest",
    "carom.kernels.queries.contact_report",
    "carom.kernels.queries.rays",
    "carom.kernels.queries.touching",
    "carom.kernels.soft.stages",
    "carom.kernels.solver.sleeping",
    "carom.kernels.solver.stages",
)
# Kernels of steps in fine launches, for GPUs; those that take longest to compile come first.
PARALLEL_MODULES = (
    "carom.kernels.parallel.soft_motion",
    "carom.kernels.parallel.detection",
    "carom.kernels.parallel.contact_rows",
    "carom.kernels.parallel.restless_sweeps",
    "carom.kernels.parallel.batches",
    "carom.kernels.parallel.sweeps",
    "carom.kernels.parallel.trees",
    "carom.kernels.parallel.soft_contact",
    "carom.kernels.parallel.joint_rows",
    "carom.kernels.parallel.soft_nodes",
    "carom.kernels.parallel.runs",
)
# Kernels that work on arrays on a GPU between steps.
ARRAY_MODULES = ("carom.kernels.arrays.arithmetic",)
# Kernels that take a world through a whole stage; on GPUs there are others for this.
_WHOLE_WORLDS = {
    "carom.kernels.contact.stages",
    "carom.kernels.dynamics.step",
    "carom.kernels.dynamics.step_ends",
    "carom.kernels.soft.stages",
    "carom.kernels.solver.stages",
}
CUDA_MODULES = (
    *PARALLEL_MODULES,
    *ARRAY_MODULES,
    *(name for name in KERNEL_MODULES if name not in _WHOLE_WORLDS),
)
