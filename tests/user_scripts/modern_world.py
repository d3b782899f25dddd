"""The modern interface: worlds, bodies and joints as objects."""

from pathlib import Path

import numpy as np

from carom import World
from carom.control import PID

PENDULUM = """
<robot name="pendulum">
  <link name="base"/>
  <link name="bob">
    <inertial>
      <origin xyz="0 0 -1"/><mass value="1"/>
      <inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/>
    </inertial>
  </link>
  <joint name="hinge" type="continuous">
    <parent link="base"/><child link="bob"/><axis xyz="0 1 0"/>
  </joint>
</robot>
"""


def main(folder: Path) -> tuple[float, float]:
    file = folder / "pendulum.urdf"
    file.write_text(PENDULUM)
    with World(time_step=1 / 500) as world:
        world.gravity = (0.0, 0.0, -9.81)
        pendulum = world.load_urdf(file, fixed_base=True)
        hinge, bob = pendulum.joints["hinge"], pendulum.links["bob"]
        hinge.reset(0.5)
        hinge.free()
        start = world.snapshot()
        world.step(500)
        swung = hinge.position

        world.restore(start)
        pid = PID(kp=50, ki=80, kd=10, output_limits=(-30, 30))
        while world.time < 4.0:
            hinge.set_torque(pid.update(0.2, hinge.position, world.parameters.time_step))
            world.step()
        position, _orientation = bob.pose
        assert np.isfinite(position).all()
        assert np.allclose(pendulum.joints.positions, [hinge.position])
        return swung, hinge.position
