"""Every kernel of a step compiles for a GPU, and takes no more of one than it should. No GPU is needed."""

from importlib import import_module
from pathlib import Path

import pytest
from tools.gpu.compile import compile_modules
from tools.gpu.resources import Resources, find_assembler, parse_report, resources_of

from carom.native.kernel_modules import CUDA_MODULES

pytest.importorskip("warp", reason="compiles kernels for GPUs")

SPILLS = {
    "pair_candidates_kernel": 12_500,
    "island_contacts_kernel": 11_000,
    "restless_sweeps_kernel": 1_500,
    "resting_sweeps_kernel": 200,
    "small_steps_kernel": 1_000,
    "closest_points_kernel": 5_000,
    "nearest_pair_kernel": 5_000,
    "rays_kernel": 1_600,
}
"""Bytes that kernels may write and read for want of registers; all others none."""

STACK = 4_100
"""Bytes of stack that a thread may take."""

REPORT = """
ptxas info    : Compiling entry function 'first_kernel_0a1b2c3d_cuda_kernel_forward' for 'sm_90'
ptxas info    : Function properties for first_kernel_0a1b2c3d_cuda_kernel_forward
    40 bytes stack frame, 8 bytes spill stores, 12 bytes spill loads
ptxas info    : Used 168 registers, used 0 barriers, 96 bytes cumulative stack size, 1024 bytes smem
ptxas info    : Compile time = 5.000 ms
ptxas info    : Function properties for called_0
    0 bytes stack frame, 100 bytes spill stores, 200 bytes spill loads
ptxas info    : Compiling entry function 'second_kernel_4e5f6a7b_cuda_kernel_forward' for 'sm_90'
ptxas info    : Function properties for second_kernel_4e5f6a7b_cuda_kernel_forward
    0 bytes stack frame, 0 bytes spill stores, 0 bytes spill loads
ptxas info    : Used 30 registers, used 0 barriers
"""


def test_a_report_of_the_assembler_is_understood() -> None:
    first, second = parse_report(REPORT)
    assert first == Resources("first_kernel", registers=168, stack=96, spill_stores=108, spill_loads=212)
    assert second == Resources("second_kernel", registers=30, stack=0, spill_stores=0, spill_loads=0)


def test_kernels_that_may_spill_are_there() -> None:
    modules = [import_module(module) for module in CUDA_MODULES]
    assert [name for name in SPILLS if not any(hasattr(module, name) for module in modules)] == []


@pytest.mark.thorough
@pytest.mark.parametrize("module", CUDA_MODULES)
def test_a_module_compiles_for_a_gpu_and_fits_into_its_registers(module: str, tmp_path: Path) -> None:
    (compiled,) = compile_modules([module], tmp_path)
    assert ".target sm_90" in compiled.ptx.read_text(encoding="utf-8")
    assembler = find_assembler()
    if assembler is None:
        pytest.skip(
            "compiled; how many registers that takes only ptxas says, of the package nvidia-cuda-nvcc"
        )
    kernels = resources_of(compiled.ptx, assembler)
    own = {name for name in SPILLS if getattr(import_module(module), name, None) is not None}
    assert kernels
    assert {kernel.kernel for kernel in kernels} >= own
    greedy = {
        kernel.kernel: (kernel.stack, kernel.spill_stores, kernel.spill_loads)
        for kernel in kernels
        if kernel.spill_stores + kernel.spill_loads > SPILLS.get(kernel.kernel, 0) or kernel.stack > STACK
    }
    assert greedy == {}
