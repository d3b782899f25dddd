"""The modern interface: worlds, bodies and joints as objects."""

from pathlib import Path

from carom import World

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


def main(folder: Path) -> float:
    file = folder / "pendulum.urdf"
    file.write_text(PENDULUM)
    with World() as world:
        world.gravity = (0.0, 0.0, -9.81)
        pendulum = world.load_urdf(file, fixed_base=True)
        hinge = pendulum.joints["hinge"]
        hinge.reset(0.5)
        hinge.disable_motor()
        world.step(240)
        return hinge.position
