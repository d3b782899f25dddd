"""A Panda arm over a tray: it follows a path (`panda_sim`) or grasps a brick (`panda_sim_grasp`)."""

from pybullet._absent import announce

announce(
    __name__,
    """
# it is one of PyBullet's examples; Carom's own are in its documentation
.: batchsim3 batchsim3_grasp
""",
)
