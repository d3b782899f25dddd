"""Options of a file, such as its gravity and time step, and when they hold in the world that loads it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from carom.engine.parameters import (
    COMPLIANT,
    DISCRETE,
    EULER,
    EXPLICIT,
    MIDPOINT,
    RIGID,
    EngineParameters,
    usual_integrator,
)
from carom.logger import Logger

if TYPE_CHECKING:
    from carom.world.scene import Scene

_log = Logger(__name__)


def stated_parameters(scene: Scene) -> dict[str, Any]:
    """The parameters of a world that the file of a scene states, by their names in `EngineParameters`."""
    options, values = scene.options, dict[str, Any]()
    if "gravity" in options:
        values["gravity"] = options["gravity"] if options.get("flag.gravity", True) else (0.0, 0.0, 0.0)
    if scene.format == "MJCF":
        is_off = not any(options.get(f"flag.{name}", True) for name in ("spring", "damper"))
        for name in ("density", "viscosity"):
            values[f"fluid_{name}"] = 0.0 if is_off else options.get(name, 0.0)
        values["noslip_iterations"] = options.get("noslip_iterations", 0)
        if "integrator" in options:
            values["integrator"] = options["integrator"].lower()
        elif scene.world.parameters.contact == COMPLIANT:
            # MuJoCo's default, which gives way to that of another law.
            values["integrator"] = EULER
        if values.get("integrator") == EULER and not options.get("flag.eulerdamp", True):
            values["integrator"] = EXPLICIT
        values["wind"] = options.get("wind", (0.0, 0.0, 0.0))
    if "timestep" in options:
        values["time_step"] = options["timestep"]
    if "solver_residual_threshold" in options:
        values["solver_residual_threshold"] = options["solver_residual_threshold"]
    return values


def take_effect(scene: Scene, *, in_empty_world: bool) -> None:
    """Apply options as `World.load` does; one warning names those that differ from what the world has.

    Args:
        scene: What has just been loaded.
        in_empty_world: The world had no bodies before. What had been set there stays.
    """
    present = scene.world.parameters
    usual = EngineParameters(integrator=usual_integrator(present.contact))
    taken, left = dict[str, Any](), dict[str, Any]()
    for name, value in stated_parameters(scene).items():
        here = getattr(present, name)
        if here != value:
            is_set = name in scene.world.parameters_set or here != getattr(usual, name)
            # Contacts that are rigid have no other.
            is_set = is_set or (name == "integrator" and present.contact == RIGID)
            (taken if in_empty_world and not is_set else left)[name] = value
    if left:
        named = ", ".join(
            f"{name} {value!r} (here {getattr(present, name)!r})" for name, value in left.items()
        )
        _log.warning(
            "%s states options that are not those of the world: %s; scene.apply_options() sets them",
            scene.source,
            named,
        )
    set_parameters(scene, taken)
    if "integrator" in taken and "integrator" not in scene.options:
        scene.world.parameters_set -= {"integrator"}


def set_parameters(scene: Scene, values: dict[str, Any]) -> None:
    """Set parameters that a file states.

    An integrator that is not built for what is in the world stays as it is there, or is "discrete" if nobody
    has set it, with one warning.
    """
    others = {name: value for name, value in values.items() if name != "integrator"}
    present = scene.world.parameters.integrator
    if present == MIDPOINT and "integrator" not in scene.world.parameters_set:
        present = DISCRETE
    if "integrator" not in values:
        scene.world.change_parameters(**others)
        return
    try:
        scene.world.change_parameters(**values)
    except NotImplementedError as error:
        scene.world.change_parameters(**others, integrator=present)
        _log.warning("%s moves with integrator=%r: %s", scene.source, present, error)
