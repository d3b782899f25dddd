"""What is lost with each element and attribute of MJCF files that is left out.

Attributes are in three tables: those that are read, which have no meaning where they are not looked up; those
that nothing simulates; and those without which nothing is lost.
"""

from __future__ import annotations

from collections.abc import Iterator

from carom.formats.reading.rules import Rule, Rules

_YET = "not read yet"
_NO_LOSS = "none for the dynamics"
_SKETCH = "it is for the window of MuJoCo"
_SOFT = "contacts yield as the geoms of both bodies say"
_LAW = "the force of the actuator is another one"
_TOUCH = (
    "conaffinity condim contype friction gap internal margin passive priority selfcollide solimp solmix "
    "solref"
)
_SOLVER = "it is for the solvers of MuJoCo"
_TURN = "axisangle euler quat xyaxes zaxis"

_BOUNDS = "actlimited actrange ctrllimited ctrlrange forcelimited forcerange"
_ACTUATOR = (
    f"{_BOUNDS} actearly class cranklength cranksite gear group joint jointinparent name refsite site "
    "slidersite tendon"
)
_ACTUATORS = {
    "general": "body biasprm biastype dynprm dyntype gainprm gaintype lengthrange",
    "motor": "",
    "position": "dampratio inheritrange kp kv timeconst",
    "velocity": "kv",
    "intvelocity": "dampratio inheritrange kp kv",
    "damper": "kv",
    "cylinder": "area bias diameter timeconst",
    "dcmotor": "cogging controller inductance input lugre motorconst nominal resistance saturation thermal",
    "pid": "dampratio ffrange imax inheritrange input ki kp kv posrange slewmax velrange",
    "adhesion": "body gain",
    "muscle": "force fpmax fvmax lengthrange lmax lmin range scale tausmooth timeconst vmax",
}

_OF_BODIES = ("general", "adhesion")

_EQUALITY = "active body1 body2 class name site1 site2 solimp solref"

_SENSOR = "cutoff delay interp interval name nsample"
_FRAME = f"{_SENSOR} objname objtype"
_RELATIVE = f"{_FRAME} refname reftype"
_SENSORS = {
    **dict.fromkeys(
        ("touch", "accelerometer", "velocimeter", "gyro", "force", "torque", "magnetometer"),
        f"{_SENSOR} site",
    ),
    "rangefinder": f"{_SENSOR} camera data site",
    **{
        f"joint{what}": f"{_SENSOR} joint"
        for what in ("pos", "vel", "actuatorfrc", "limitpos", "limitvel", "limitfrc")
    },
    **dict.fromkeys(("ballquat", "ballangvel"), f"{_SENSOR} joint"),
    **{f"actuator{what}": f"{_SENSOR} actuator" for what in ("pos", "vel", "frc")},
    **{f"frame{what}": _RELATIVE for what in ("pos", "quat", "xaxis", "yaxis", "zaxis", "linvel", "angvel")},
    **{f"frame{what}": _FRAME for what in ("linacc", "angacc")},
    **{f"subtree{what}": f"{_SENSOR} body" for what in ("com", "linvel", "angmom")},
    **{f"tendon{what}": f"{_SENSOR} tendon" for what in ("pos", "vel", "actuatorfrc")},
    "contact": f"{_SENSOR} body1 body2 data geom1 geom2 num reduce site subtree1 subtree2",
    **dict.fromkeys(("distance", "normal", "fromto"), f"{_SENSOR} body1 body2 geom1 geom2"),
    "clock": _SENSOR,
}

_TENDON = (
    "armature class damping frictionloss limited margin name range solimplimit solreflimit springlength "
    "stiffness actuatorfrclimited actuatorfrcrange"
)
_TENDONS = ("fixed", "spatial", "tendon")

_UNBUILT = ("orientation",)

_READ = {
    "mujoco": "model",
    "compiler": "alignfree angle assetdir autolimits balanceinertia boundinertia boundmass coordinate "
    "eulerseq fitaabb inertiafromgeom inertiagrouprange meshdir settotalmass strippath texturedir",
    "option": "actuatorgroupdisable density gravity impratio integrator cone jacobian magnetic o_friction "
    "noslip_iterations o_margin o_solimp o_solref solver timestep viscosity wind",
    "mesh": "builtin class face file inertia name params refpos refquat scale vertex",
    "hfield": "elevation file name ncol nrow size",
    "texture": "builtin class file fileback filedown filefront fileleft fileright fileup gridlayout gridsize "
    "height mark markrgb name random rgb1 rgb2 type width",
    "material": "class name reflectance rgba specular texrepeat texture texuniform",
    "layer": "role texture",
    "headlight": "active ambient diffuse specular",
    "light": "active ambient attenuation castshadow class cutoff diffuse dir directional exponent mode name "
    "pos specular target type",
    "model": "file name",
    "body": f"childclass gravcomp mocap name pos {_TURN}",
    "inertial": f"diaginertia fullinertia mass pos {_TURN}",
    "joint": "align armature axis class damping frictionloss limited margin name pos range ref "
    "solimpfriction solimplimit solreffriction solreflimit springdamper springref stiffness type "
    "actuatorfrclimited actuatorfrcrange",
    "freejoint": "align name",
    "geom": "class conaffinity condim contype density fitscale fluidcoef fluidshape friction fromto group "
    "hfield mass material margin mesh name pos priority rgba shellinertia size solimp solmix solref "
    f"surfacevel type {_TURN}",
    "site": f"class fromto group material name pos rgba size type {_TURN}",
    "camera": f"class focal focalpixel fovy mode name pos principal principalpixel projection "
    f"resolution sensorsize target {_TURN}",
    "attach": "body frame model prefix",
    "frame": f"childclass name pos {_TURN}",
    "replicate": "childclass count euler offset sep",
    "include": "file",
    "exclude": "body1 body2 name",
    **{tag: f"{_ACTUATOR} {own}".strip() for tag, own in _ACTUATORS.items()},
    "connect": f"anchor {_EQUALITY}",
    "weld": f"anchor relpose torquescale {_EQUALITY}",
    "equality": "active class solimp solref",
    **dict.fromkeys(_TENDONS, f"{_TENDON} group material rgba width"),
    "pair": "class condim friction gap geom1 geom2 margin name solimp solref solreffriction",
    "key": "act ctrl name qpos qvel time",
    "default": "class",
    "actuator/plugin": f"{_ACTUATOR} actdim dynprm dyntype instance plugin",
    "config": "key value",
    "flexcomp": "count dim dof element file mass material mesh name origin point pos radius rgba rigid "
    f"scale spacing type {_TURN}",
    "edge": "damping equality solimp solref stiffness",
    "elasticity": "damping elastic2d poisson thickness young",
    "pin": "grid gridrange id range",
    "flexcomp/contact": _TOUCH,
    "flex": "body dim dof element material name node radius rgba vertex",
    "flex/contact": _TOUCH,
    "skin": "face file group inflate material name rgba texcoord vertex",
    "bone": "bindpos bindquat body vertid vertweight",
    "equality/flex": "active class flex name solimp solref",
}

_NOT_SIMULATED: tuple[tuple[str, str, str, str], ...] = (
    ("compiler", "conflict", "settings of attached models do not reach this one", _YET),
    ("option", "sleep_tolerance", "bodies do not fall asleep", _YET),
    ("body", "sleep", "it does not fall asleep", _YET),
    ("joint", "actuatorgravcomp", "what balances gravity is not among the forces of actuators", _YET),
    ("joint", "springyield", "the joint has another spring", _YET),
    ("geom", "adhesion", "the surface does not stick", _YET),
    ("key", "plastic", "flexes are not deformed", _YET),
    ("key", "mpos mquat", "bodies that only users move stay where they are", _YET),
    *[
        (tag, "actdim armature damping delay ffrange input interp nsample velrange", _LAW, _YET)
        for tag in _ACTUATORS
        if tag != "pid"
    ],
    ("pid", "armature damping delay interp nsample", _LAW, _YET),
    ("general", "inheritrange", _LAW, _YET),
    ("actuator/plugin", "armature damping delay interp nsample", _LAW, _YET),
    *[(tag, "solimpfriction solreffriction", "its friction does not yield", _YET) for tag in _TENDONS],
    *[(tag, "springyield", "its spring does not yield", _YET) for tag in _TENDONS],
    ("pair", "adhesion", "its geoms do not stick to each other", _YET),
    (
        "elasticity",
        "section sectionsize shear yield",
        "it does not resist as a rod does",
        "rods are not built",
    ),
    ("site", "mesh", "touch sensors would feel another volume", _YET),
)

_WITHOUT_LOSS = {
    "compiler": "discardvisual fusestatic passthrough savecanonical savecompiled saveinertial usethread",
    "option": "ccd_iterations ccd_tolerance iterations ls_iterations ls_tolerance noslip_tolerance "
    "sdf_initpoints sdf_iterations tolerance",
    "mesh": "content_type material maxhullvert normal smoothnormal texcoord",
    "hfield": "content_type",
    "model": "content_type",
    "texture": "colorspace content_type embed hflip nchannel vflip",
    "material": "emission metallic roughness shininess",
    "body": "fuse simple user",
    "joint": "group user",
    "freejoint": "group",
    "geom": "castshadow gap user",
    **{
        tag: f"{'lengthrange ' * (tag not in ('general', 'muscle'))}user {'body' * (tag not in _OF_BODIES)}"
        for tag in _ACTUATORS
    },
    "site": "user",
    "camera": "ipd output user",
    **dict.fromkeys(_TENDONS, "user"),
    "actuator/plugin": "lengthrange user body",
    "flexcomp": "cellcount flatskin group inertiabox texcoord",
    "flexcomp/contact": "activelayers",
    "flex": "cellcount elemtexcoord flatskin group nodecoord texcoord",
    "flex/contact": "activelayers",
    "light": "bulbradius intensity range softness texture",
}

_ELEMENTS = (
    Rule("actuator/*", "it does not act", _YET),
    *[Rule(f"actuator/{tag}@*", "none: the whole actuator is lost", _YET) for tag in _UNBUILT],
    *[Rule(f"default/{tag}@*", "none: the whole actuator is lost", _YET) for tag in _UNBUILT],
    *[
        Rule(f"equality/joint@{name}", "none: it has no meaning here", "another attribute counts")
        for name in ("active", "class", "joint1", "joint2", "name", "polycoef", "solimp", "solref")
    ],
    *[
        Rule(f"equality/tendon@{name}", "none: it has no meaning here", "another attribute counts")
        for name in ("active", "class", "tendon1", "tendon2", "name", "polycoef", "solimp", "solref")
    ],
    *[
        Rule(place, "none: it has no meaning here", "another attribute counts")
        for place in (
            "fixed/joint@coef",
            "fixed/joint@joint",
            "spatial/geom@geom",
            "spatial/geom@sidesite",
            "spatial/pulley@divisor",
            "spatial/site@site",
        )
    ],
    Rule("sensor/*", "there is no such sensor", _YET),
    Rule("tendon/*", "it does not pull", _YET),
    Rule("equality/*", "this constraint does not hold", _YET),
    Rule("deformable/*", "it is missing", "MuJoCo has no other deformable things either"),
    Rule("equality/flexstrain", "this constraint does not hold", "constraints of strains are not built"),
    Rule("mujoco/extension", "plugins do not run", "plugins are programs of MuJoCo"),
    Rule("mujoco/custom", "none", "it holds data for programs"),
    Rule("mujoco/size", "none: memory grows as needed", "it has no other meaning"),
    Rule("mujoco/visual", _NO_LOSS, _SKETCH),
    Rule("mujoco/statistic", _NO_LOSS, _SKETCH),
    Rule("mujoco/statistic@*", _NO_LOSS, _SKETCH),
    # Of models that are attached.
    Rule("mujoco/option", "none: the file around it has its own", "as in MuJoCo"),
    Rule("mujoco/worldbody", "none: another body of the file is attached", "as in MuJoCo"),
    Rule("worldbody/frame", "none: another body of the file is attached", "as in MuJoCo"),
    Rule("worldbody/body", "none: another body of the file is attached", "as in MuJoCo"),
    Rule("replicate@prefix", "none: names do not have it", "as in MuJoCo"),
    Rule("compiler/lengthrange", "ranges of lengths of muscles are found without its settings", _YET),
    Rule("light", _NO_LOSS, "lights of images are not drawn"),
    Rule("composite", "it is missing", "MuJoCo 4.0 has no composites either"),
    Rule("plugin", "it does not run", "plugins are programs of MuJoCo"),
    Rule("asset/texture", _NO_LOSS, "no geom uses it"),
    Rule("asset/material", _NO_LOSS, "no geom uses it"),
    Rule("asset/hfield", "none: no geom uses it", "it is not needed"),
    Rule("asset/mesh", "none: no geom uses it", "it is not needed"),
    Rule("material/layer", _NO_LOSS, "a shape has one texture"),
    Rule("default/*", "none: no element that is read has these defaults", "it is not needed"),
    # Where nested deeper, `default/...` is the same.
    Rule("default/default", "none: no element uses it", "it is not needed"),
)


def _rules() -> Iterator[Rule]:
    yield from _ELEMENTS
    for element, names in _READ.items():
        for name in names.split():
            yield Rule(f"{element}@{name}", "none: it has no meaning here", "another attribute counts")
            yield Rule(f"default/{element}@{name}", "none: no element uses it", "it is not needed")
    for tag, names in _SENSORS.items():
        for name in names.split():
            yield Rule(f"sensor/{tag}@{name}", "none: it has no meaning here", "another attribute counts")
        yield Rule(f"sensor/{tag}@noise", "none: readings of MuJoCo have no noise either", "as in MuJoCo")
        yield Rule(f"sensor/{tag}@user", _NO_LOSS, "it has no other use")
    for element, names, consequence, reason in _NOT_SIMULATED:
        for name in names.split():
            yield Rule(f"{element}@{name}", consequence, reason, even_if_taken=True)
            yield Rule(f"default/{element}@{name}", consequence, reason, even_if_taken=True)
    for element, names in _WITHOUT_LOSS.items():
        for name in names.split():
            yield Rule(
                f"{element}@{name}", _NO_LOSS, _SOLVER if element == "option" else "it has no other use"
            )
            yield Rule(f"default/{element}@{name}", _NO_LOSS, "it has no other use")


MJCF_RULES: Rules = Rules("MJCF", _rules())


def attributes_known(tag: str, section: str = "") -> set[str]:
    """The attributes of an element that any rule names; none if none does.

    In the section `equality` joints and tendons are couplings.
    """
    if section == "equality" and tag in ("joint", "tendon"):
        return {*["active", "class", "name", "polycoef", "solimp", "solref"], f"{tag}1", f"{tag}2"}
    stated = [_READ.get(tag, ""), _SENSORS.get(tag, ""), _WITHOUT_LOSS.get(tag, "")]
    stated += [names for element, names, *_ in _NOT_SIMULATED if element == tag]
    if tag in _SENSORS:
        stated.append("noise user")
    found = set(" ".join(stated).split())
    return found | {"name"} if found else found
