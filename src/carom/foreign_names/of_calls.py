"""Functions, classes and arguments of other simulators, and what is written for calls that are none here."""

from __future__ import annotations

_FILE = "world = carom.World(); scene = world.load(file)"
_PYBULLET = "`import pybullet as p` runs scripts written for PyBullet; a carom.World has other names"

ARGUMENTS: dict[str, tuple[str, ...]] = {
    "pos": ("position", "positions"),
    "xyz": ("position",),
    "basePosition": ("position",),
    "quat": ("orientation", "orientations"),
    "rot": ("orientation",),
    "baseOrientation": ("orientation",),
    "size": ("half_extents", "radius"),
    "extents": ("half_extents",),
    "halfExtents": ("half_extents",),
    "height": ("length",),
    "rgba": ("colour",),
    "color": ("colour",),
    "density": ("mass",),
    "fixed": ("fixed_base",),
    "fix_base": ("fixed_base",),
    "useFixedBase": ("fixed_base",),
    "globalScaling": ("scale",),
    "flags": ("self_collision",),
    "dt": ("time_step",),
    "sim_options": ("time_step",),
    "link": ("links",),
    "kv": ("kd",),
    "damping": ("kd",),
    "stiffness": ("kp",),
    "force": ("max_force", "max_forces"),
    "forces": ("max_forces",),
    "target": ("targets",),
    "targetPosition": ("target", "targets"),
    "targetPositions": ("targets",),
    "positionGain": ("gain",),
    "velocityGain": ("velocity_gain",),
    "maxForce": ("max_force",),
    "limits": ("lower",),
    "lowerLimits": ("lower",),
    "upperLimits": ("upper",),
    "jointRanges": ("ranges",),
    "restPoses": ("rest",),
    "num_envs": ("count",),
    "n_envs": ("count",),
    "num_worlds": ("count",),
    "nstep": ("count",),
    "n": ("count",),
    "env_ids": ("where",),
    "envs_idx": ("where",),
    "indices": ("where",),
    "mask": ("where",),
    "fov": ("fields_of_view", "degrees"),
    "fovy": ("fields_of_view", "degrees"),
    "positions": ("poses",),
    "filename": ("path",),
    "file": ("path",),
}
"""What an argument may be called here: the first of these that the function has."""

_CAMERA = "Here: carom.Camera.with_field_of_view(width, height, degrees).look_at(eye, target)."

CALLS: dict[str, str] = {
    "Camera.__init__": _CAMERA,
    "Scene.__init__": "Here: world = carom.World(), whose load(file) returns a scene.",
    "Body.__init__": "Here: world.load_urdf(file), world.add_box and so on, which return bodies.",
    "Worlds.__init__": "Here: carom.Worlds(world, count), copies of a World with all that is in it.",
    "Stepping.step": "Here: world.step(count); world.time_step is how long each is.",
}
"""What is written where the arguments of a call are quite other ones, by the function that says so."""

INDEXED: dict[str, str] = {
    "Bodies": "Square brackets take one: world.bodies['name'], or world['name'].",
    **dict.fromkeys(
        ("Joints", "JointGroup", "JointGroupBatch"), "Square brackets take one or more: body.joints['elbow']."
    ),
    **dict.fromkeys(
        ("Links", "LinkGroup", "LinkBatches", "LinkGroupBatch"),
        "Square brackets take one: body.links['hand'].",
    ),
    **dict.fromkeys(("BodyShapes", "ShapeBatches"), "Square brackets take one: body.shapes['foot']."),
    **dict.fromkeys(("BodySites", "SiteBatches"), "Square brackets take one: body.sites['tip']."),
    **dict.fromkeys(("BodySensors", "SensorBatches"), "Square brackets take one: body.sensors['imu']."),
    **dict.fromkeys(
        ("BodyActuators", "ActuatorBatches"), "Square brackets take one: body.actuators['elbow']."
    ),
}
"""What is written instead of a call of a collection, by its class."""

MODULES: dict[str, dict[str, str]] = {
    "carom": {
        "MjModel": _FILE,
        "MjData": f"{_FILE}; a world is model and state at once",
        "MjSpec": "carom.read(file), a description that can be changed",
        "mj_step": "world.step(count)",
        "mj_forward": "not needed: what is asked for is computed for the present state",
        "mj_resetData": "world.reset()",
        "mj_resetDataKeyframe": "world.reset('name of a keyframe')",
        "mj_name2id": "names are taken everywhere: world['name'], body.joints['name']",
        "Renderer": "carom.Camera.with_field_of_view(width, height, degrees), and world.image(camera)",
        "rollout": "carom.Worlds(world, count)",
        "mjx": "carom.Worlds(world, count), with device='cuda' on a GPU",
        "load": _FILE,
        "load_mjcf": _FILE,
        "load_urdf": "world = carom.World(); body = world.load_urdf(file)",
        "init": "not needed: begin with world = carom.World()",
        "gs": "not needed: begin with world = carom.World()",
        "morphs": "world.load(file), or world.add_box, add_sphere, add_plane and so on",
        "materials": "friction= and mass= of world.add_box and so on, or body.change_dynamics",
        "options": "arguments of carom.World: time_step, gravity, contact, integrator, solver",
        "connect": "not needed: begin with world = carom.World(). " + _PYBULLET,
        "loadURDF": "world = carom.World(); body = world.load_urdf(file). " + _PYBULLET,
        "stepSimulation": "world.step(). " + _PYBULLET,
        "setGravity": "world.gravity = (0, 0, -9.81). " + _PYBULLET,
        "DIRECT": "not needed: begin with world = carom.World(). " + _PYBULLET,
        "GUI": "world.view(). " + _PYBULLET,
        "LQR": "carom.controllers.LQR",
        "ILQR": "carom.controllers.ILQR",
        "PID": "carom.control.PID",
        "WorldsEnv": "carom.vector.WorldsEnv",
        "SceneEnv": "carom.vector.SceneEnv",
        "VectorEnv": "carom.vector.WorldsEnv",
        "make": "gymnasium.make_vec(name), after `import pybullet_envs`, or carom.vector.WorldsEnv",
        "gym": "carom.vector",
        "envs": "carom.vector",
        "Viewer": "world.view(), or carom.viewer.Viewer(world)",
        "Simulator": "carom.World",
        "Sim": "carom.World",
        "Robot": "world.load_urdf(file), which returns a body",
    },
    "carom.viewer": dict.fromkeys(
        ("launch", "launch_passive"), "world.view(), or carom.viewer.Viewer(world)"
    ),
}
