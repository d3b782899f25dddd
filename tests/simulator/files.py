"""Files that the simulator is tried with."""

from pathlib import Path

SCENE = """<mujoco>
  <option timestep="0.002"/>
  <worldbody>
    <geom name="floor" type="plane" size="2 2 1"/>
    <body name="block" pos="0 0 0.1">
      <freejoint name="root"/>
      <geom type="box" size=".1 .1 .1"/>
      <site name="top" pos="0 0 .1"/>
      <body name="arm" pos="0 0 .2">
        <joint name="swing" type="hinge" axis="0 1 0" damping="0.1"/>
        <geom type="capsule" size=".02" fromto="0 0 0 0 0 .2" mass="0.1"/>
        <body name="hand" pos="0 0 .25">
          <joint name="wrist" type="ball" damping="0.1"/>
          <geom size=".03" mass="0.05"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator><motor name="drive" joint="swing" ctrlrange="-1 1"/></actuator>
  <sensor><jointpos name="angle" joint="swing"/><accelerometer name="felt" site="top"/></sensor>
  <keyframe>
    <key name="bent" time="1.5" qpos="0.5 0 0.1 1 0 0 0 0.25 0.8 0.6 0 0"
      qvel="1 0 0 0 0 2 0.5 0 0 0" ctrl="0.25"/>
  </keyframe>
</mujoco>"""

XACRO = """<robot name="post" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="height" default="1.5"/>
  <xacro:include filename="colours.xacro"/>
  <link name="foot">
    <visual><geometry><box size="0.1 0.1 $(arg height)"/></geometry></visual>
    <inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
</robot>"""

COLOURS = (
    """<robot xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:arg name="colour" default="red"/></robot>"""
)


def scene(folder: Path, text: str = SCENE) -> Path:
    """The MJCF scene as a file."""
    file = folder / "scene.xml"
    file.write_text(text, encoding="utf-8")
    return file


def xacro(folder: Path) -> Path:
    """The robot with macros as a file, and the file that it includes."""
    (folder / "colours.xacro").write_text(COLOURS, encoding="utf-8")
    file = folder / "post.urdf.xacro"
    file.write_text(XACRO, encoding="utf-8")
    return file
