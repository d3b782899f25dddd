"""The parameters of a world that the user of the simulator can change."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from typing import TYPE_CHECKING, Any

from carom.engine.parameters import BULLET, CONVERGED
from carom.viewer.simulation.panel import ShownSetting

if TYPE_CHECKING:
    from carom.world.world import World


@dataclass(frozen=True, slots=True)
class _Setting:
    """A field of `EngineParameters`; numbers are at least `lower`."""

    name: str
    title: str
    unit: str = ""
    lower: float = -float("inf")
    choices: tuple[str, ...] = ()


_SETTINGS = (
    _Setting("gravity", "Gravity", "m/s²"),
    _Setting("time_step", "Time step", "s", lower=1e-7),
    _Setting("substeps", "Substeps", lower=0.0),
    _Setting("contact", "Law of contact", choices=(BULLET, *CONVERGED)),
    _Setting("solver_iterations", "Iterations", lower=1.0),
    _Setting("wind", "Wind", "m/s"),
    _Setting("fluid_density", "Density of the fluid", "kg/m³", lower=0.0),
    _Setting("fluid_viscosity", "Viscosity", "Pa s", lower=0.0),
    _Setting("contact_warm_starting", "Warm starting", lower=0.0),
    _Setting("split_impulse", "Split impulse"),
    _Setting("cone_friction", "Friction in a cone"),
    _Setting("isotropic_friction", "Isotropic friction"),
    _Setting("sat", "Separating axes"),
)
_BY_NAME = {it.name: it for it in _SETTINGS}


def shown_settings(world: World) -> list[ShownSetting]:
    """The parameters of a world as the page shows them."""
    return [ShownSetting(it.name, it.title, _value(world, it.name), it.unit, it.choices) for it in _SETTINGS]


def _value(world: World, name: str) -> Any:
    value = getattr(world.parameters, name)
    if isinstance(value, (bool, str)):
        return value
    return tuple(map(float, value)) if isinstance(value, tuple) else (float(value),)


def checked_setting(world: World, name: str, value: Any) -> Any:
    """The value of a parameter as `EngineParameters` has it, from a message of a page.

    Raises:
        ValueError: There is no such setting, or it cannot have this value.
    """
    setting = _BY_NAME.get(name)
    if setting is None:
        raise ValueError(f"there is no setting {name!r}; there are {', '.join(_BY_NAME)}")
    present = getattr(world.parameters, name)
    if isinstance(present, bool):
        if not isinstance(value, bool):
            raise ValueError(f"{setting.title} is on or off, not {value!r}")
        return value
    if setting.choices:
        if value not in setting.choices:
            raise ValueError(f"{setting.title} is one of {', '.join(setting.choices)}, not {value!r}")
        return value
    count = len(present) if isinstance(present, tuple) else 1
    numbers = [] if isinstance(value, (bool, str)) else [float(number) for number in value]
    if len(numbers) != count or not all(isfinite(it) and it >= setting.lower for it in numbers):
        least = "" if setting.lower < 0.0 else f" of at least {setting.lower:g}"
        raise ValueError(
            f"{setting.title} needs {count} finite number{'s' if count > 1 else ''}{least}, not {value!r}"
        )
    if isinstance(present, tuple):
        return tuple(numbers)
    return round(numbers[0]) if isinstance(present, int) else numbers[0]
