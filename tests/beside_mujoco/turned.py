"""Welds that are off by large angles; `record_turned.py` asks MuJoCo how bodies move."""

STEP = 1e-7
STEPS = (50, 200, 500)
_HEAD = '<option integrator="Euler" timestep="{step}" tolerance="1e-12" iterations="300"/>'
_BODY = '<geom type="box" size=".1 .2 .3" contype="0" conaffinity="0"/>'
_BOX = f'<body name="b" pos="0 0 1"><freejoint/>{_BODY}</body>'
_LINKS = """<body name="{name}" pos="{pos}"><joint axis="0 1 0"/><joint axis="1 0 0"/><joint axis="0 0 1"/>
<geom type="capsule" size=".05" fromto="0 0 0 0 0 -.4" contype="0" conaffinity="0"/></body>"""
_ARMS = _LINKS.format(name="b", pos="0 0 1") + _LINKS.format(name="c", pos=".3 0 1")


def _file(bodies: str, weld: str, qvel: str, step: float, qpos: str = "") -> str:
    head = _HEAD.format(step=step)
    state = f'qvel="{qvel}"' + (f' qpos="{qpos}"' if qpos else "")
    return (
        f"<mujoco>{head}<worldbody>{bodies}</worldbody><equality><weld {weld}/></equality>"
        f"<keyframe><key {state}/></keyframe></mujoco>"
    )


_FREE = ".1 -.2 .3 1 -2 1.5"
_CHAIN = "1 -2 3 -1.5 .5 2"
_TURNED = "{} .8 -.1 1.1 {}"
_SOFT = 'solref=".1 .8" solimp=".3 .9 .5"'


def _files(step: float) -> dict[str, str]:
    box, arms = (
        lambda weld, moved=_FREE: _file(_BOX, f'body1="b" {weld}', moved, step),
        lambda weld, moved=_CHAIN: _file(
            _ARMS, f'body1="b" body2="c" {weld}', moved, step, ".4 .8 -.6 -.9 .3 1.2"
        ),
    )
    return {
        "a quarter": box(f'relpose=".1 0 -1 .7 .7 0 0" {_SOFT}'),
        "nearly half": box(f'relpose="0 0 -1 .1 .6 -.7 .3" {_SOFT}'),
        "beyond half": box(f'relpose="0 0 -1 -.2 .6 -.7 .3" {_SOFT}'),
        "small torquescale": box(f'relpose=".05 0 -1 .5 .6 -.7 .3" torquescale=".2" {_SOFT}'),
        "great torquescale": box(f'relpose=".02 0 -1 .5 .6 -.7 .3" torquescale="3" {_SOFT}'),
        "at rest": box(f'relpose=".1 0 -1 .5 .6 -.7 .3" {_SOFT}', "0 0 0 0 0 0"),
        "anchor": box(f'relpose=".1 0 -1 .5 .6 -.7 .3" anchor=".1 .2 -.1" {_SOFT}'),
        "arms": arms(_SOFT),
        "arms apart": arms(f'relpose=".1 0 0 .5 .6 -.7 .3" torquescale=".4" {_SOFT}'),
        "stiff arms": arms('relpose=".3 0 0 .5 .6 -.7 .3"'),
    }


TURNED, MOVED = _files(STEP), _files(0.002)
