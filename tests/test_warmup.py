import warp as wp

from carom import World
from carom.warmup import KERNEL_MODULES, warmup


def test_nothing_is_left_to_compile_after_the_warm_up(tmp_path):
    robot = tmp_path / "ball.urdf"
    robot.write_text(
        '<robot name="ball"><link name="ball"><inertial><mass value="1"/>'
        '<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link></robot>'
    )
    warmup()
    loaded = {name: set(wp.get_module(name).execs) for name in KERNEL_MODULES}
    with World() as world:
        world.load_urdf(robot)
        world.step()
        assert {name: set(wp.get_module(name).execs) for name in KERNEL_MODULES} == loaded
