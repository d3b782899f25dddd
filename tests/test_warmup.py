import re
import subprocess
import sys
from pathlib import Path

import carom
from carom.warmup import KERNEL_MODULES, ON_DEMAND, PARALLEL_MODULES

SCRIPT = """
import warp as wp
from carom import World
from carom.warmup import KERNEL_MODULES, warmup

def loaded():
    return {name: set(wp.get_module(name).execs) for name in KERNEL_MODULES}

warmup()
before = loaded()
with World() as world:
    world.load_urdf(sys.argv[1])
    world.step()
assert all(before.values()), before
assert loaded() == before, loaded()
"""


def test_every_module_with_kernels_is_warmed_up():
    source = Path(carom.__file__).parent
    with_kernels = {
        ".".join(("carom", *file.relative_to(source).with_suffix("").parts))
        for file in source.rglob("*.py")
        if re.search(r"^@kernel$", file.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert {*KERNEL_MODULES, *ON_DEMAND, *PARALLEL_MODULES} == with_kernels


def test_nothing_is_left_to_compile_after_the_warm_up(tmp_path):
    robot = tmp_path / "ball.urdf"
    robot.write_text(
        '<robot name="ball"><link name="ball"><inertial><mass value="1"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link></robot>'
    )
    # A process of its own: other tests have loaded the modules in this one.
    subprocess.run([sys.executable, "-c", "import sys\n" + SCRIPT, str(robot)], check=True)
