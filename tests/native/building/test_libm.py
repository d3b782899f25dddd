import ctypes
import math
import subprocess
from pathlib import Path

import numpy as np
import pytest

from carom.native.building.cache import cache_folder
from carom.native.building.flags import C_FLAGS, MATHS, PLATFORM_FLAGS, PREFIX
from carom.native.building.libm import called_functions, include_folders, maths_sources
from carom.native.building.zig import find_zig
from carom.native.targets import Target

pytest.importorskip("ziglang", reason="kernels are compiled by Zig")

_TWO = {"atan2", "pow", "fmod", "hypot"}


@pytest.fixture(scope="module")
def maths(target: Target, tmp_path_factory: pytest.TempPathFactory) -> ctypes.CDLL:
    """All maths functions, exported."""
    zig = find_zig(cache_folder() / "zig")
    level = next(iter(target.levels))
    output = tmp_path_factory.mktemp("libm") / f"maths{target.suffix}"
    flags = [flag for flag in C_FLAGS if flag != "-fvisibility=hidden"]
    sources = [
        *maths_sources(MATHS, zig.library),
        *(f"-I{folder}" for folder in include_folders(zig.library)),
    ]
    arguments = [*flags, *PLATFORM_FLAGS[target.suffix], "-shared", "-nostdlib", *sources, "-o", output]
    subprocess.run(zig.command("cc", target, level, arguments), env=zig.environment(), check=True)
    library = ctypes.CDLL(str(output))
    for name in MATHS:
        function = getattr(library, PREFIX + name)
        function.restype = ctypes.c_double
        function.argtypes = [ctypes.c_double] * (2 if name in _TWO else 1)
    return library


@pytest.mark.parametrize("name", ["sin", "cos", "tan", "asin", "acos", "atan", "exp", "log"])
def test_functions_are_right_to_the_last_digit(maths: ctypes.CDLL, name: str):
    rng = np.random.default_rng(5)
    scales = {"asin": 1.0, "acos": 1.0, "exp": 700.0}
    for value in [*rng.uniform(-1, 1, 500) * scales.get(name, 20.0), *rng.uniform(-1, 1, 100) * 1e-9]:
        value = abs(value) if name == "log" else value
        got, true = getattr(maths, PREFIX + name)(value), getattr(math, name)(value)
        assert abs(got - true) <= 1.5 * math.ulp(true), value


@pytest.mark.parametrize("name", ["sin", "cos", "tan"])
def test_large_angles_are_reduced(maths: ctypes.CDLL, name: str):
    for value in (1e6, -1e15, 1e22, 1e300, 3 * math.pi / 4, -7 * math.pi / 2):
        true = getattr(math, name)(value)
        assert abs(getattr(maths, PREFIX + name)(value) - true) <= 1.5 * math.ulp(true)


@pytest.mark.parametrize("name", ["sin", "cos", "tan"])
@pytest.mark.parametrize("value", [math.inf, -math.inf, math.nan])
def test_what_is_not_finite_has_no_angle(maths: ctypes.CDLL, name: str, value: float):
    assert math.isnan(getattr(maths, PREFIX + name)(value))


@pytest.mark.parametrize("name", ["sin", "tan"])
def test_zero_keeps_its_sign(maths: ctypes.CDLL, name: str):
    assert math.copysign(1.0, getattr(maths, PREFIX + name)(-0.0)) == -1.0


@pytest.mark.parametrize("name", sorted(_TWO))
def test_functions_of_two_numbers(maths: ctypes.CDLL, name: str):
    rng = np.random.default_rng(6)
    for first, second in rng.uniform(0.1, 9.0, (200, 2)):
        true = getattr(math, name)(first, second)
        assert abs(getattr(maths, PREFIX + name)(first, second) - true) <= 1.5 * math.ulp(true)


def test_only_what_is_called_is_taken(tmp_path: Path):
    (tmp_path / "a.o").write_bytes(b"\0carom_asin\0_carom_cos\0carom_tangent\0")
    assert called_functions(tmp_path.glob("*.o")) == {"asin", "cos"}
