"""Actuators called `pid`, with their inputs; `record_controlled.py` asks MuJoCo how they move bodies."""

_ARM = """<body pos="0 0 1"><joint name="j" axis="0 1 0" range="-60 60" armature=".1" damping=".2"/>
<geom size=".1" pos=".2 0 0" density="300"/><body pos=".3 0 0"><joint name="k" type="slide" axis="1 0 0"
 range="-.4 .5" damping="20"/><geom type="box" size=".05 .05 .1" density="400"/></body></body>"""
_HEAD = '<option timestep=".0005" integrator="{}"><flag contact="disable" limit="disable"/></option>'


def _file(actuators: str, before: str = "", integrator: str = "Euler") -> str:
    return (
        f"<mujoco>{_HEAD.format(integrator)}{before}<worldbody>{_ARM}</worldbody>"
        f"<tendon><fixed name='t'><joint joint='j' coef='.5'/><joint joint='k' coef='2'/></fixed></tendon>"
        f"<actuator>{actuators}</actuator></mujoco>"
    )


_CLASSES = '<default><default class="c"><pid kp="7" kv="2" input="pos"/></default></default>'
CONTROLLED = {
    "two inputs": _file('<pid name="p" joint="j" kp="40" kv="3"/><pid joint="k" kp="90" kv="5"/>'),
    "position alone": _file('<pid joint="j" kp="40" kv="3" input="pos"/>'),
    "velocity alone": _file('<pid joint="j" kp="4" kv="3" input="vel" velrange="-.5 .5"/>'),
    "force alone": _file('<pid joint="k" kp="4" kv="3" input="ff" ctrlrange="-.1 .1"/>'),
    "all inputs": _file(
        '<pid joint="j" kp="40" kv="3" input="pos vel ff" posrange="-.2 .3" ffrange="-1 1" gear="-2"/>'
    ),
    "bound of the sum": _file('<pid joint="j" kp="40" kv="3" forcerange="-2 3" gear="2"/>'),
    "inherited range": _file('<pid joint="j" kp="9" kv="1" inheritrange=".3"/><pid joint="k" dampratio="1"'
                             ' kp="30" input="pos"/>'),
    "class": _file('<pid joint="j" class="c" kv="1"/><pid joint="k" kp="50" kv="2"/>', _CLASSES),
    "tendon": _file('<pid tendon="t" kp="30" kv="4" input="pos ff"/>', "", "implicitfast"),
}  # fmt: skip
"""By what they have; those that MuJoCo and Carom have all of."""
