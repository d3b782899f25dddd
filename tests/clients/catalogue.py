"""Other people's code that runs on PyBullet, and is run on Carom too."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any


@dataclass(frozen=True)
class Suite:
    """Tests of a project.

    Attributes:
        repository: Owner and name of its repository on GitHub.
        tests: Folder or files of the tests in it.
        options: Arguments of pytest.
        path: Folder of the repository that is put on Python's path: projects are run as they lie there.
    """

    repository: str
    tests: tuple[str, ...]
    options: tuple[str, ...] = ()
    path: str = "."


@dataclass(frozen=True)
class Scripts:
    """Scripts that are watched for a while.

    Attributes:
        module: The package of PyBullet's that has them, or none.
        repository: Owner and name of the repository that has them, or none.
        folder: Where in it they are.
        left_out: Names of scripts that need what is not there: a headset, a second process, a person.
    """

    module: str | None = None
    repository: str | None = None
    folder: str = ""
    left_out: tuple[str, ...] = ()


@dataclass(frozen=True)
class Task:
    """A scripted policy in an environment of `roboverse`; see `tasks.py`.

    Attributes:
        environment: Its identifier.
        policy: Name of the policy.
        success: The entry of the information that says whether the trial succeeded.
        steps: Number of actions.
        changes: Arguments of the environment that differ from the registered ones: only some of the objects
            that they name lie in the repository.
    """

    environment: str
    policy: str
    success: str
    steps: int
    changes: dict[str, Any] = field(default_factory=dict)


ROBOVERSE = "avisingh599/roboverse"
TRIALS = 8
_ANYWHERE = {"object_position_low": (0.5, 0.18, -0.3), "object_position_high": (0.7, 0.27, -0.3)}
_BOTTLE = {
    "object_names": ("gatorade",),
    "object_scales": (0.75,),
    "object_orientations": ((0, 0, 1, 0),),
    "target_object": "gatorade",
}
_TWO = {"object_names": ("shed", "ball"), "object_scales": (0.7, 0.7), "target_object": "shed"}
_ONE = {"object_names": ("shed",), "object_scales": (0.7,)}

TASKS = {
    "grasp a shed": Task("Widow250GraspEasy-v0", "grasp", "grasp_success", 30),
    "grasp a shed anywhere": Task("Widow250GraspEasy-v0", "grasp", "grasp_success", 30, _ANYWHERE),
    "grasp a bottle from a tray": Task("Widow250Grasp-v0", "grasp", "grasp_success", 30, _BOTTLE),
    "grasp one of two from a tray": Task("Widow250Grasp-v0", "grasp", "grasp_success", 30, _TWO),
    "put a shed on a tray": Task("Widow250PickTray-v0", "pickplace", "place_success", 40),
    "put a shed into a tray anywhere": Task("Widow250PutInTray-v0", "pickplace", "place_success", 40, _ONE),
    "open a drawer": Task("Widow250DrawerOpen-v0", "drawer_open", "drawer_opened_success", 40),
    "open a drawer anywhere": Task(
        "Widow250DrawerRandomizedOpen-v0", "drawer_open", "drawer_opened_success", 40
    ),
}


# Scripts that come to something else on purpose, or by chance, and why: docs/differences.md has it at length.
KNOWN = {
    "deformable_anchor": "anchored cloth swings otherwise, by up to 0.12 m in a second",
    "deformable_torus": "PyBullet makes a body without nodes of a file that is not there",
    "inverted_pendulum_tendon_actuation": "a constraint holds a link that PyBullet takes for still, so it "
    "solves two islands one after the other; with `minimumSolverIslandSize=1000` the first steps are equal",
    "load_soft_body": "outside the deformable world PyBullet weighs nodes by areas of faces",
    "deformable_add_remove_objects": "elastic forces are taken in small steps, which ends in other shapes",
    "reduced_deformable_cube": "reduced bodies are full solids",
    "reduced_deformable_torus": "reduced bodies are full solids",
    "loadingBench": "a plate is loaded into a robot, 12 cm deep, and they part otherwise",
    "biped2d_pybullet": "a ball lies with its centre on the axis of a box, and may leave by either side",
    "minitaur_test": "the forces on feet of closed loops depend on which contacts were found first",
    "quadruped": "the forces on feet of closed loops depend on which contacts were found first",
    "snake": "useMaximalCoordinates makes no links in PyBullet",
    "switchConstraintSolver": "Dantzig's solver is not built",
    "vhacd": "CoACD takes longer than a script is watched",
}


# Those that wait for a server, drive a headset or a real robot, or dump logs named on the command line.
_NO_HARDWARE = (
    "dumpLog",
    "dumpVrLog",
    "graphicsClient",
    "graphicsServer",
    "grpcClient",
    "grpcServer",
    "hand",
    "logMinitaur",
    "minitaur_evaluate",
    "vrEvent",
    "vr_kitchen_setup_vrSyncPython",
    "vr_kuka_control",
    "vr_kuka_pr2_move",
    "vr_kuka_setup",
    "vr_kuka_setup_vrSyncPlugin",
    "vr_kuka_setup_vrSyncPython",
    "vr_racecar_differential",
    "vrhand",
    "vrhand_vive_tracker",
    "vrminitaur",
    "vrtracker",
)

SUITES = {
    "panda-gym": Suite(
        "qgallouedec/panda-gym",
        tuple(
            f"test/{name}_test.py"
            for name in ("envs", "import", "pybullet", "render", "save_and_restore", "seed")
        ),
    ),
    # Learning takes torch and many minutes: `learn` is left to those who have them.
    "gym-pybullet-drones": Suite("utiasDSL/gym-pybullet-drones", ("tests",), ("-k", "not learn")),
}

SCRIPTS = {
    "examples in the wheel": Scripts(module="pybullet_examples", left_out=_NO_HARDWARE),
    "examples in the repository": Scripts(
        repository="bulletphysics/bullet3", folder="examples/pybullet/examples", left_out=_NO_HARDWARE
    ),
}
