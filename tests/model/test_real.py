"""The engine's number type, and literals of that type in kernels."""

# Kernel code is checked by Warp, not by the Python type checker.
# pyright: reportCallIssue=false

import os
import subprocess
import sys

import numpy as np
import pytest
import warp as wp

from carom.model.real import NUMPY_REAL, PRECISION, RealRows, Vector3, func, kernel, real

ENVIRONMENT = {name: value for name, value in os.environ.items() if name != "CAROM_PRECISION"}


@func
def tenth_of(value: real) -> real:
    """A tenth, as a literal in a function."""
    return value * 0.1


@kernel
def literals_kernel(answers: RealRows):
    """Literals in all kinds of places."""
    row = wp.tid()
    third = 1.0 / 3.0
    answers[row, 0] = third
    answers[row, 1] = tenth_of(1.0)
    answers[row, 2] = -0.7
    answers[row, 3] = wp.dot(Vector3(0.1, 0.2, 0.3), Vector3(1.0, 10.0, 100.0))
    total = real(0.0)
    for i in range(3):
        total += 0.1 * real(i)
    answers[row, 4] = total
    if third > 0.3333333333:
        answers[row, 5] = 1e-300


def test_numbers_are_double_precision_unless_told_otherwise():
    assert PRECISION == "float64"
    assert real is wp.float64
    assert NUMPY_REAL is np.float64


def test_literals_in_kernels_have_the_precision_of_the_engine():
    answers = np.zeros((1, 6))
    rows = wp.array2d(answers, dtype=real, device="cpu", copy=False)
    wp.launch(literals_kernel, dim=1, inputs=[rows], device="cpu")
    total = 0.0 + 0.1 * 0 + 0.1 * 1 + 0.1 * 2
    expected = [1.0 / 3.0, 0.1, -0.7, 0.1 + 0.2 * 10.0 + 0.3 * 100.0, total, 1e-300]
    np.testing.assert_allclose(answers[0], expected, rtol=1e-15)


def test_functions_keep_their_names_and_descriptions():
    assert tenth_of.__name__ == "tenth_of"
    assert tenth_of.__doc__ == "A tenth, as a literal in a function."


def run(code: str, precision: str) -> subprocess.CompletedProcess[str]:
    """Run Python code in a process whose engine has the given precision."""
    return subprocess.run(
        [sys.executable, "-c", code],
        env={**ENVIRONMENT, "CAROM_PRECISION": precision},
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.parametrize("precision", ["float16", "", "double"])
def test_an_unknown_precision_is_refused(precision):
    process = run("import carom.model.real", precision)
    assert process.returncode != 0
    assert f"CAROM_PRECISION is {precision!r}" in process.stderr
    assert "float32" in process.stderr


SINGLE_PRECISION_SWING = """
import math
import numpy as np
from carom import World
from carom.model.body_spec import BodySpec, LinkSpec
from carom.description import JointType, Pose

rod = LinkSpec("rod", mass=2.0, inertia=(0.1, 0.1, 0.1), inertial_frame=Pose((0.0, 0.0, -0.5)),
               joint_type=JointType.REVOLUTE, joint_axis=(0.0, 1.0, 0.0))
world = World()
world.gravity = (0.0, 0.0, -9.81)
body = world.load(BodySpec("arm", LinkSpec("base"), [rod], fixed_base=True))
body.change_dynamics(-1, linear_damping=0.0, angular_damping=0.0)
assert world.position.dtype == world.motor.dtype == np.float32
world.motor[6, 4] = 0.0
body.set_joint_state(0, [1.0], [0.0])
q, v = 1.0, 0.0
for _ in range(120):
    v -= 2.0 * 9.81 * 0.5 * math.sin(q) / 0.6 / 240.0
    q += v / 240.0
    world.step()
print(abs(world.position[7] - q), abs(world.velocity[6] - v))
"""


@pytest.mark.slow
def test_single_precision_swings_an_arm():
    process = run(SINGLE_PRECISION_SWING, "float32")
    assert process.returncode == 0, process.stderr
    errors = [float(word) for word in process.stdout.split()]
    assert max(errors) < 1e-4
    # Double precision would agree to its own rounding.
    assert max(errors) > 1e-12
