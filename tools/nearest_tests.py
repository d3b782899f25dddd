"""Which tests are nearest to a file: for mutants, and for what a change touches.

`NEAREST` says it by folders and by files; the longest that holds a file counts. A test is nearest to itself.
"""

from __future__ import annotations

import subprocess
from collections.abc import Iterable
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).parents[1]
_HOURS_OF_A_CHANGE = 4

NEAREST: dict[str, tuple[str, ...]] = {
    "src/carom": ("test_world.py", "test_body.py", "test_modern_api.py", "started", "face/test_defaults.py"),
    "src/carom/algorithms": ("algorithms", "kinematics_as_asked", "face/test_defaults.py"),
    "src/carom/algorithms/answers.py": ("algorithms", "worlds/test_derivatives.py"),
    "src/carom/algorithms/mechanism.py": ("algorithms", "controllers/test_task_ik.py"),
    "src/carom/camera.py": ("test_camera.py", "face/test_defaults.py"),
    "src/carom/render/camera_image.py": ("test_camera.py",),
    "src/carom/cli": ("test_cli.py", "test_cli_commands.py", "test_serve.py", "test_profile.py"),
    "src/carom/cli/convert.py": ("formats/test_urdf_writer.py",),
    "src/carom/cli/pybullet_files.py": ("pybullet_data/test_copies_of_pybullets_files.py",),
    "src/carom/closed.py": (
        "face/test_names.py",
        "test_modern_api.py",
        "test_camera.py",
        "memory/test_closed.py",
    ),
    "src/carom/cluster": ("cluster",),
    "src/carom/conflicts.py": ("modules/test_conflict_messages.py",),
    "src/carom/control": ("control", "face/test_defaults.py"),
    "src/carom/controllers": ("controllers", "face/test_defaults.py"),
    "src/carom/description": ("model", "formats", "test_transform.py", "face/test_defaults.py", "sensors"),
    "src/carom/description/tendon.py": ("joints", "mjcf_files/test_tendons_of_files.py", "model"),
    "src/carom/editing": ("editing", "face/test_defaults.py"),
    "src/carom/engine": ("engine", "physics", "face/test_defaults.py"),
    "src/carom/engine/contact_arrays.py": ("engine", "collision/test_resets.py", "pybullet/contacts"),
    "src/carom/engine/engine.py": ("engine", "physics", "collision", "worlds", "face/test_defaults.py"),
    "src/carom/engine/lane_arrays.py": ("worlds", "engine/test_lane_rows.py"),
    "src/carom/engine/lane_sweeps.py": ("worlds", "engine/test_lane_rows.py"),
    "src/carom/engine/lane_work.py": ("worlds",),
    "src/carom/engine/runner.py": ("engine", "worlds", "physics"),
    "src/carom/engine/world_parameters.py": ("worlds", "engine"),
    "src/carom/examples": ("examples",),
    "src/carom/file_bodies.py": ("formats", "mjcf_files", "scenes", "usd"),
    "src/carom/files": ("formats",),
    "src/carom/files/boundary.py": ("budget", "formats"),
    "src/carom/files/budget.py": ("budget", "formats"),
    "src/carom/formats": ("formats",),
    "src/carom/formats/mjcf": ("mjcf_files", "beside_mujoco", "mjcf_dynamics", "formats"),
    "src/carom/formats/mjcf/compiled/deformables": ("deformables",),
    "src/carom/formats/mjcf/compiled/flexes": ("soft/test_flexes_of_files.py", "deformables", "mjcf_files"),
    "src/carom/formats/sdf": ("formats", "scenes"),
    "src/carom/formats/usd": ("usd", "formats"),
    "src/carom/foreign_names": ("face/test_names.py", "scenes/test_newcomers.py"),
    "src/carom/forks.py": ("worlds/test_fork.py", "interrupts/test_programs.py"),
    "src/carom/geometry": ("geometry", "pybullet/shapes"),
    "src/carom/gpu": ("gpu", "native/test_device_arrays.py"),
    "src/carom/identification": ("identification", "face/test_defaults.py"),
    "src/carom/jax.py": ("gradients/test_jax.py",),
    "src/carom/kernels": ("physics", "kernels"),
    "src/carom/kernels/contact": (
        "collision",
        "beside_mujoco",
        "kernels",
        "pybullet/contacts",
        "first_contacts",
    ),
    "src/carom/kernels/convergence": ("converged", "mjcf_files", "physics"),
    "src/carom/kernels/dynamics": (
        "physics",
        "joints",
        "mjcf_dynamics",
        "conformance",
        "pybullet/drops",
        "test_faults.py",
    ),
    "src/carom/kernels/images": ("render",),
    "src/carom/kernels/integrators": ("integrators",),
    "src/carom/kernels/inverse_kinematics": ("algorithms", "kinematics_as_asked", "kernels"),
    "src/carom/kernels/linearization": ("linearization",),
    "src/carom/kernels/mechanism": ("algorithms",),
    "src/carom/kernels/mechanism/task_control.py": ("controllers",),
    "src/carom/kernels/newton": ("converged", "mjcf_dynamics"),
    "src/carom/kernels/parallel": ("gpu", "kernels/test_runs_of_worlds.py"),
    "src/carom/kernels/queries": ("collision", "sensors"),
    "src/carom/kernels/shapes": ("collision", "kernels", "first_contacts"),
    "src/carom/kernels/soft": ("soft",),
    "src/carom/kernels/solver": ("physics", "kernels", "conformance"),
    "src/carom/kernels/tendons": ("joints", "mjcf_files"),
    "src/carom/layouts": ("native", "kernels"),
    "src/carom/layouts/flags.py": ("model", "render/test_appearance.py", "pybullet/shapes"),
    "src/carom/linearization": ("linearization", "worlds"),
    "src/carom/meshes": ("formats", "soft"),
    "src/carom/model": ("model", "formats", "pybullet/bodies"),
    "src/carom/model/shape_arrays.py": ("model", "collision", "pybullet/contacts", "pybullet/bodies"),
    "src/carom/model/soft_arrays.py": ("soft", "model"),
    "src/carom/model/soft_spec.py": ("soft", "pybullet/bodies/test_soft_urdf.py", "model"),
    "src/carom/native": ("native", "pybullet/calls"),
    "src/carom/native/building": ("native/building", "native/test_build_parts.py"),
    "src/carom/native/cpu.py": ("native/test_build_parts.py",),
    "src/carom/native/source": ("native", "pybullet/calls", "pybullet/bodies", "pybullet/contacts"),
    "src/carom/native/source/hulls": ("geometry", "pybullet/shapes"),
    "src/carom/native/source/joints.cpp": ("pybullet/joints", "pybullet/calls"),
    "src/carom/native/source/lanes": ("worlds",),
    "src/carom/native/source/motors.cpp": ("pybullet/joints", "pybullet/calls"),
    "src/carom/native/source/obj.cpp": ("formats/visuals",),
    "src/carom/native/source/turns.cpp": ("pybullet/test_rotation_helpers.py",),
    "src/carom/pose.py": ("test_transform.py", "test_body.py", "face", "script_helpers"),
    "src/carom/engine/queries": ("collision", "pybullet/contacts"),
    "src/carom/engine/queries/extents.py": ("model/test_bounds_of_bodies.py", "face/test_looks.py"),
    "src/carom/engine/queries/nearest_pair.py": ("sensors", "collision"),
    "src/carom/engine/queries/soft_bodies.py": ("soft/test_queries.py", "soft/test_soft_pairs.py"),
    "src/carom/engine/queries/soft_pairs.py": ("soft/test_queries.py", "soft/test_soft_pairs.py"),
    "src/carom/recording": ("test_recorder.py",),
    "src/carom/remote": ("remote", "pybullet/connections"),
    "src/carom/render": ("render",),
    "src/carom/render/world_looks.py": ("face/test_looks.py", "render"),
    "src/carom/replay": ("replays",),
    "src/carom/scene": ("scenes", "face", "joints", "sensors", "physics", "interrupts/test_setters.py"),
    "src/carom/scene/html_tables.py": ("test_notebook_displays.py",),
    "src/carom/scene/core/profile.py": ("test_profile.py",),
    "src/carom/scene/keyframes": ("sensors", "scenes"),
    "src/carom/scene/sensors": ("sensors", "physics/test_sensors.py", "mjcf_files"),
    "src/carom/scene/sensors/contacts.py": ("mjcf_files/test_contact_sensors_of_files.py", "sensors"),
    "src/carom/scene/tendons": ("joints", "mjcf_files"),
    "src/carom/scene/user_data.py": ("pybullet/bodies/test_user_data.py", "interrupts/test_setters.py"),
    "src/carom/simulator": ("simulator",),
    "src/carom/soft": ("soft",),
    "src/carom/soft/from_urdf.py": (
        "pybullet/bodies/test_kept_descriptions.py",
        "pybullet/bodies/test_soft_urdf.py",
    ),
    "src/carom/soft/reduced.py": ("pybullet/bodies/test_soft_urdf.py",),
    "src/carom/suggestions.py": ("test_advice.py", "modules"),
    "src/carom/torch.py": ("gradients/test_torch.py",),
    "src/carom/vector": ("vector",),
    "src/carom/viewer": ("viewer", "interrupts/test_viewer_locks.py"),
    "src/carom/viewer/input/turning.py": ("viewer/hands/test_turning.py", "viewer/hands"),
    "src/carom/viewer/page": ("viewer/modules", "viewer"),
    "src/carom/viewer/server.py": ("viewer", "pybullet/test_taken_port.py"),
    "src/carom/world": ("scenes", "face", "test_world.py", "test_body.py", "test_modern_api.py"),
    "src/carom/world/file_tendons.py": ("joints", "mjcf_files/test_tendons_of_files.py"),
    "src/carom/world/usd_files.py": ("usd", "scenes"),
    "src/carom/world_files": (
        "test_saved_worlds.py",
        "test_saved_files.py",
        "soft/test_states.py",
        "soft/test_textures.py",
    ),
    "src/carom/worlds": ("worlds", "face"),
    "src/carom/writing.py": ("interrupts/test_written_files.py", "test_saved_files.py"),
    "src/eglRenderer": ("pybullet/cameras",),
    "src/pybullet": ("pybullet/test_surface.py", "pybullet/calls"),
    "src/pybullet/_access": ("pybullet/bodies", "pybullet/calls", "pybullet/connections"),
    "src/pybullet/_algorithms": ("algorithms", "kinematics_as_asked", "pybullet/calls"),
    "src/pybullet/_bodies": ("pybullet/bodies",),
    "src/pybullet/_bodies/dynamics.py": ("pybullet/bodies", "pybullet/engine"),
    "src/pybullet/_calls": ("pybullet/calls",),
    "src/pybullet/_calls/detours.py": ("pybullet/connections", "pybullet/logs"),
    "src/pybullet/_cameras": ("pybullet/cameras",),
    "src/pybullet/_clients": ("pybullet/connections",),
    "src/pybullet/_connections": ("pybullet/connections",),
    "src/pybullet/_contacts": ("pybullet/contacts",),
    "src/pybullet/_engine": ("pybullet/engine",),
    "src/pybullet/_joints": ("pybullet/joints", "pybullet/calls"),
    "src/pybullet/_loading": ("pybullet/engine", "pybullet/bodies", "scenes"),
    "src/pybullet/_logs": ("pybullet/logs",),
    "src/pybullet/_maths": ("pybullet/test_rotation_helpers.py",),
    "src/pybullet/_plugins": ("pybullet/connections/test_plugins.py",),
    "src/pybullet/_shapes": ("pybullet/shapes",),
    "src/pybullet/_window": ("pybullet/test_window_calls.py", "viewer"),
    "src/pybullet/_window/debug_drawing.py": ("pybullet/test_window_calls.py",),
    "src/pybullet/_window/film.py": ("pybullet/logs",),
    "src/pybullet/_window/window.py": ("pybullet/test_window_calls.py",),
    "src/pybullet_data": ("pybullet_data",),
    "src/pybullet_envs": ("envs",),
    "src/pybullet_examples": ("modules",),
    "src/pybullet_robots": ("modules",),
    "src/pybullet_utils": ("script_helpers", "modules"),
    "examples": ("examples",),
    "docs": ("docs",),
    "tools": (),
    "tools/assets": ("pybullet_data",),
    "tools/differ": ("differ",),
    "tools/mutants": ("suite",),
    "tools/packaging": ("installation",),
    "tools/thorough": ("thorough",),
    "tests": (),
}
"""Folders and files of the project, and the tests nearest to them: folders and files below `tests`."""

_FILES = {
    "README.md": ("docs", "installation"),
    "CONTRIBUTING.md": ("docs",),
    "CHANGELOG.md": ("docs",),
    "pyproject.toml": ("installation",),
    "hatch_build.py": ("installation",),
}


def nearest_tests(file: str) -> list[str]:
    """The folders and files of tests nearest to a file; all by their paths from the root."""
    if file.startswith("tests/"):
        path = PurePosixPath(file)
        if path.name.startswith("test_"):
            return [file]
        # What all tests share is tried by all of them.
        return [str(path.parent)] if len(path.parts) > 2 else []
    for folder in map(str, (PurePosixPath(file), *PurePosixPath(file).parents)):
        if folder in NEAREST:
            return [f"tests/{place}" for place in NEAREST[folder]]
    return [f"tests/{place}" for place in _FILES.get(file, ())]


def touched_tests(files: Iterable[str]) -> list[str]:
    """The tests nearest to some files, each once, that are there; all in folders, so that none runs twice."""
    places = {place for file in files for place in nearest_tests(file) if (ROOT / place).exists()}
    folders = {place for place in places if not any(str(p) in places for p in PurePosixPath(place).parents)}
    return sorted(folders)


def changed_files(since: str | None = None) -> list[str]:
    """The files that differ from a commit, with those git doesn't know yet.

    Args:
        since: The commit. If left out, the last one that is more than four hours older than the newest one:
            changes land as runs of commits.
    """
    newest = int(_git("log", "-1", "--format=%ct"))
    before = since or _git("rev-list", "-1", f"--before={newest - 3600 * _HOURS_OF_A_CHANGE}", "HEAD")
    # A history may begin later than that.
    differing = _git("diff", "--name-only", before or "4b825dc642cb6eb9a060e54bf8d69288fbee4904")
    new = _git("ls-files", "--others", "--exclude-standard")
    return sorted({*differing.splitlines(), *new.splitlines()})


def _git(*arguments: str) -> str:
    done = subprocess.run(["git", *arguments], cwd=ROOT, capture_output=True, text=True, check=True)
    return done.stdout.strip()
