"""A fixed arm with an actuator, a sensor, a site and a tendon, and a free box."""

from __future__ import annotations

from carom import Body, World

ARM = """
<mujoco>
  <compiler angle="radian"/>
  <option timestep="0.004"/>
  <worldbody>
    <geom name="floor" type="plane" size="5 5 .1"/>
    <body name="arm" pos="0 0 1">
      <joint name="shoulder" axis="0 1 0" range="-2 2" limited="true"/>
      <geom name="upper" type="capsule" fromto="0 0 0 .3 0 0" size=".03"/>
      <body name="hand" pos=".3 0 0" euler=".2 0 0">
        <joint name="elbow" axis="0 1 0"/>
        <geom name="lower" type="capsule" fromto="0 0 0 .3 0 0" size=".02"/>
        <site name="tip" pos=".3 0 0"/>
      </body>
    </body>
    <body name="box" pos="1 0 .5"><freejoint/><geom name="cube" type="box" size=".1 .1 .1"/></body>
  </worldbody>
  <actuator>
    <position name="bend" joint="elbow" kp="30" kv="2" ctrlrange="-1 1" forcerange="-20 20"/>
    <motor name="turn" joint="shoulder" ctrlrange="-5 5"/>
  </actuator>
  <sensor><gyro name="rate" site="tip"/><jointpos name="angle" joint="elbow"/></sensor>
  <tendon><fixed name="cord" stiffness="1"><joint joint="elbow" coef=".1"/></fixed></tendon>
  <keyframe><key name="up" qpos="1 .5 1 0 .7 1 0 0 0"/></keyframe>
</mujoco>
"""


def made(text: str = ARM) -> tuple[World, Body, Body]:
    """The world, its arm and its box."""
    world = World()
    world.load(text)
    return world, world["arm"], world["box"]
