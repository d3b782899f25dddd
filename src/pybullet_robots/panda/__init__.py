"""The Panda over a tray: it moves above it (`panda_sim`) or grasps what is in it (`panda_sim_grasp`)."""

from pybullet_utils._absent import announce

announce(
    __name__,
    """
# it is one of PyBullet's examples; Carom's own are in its documentation
.: batchsim3 batchsim3_grasp
""",
)
