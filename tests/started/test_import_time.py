"""What an import brings with it decides how quick it is; each is looked at in a process of its own."""

import subprocess
import sys

import pytest

HEAVY = {
    "matplotlib",
    "trimesh",
    "websockets",
    "asyncio",
    "carom.viewer.viewer",
    "gymnasium",
    "scipy",
    "PIL",
    "tkinter",
}


def modules_after(statement: str) -> set[str]:
    script = f"import sys\n{statement}\nprint(*sys.modules)"
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=True)
    return set(result.stdout.split())


@pytest.mark.parametrize("statement", ["import pybullet", "import carom", "import carom.control"])
def test_no_import_brings_in_plotting_meshes_or_a_viewer(statement):
    assert not modules_after(statement) & HEAVY


def test_arrays_and_logging_wait_for_a_world_and_a_warning():
    assert not modules_after("import pybullet") & {
        "numpy",
        "logging",
        "carom.formats.urdf",
        "carom.algorithms",
        "carom.description.geometry",
        "carom.description.link",
        "carom.model.body_spec",
        "sysconfig",
    }


def test_a_rigid_robot_does_not_load_what_soft_ones_need():
    loaded = modules_after('import carom\ncarom.World().load_urdf("r2d2.urdf")')
    assert "carom.formats.urdf.reader" in loaded
    assert not loaded & {"carom.formats.urdf.deformable", "carom.description.deformable", "carom.soft.build"}


def test_a_first_step_does_not_load_what_it_does_not_use():
    lines = (
        "import pybullet as p, pybullet_data",
        "p.connect(p.DIRECT)",
        'p.loadURDF(pybullet_data.getDataPath() + "/r2d2.urdf")',
        "p.stepSimulation()",
    )
    loaded = modules_after("\n".join(lines))
    assert "carom.formats.urdf.reader" in loaded
    unused = {"actuator", "keyframe", "sensor", "site", "tendon"}
    assert not loaded & {f"carom.description.{name}" for name in unused}
    assert not loaded & {"carom.description.compliance", "carom.description.fluid"}
    assert not loaded & {"carom.meshes.ply", "carom.meshes.stl", "carom.formats.reading.written"}
    assert not loaded & {"carom.formats.reading.cursor", "carom.formats.reading.ignored"}
    assert not loaded & {"carom.model.merge_fixed", "carom.model.mjcf_inertia", "carom.model.written_inertia"}
    assert not loaded & {"carom.geometry.heightfield", "carom.geometry.triangle_hierarchy"}
    assert not loaded & {
        "carom.model.soft_spec",
        "carom.scene.snapshot",
        "carom.scene.soft_body",
        "sysconfig",
    }
    assert not loaded & {"tempfile", "carom.meshes.collada", "carom.meshes.gltf"}
    assert "numpy.typing" not in loaded


def data_classes_after(statement: str) -> set[str]:
    lines = (
        "import gc, sys",
        statement,
        "classes = [it for it in gc.get_objects() if isinstance(it, type)]",
        "classes = [it for it in classes if '__dataclass_params__' in vars(it)]",
        "made = {f'{it.__module__}.{it.__qualname__}' for it in classes}",
        "print('made:', *made)",
    )
    script = [sys.executable, "-c", "\n".join(lines)]
    said = subprocess.run(script, capture_output=True, text=True, check=True).stdout
    return set(said.partition("made:")[2].split())


def test_the_import_makes_two_data_classes():
    made = data_classes_after("import pybullet")
    assert made == {"carom.description.pose.Pose", "carom.files.budget.Budget"}


def test_a_first_step_makes_few_data_classes():
    """The decorator compiles up to six functions for each class, which takes 1 to 5 million instructions."""
    lines = (
        "import pybullet as p, pybullet_data",
        "p.connect(p.DIRECT)",
        'p.loadURDF(pybullet_data.getDataPath() + "/r2d2.urdf")',
        "p.stepSimulation()",
    )
    # Those that describe a robot, parameters of the engine and of links, rows, and the budget of reading.
    made = data_classes_after("\n".join(lines))
    assert len(made) <= 45, made


def test_a_small_image_starts_no_threads():
    lines = (
        "import pybullet as p, pybullet_data",
        "p.connect(p.DIRECT)",
        'p.loadURDF(pybullet_data.getDataPath() + "/r2d2.urdf")',
        "p.getCameraImage(64, 64, renderer=p.ER_TINY_RENDERER)",
    )
    loaded = modules_after("\n".join(lines))
    assert "carom.render.renderer" in loaded
    assert not loaded & {"concurrent.futures", "logging"}


@pytest.mark.parametrize(
    "statement", ["import carom", "import pybullet_data", "from carom.control import PID"]
)
def test_what_needs_no_physics_does_not_load_the_compiler(statement):
    assert "warp" not in modules_after(statement)


def test_importing_the_drop_in_prints_nothing():
    script = [sys.executable, "-c", "import pybullet, pybullet_data"]
    result = subprocess.run(script, capture_output=True, text=True, check=True)
    assert (result.stdout, result.stderr) == ("", "")


def test_a_first_step_does_not_load_seldom_used_parts_of_the_standard_library():
    script = (
        "import sys, pybullet as p, pybullet_data\n"
        "before = set(sys.modules)\n"
        "import numpy\n"
        "of_numpy = set(sys.modules) - before\n"
        "p.connect(p.DIRECT)\n"
        'p.loadURDF(pybullet_data.getDataPath() + "/r2d2.urdf")\n'
        "p.stepSimulation()\n"
        'unused = {"heapq", "encodings.ascii", "encodings.utf_8_sig", "xml"}\n'
        "print(*sorted(unused & (set(sys.modules) - of_numpy)))\n"
    )
    # Packages that are imported as Python starts may need them.
    result = subprocess.run(
        [sys.executable, "-I", "-S", "-c", f"import sys; sys.path[:0] = {sys.path!r}\n{script}"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert result.stdout.split() == []


def test_bodies_of_one_shape_do_not_load_a_reader_of_files():
    loaded = modules_after("import carom\ncarom.World().add_capsule()\ncarom.World().add_box()")
    assert not [name for name in loaded if name.startswith(("carom.formats.mjcf", "carom.formats.urdf"))]
