"""A file with range finders; `record_range_images.py` asks MuJoCo what they show."""

ANGLE = 0.05
"""Position of the joint."""
_ALL = "dist dir origin point normal depth"
RANGES = f"""<mujoco>
  <worldbody>
    <geom type="plane" size="5 5 .1"/><geom size=".3" pos=".1 0 .4"/>
    <body name="a" pos="0 0 2" euler="180 0 0">
      <joint name="j" axis="0 1 0"/><geom size=".05"/>
      <site name="s" pos="0 0 .06"/><site name="looking up" pos="0 0 -.06" euler="180 0 0"/>
      <site name="inside"/>
      <camera name="c" pos=".02 0 .1" euler="180 0 0" fovy="60" resolution="4 3"/>
      <camera name="aslant" pos=".02 0 .1" euler="150 20 0" fovy="80" resolution="3 5"/>
      <camera name="square" projection="orthographic" pos="0 0 .1" euler="180 0 0" fovy="1" resolution="2 2"/>
    </body>
  </worldbody>
  <sensor>
    <rangefinder name="everything" site="s" data="{_ALL}"/>
    <rangefinder name="nothing" site="looking up" data="{_ALL}"/>
    <rangefinder name="from within" site="inside" data="dist normal"/>
    <rangefinder name="distances" camera="c"/>
    <rangefinder name="everything of a camera" camera="c" data="{_ALL}"/>
    <rangefinder name="beside the floor" camera="aslant" data="{_ALL}"/>
    <rangefinder name="of parallel rays" camera="square" data="{_ALL}"/>
    <rangefinder name="bounded" site="s" cutoff=".5"/>
    <rangefinder name="bounded, without a hit" site="looking up" cutoff=".5"/>
    <rangefinder name="all bounded" camera="c" data="{_ALL}" cutoff=".6"/>
  </sensor>
</mujoco>"""
