"""Small files that the tests of descriptions put together."""

ARM = """<mujoco model="arm"><compiler angle="degree"/>
<default><joint damping=".5"/><default class="light"><geom density="500" rgba="1 0 0 1"/></default>
 <default class="drive"><position kp="20" ctrlrange="-1 1"/></default></default>
<worldbody><body name="upper" pos="0 0 1"><joint name="shoulder" axis="0 1 0" range="-90 90"/>
 <geom name="bone" class="light" type="capsule" size=".05" fromto="0 0 0 .5 0 0"/>
 <body name="lower" pos=".5 0 0"><joint name="elbow" axis="0 1 0" ref="30" armature=".01"/>
  <geom type="capsule" size=".04" fromto="0 0 0 .4 0 0"/>
  <site name="tip" pos=".4 0 0" euler="0 90 0"/></body></body></worldbody>
<tendon><fixed name="cord" stiffness="2"><joint joint="shoulder" coef="1"/><joint joint="elbow" coef="-1"/>
 </fixed></tendon>
<actuator><position name="lift" class="drive" joint="shoulder"/><motor name="pull" tendon="cord"/></actuator>
<sensor><jointpos name="angle" joint="elbow"/><framepos name="end" objtype="site" objname="tip"/></sensor>
<contact><exclude body1="upper" body2="lower"/></contact>
<keyframe><key name="home" qpos=".1 .2" ctrl=".3 .4"/></keyframe></mujoco>"""

GRIPPER = """<mujoco model="gripper"><option timestep=".001"/><worldbody><body name="palm" pos="0 0 .05">
 <freejoint name="free"/><geom size=".03" mass=".3"/><body name="finger" pos="0 .02 .04">
 <joint name="slide" type="slide" axis="0 1 0" range="0 .04"/>
 <geom type="box" size=".005 .005 .02" mass=".05"/></body></body></worldbody>
<actuator><position name="grip" joint="slide" kp="100"/></actuator>
<sensor><jointpos name="opening" joint="slide"/>
 <framelinvel name="drift" objtype="body" objname="palm"/></sensor>
<keyframe><key name="home" qpos="0 0 .05 1 0 0 0 .01" ctrl=".02"/></keyframe></mujoco>"""
