"""MJCF files with surfaces that move, tendons that stiffen, frames at centres of mass, and sharp edges."""

BELTS = """<mujoco><worldbody>
  <geom name="belt" type="box" size="2 .3 .1" pos="0 -.4 .1" euler="0 0 30" surfacevel=".8"/>
  <geom name="table" type="box" size=".5 .5 .05" pos="0 1 .05" condim="4" friction="1 .01 .001"
    surfacevel="0 0 0 0 0 2"/>
  <geom name="roller" type="cylinder" size=".1 .3" pos="0 2.3 .1" euler="90 0 0" surfacevel="0 0 0 0 0 -3"/>
  <body name="box" pos="0 -.4 .279"><freejoint/><geom type="box" size=".08 .08 .08" mass=".3"/></body>
  <body name="spun" pos="0 1 .149"><freejoint/><geom type="box" size=".05 .05 .05" mass=".3"/></body>
  <body name="carried" pos=".3 1 .149"><freejoint/><geom type="box" size=".05 .05 .05" mass=".3"/></body>
  <body name="ball" pos="0 2.3 .249"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
    <geom size=".05" mass=".3"/></body>
</worldbody></mujoco>"""

TENDONS = """<mujoco><option timestep="0.001"/><worldbody>
  <body name="square"><joint name="square" type="slide" axis="0 0 1" damping=".5"/><geom size=".1" mass="5"/>
  </body>
  <body name="cube" pos="1 0 0"><joint name="cube" type="slide" axis="0 0 1"/><geom size=".1" mass="5"/>
  </body>
  <body name="all" pos="2 0 0"><joint name="all" type="slide" axis="0 0 1"/><geom size=".1" mass="5"/>
  </body>
</worldbody><tendon>
  <fixed name="square" stiffness="0 -200"><joint joint="square" coef="1"/></fixed>
  <fixed name="cube" stiffness="0 0 300" springlength="-.1 .1"><joint joint="cube" coef="1"/></fixed>
  <fixed name="all" stiffness="100 -400 400" springlength=".2"><joint joint="all" coef="1"/></fixed>
</tendon></mujoco>"""

ALIGNED = """<mujoco><compiler alignfree="true"/><worldbody>
  <body name="tool" pos="0 0 1" euler="0 0 20"><freejoint/>
    <geom type="capsule" size=".1" fromto="0 0 0 1 0 0"/>
    <geom type="capsule" size=".1" fromto="1 0 0 1 1 0"/>
    <geom type="box" size=".1 .2 .3" pos="1 1 .4" euler="0 30 0"/>
    <site name="tip" pos="1 1 .9" euler="10 20 30"/></body>
  <body name="one" pos="0 3 1"><freejoint/><geom type="box" size=".1 .2 .3" pos=".2 0 0" euler="0 30 0"/>
  </body>
  <body name="stated" pos="0 5 1"><freejoint align="true"/><geom size=".1"/>
    <inertial pos="0 .1 0" euler="10 20 30" mass="1" diaginertia="1 2 2.5"/></body>
  <body name="kept" pos="0 7 1"><freejoint align="false"/><geom size=".1" pos=".3 0 0"/></body>
  <body name="parent" pos="0 9 1"><freejoint/><geom size=".1" pos=".3 0 0"/>
    <body><geom size=".1"/></body></body>
</worldbody></mujoco>"""

EDGES = """<mujoco><option cone="elliptic"/><worldbody>
  <geom type="box" size=".03 .1 .03" euler="0 40 0"/>
  <body name="rod" pos=".01 0 .06"><joint type="slide" axis="1 0 0"/><joint type="slide" axis="0 0 1"/>
    <joint axis="0 1 0"/><geom type="capsule" size=".005 .2" euler="0 90 0"/></body>
</worldbody></mujoco>"""

MOVING = {"belts": BELTS, "tendons": TENDONS, "edges": EDGES}
STEPS = 120
