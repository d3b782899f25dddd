"""The devices on which worlds are stored and stepped."""

from __future__ import annotations

from importlib import util
from typing import TYPE_CHECKING

from carom.engine.engine import Engine
from carom.engine.parameters import CONVERGED, DISCRETE
from carom.engine.presence import any_absent
from carom.native.cpu import core_count
from carom.world.world import World
from carom.worlds.memory import check_memory

if TYPE_CHECKING:
    from carom.gpu.device import Device

CPU = "cpu"
_CUDA = "cuda"
# For tests: the launches for a GPU, performed on the CPU.
_WARP_CPU = "warp-cpu"


def make_engine(scene: World, count: int, device: str | Device, threads: int | None) -> Engine:
    """An engine for `count` copies of a scene, on a device as for `Worlds`, or one of `carom.gpu`.

    Raises:
        ValueError: There is no such device, or it is a GPU and a body is absent.
        NotImplementedError: It is a GPU, and contacts are solved until they converge, or the integrator is
            not "discrete".
        ImportError: A GPU is requested, and Warp is not installed.
        MemoryError: There is not enough memory for so many worlds.
    """
    if device == CPU:
        state, contacts = scene.arrays.state, scene.contact_arrays.contacts
        check_memory(count, state.bytes_per_world(scene.arrays.used) + contacts.bytes_per_world())
        arrays = scene.arrays.repeated(count, scene.contact_arrays.user_count)
        return Engine(arrays, scene.contact_arrays.repeated(arrays), min(count, threads or core_count()))
    if scene.parameters.contact in CONVERGED:
        raise NotImplementedError(
            f"device {device!r} cannot solve contact={scene.parameters.contact!r} yet; use 'cpu', or "
            "contact='bullet'"
        )
    if scene.parameters.integrator != DISCRETE:
        raise NotImplementedError(
            f"device {device!r} cannot step with integrator={scene.parameters.integrator!r} yet; use 'cpu', "
            "or integrator='discrete'"
        )
    if threads is not None:
        raise ValueError("threads can be set for the device 'cpu' only")
    found = open_device(device) if isinstance(device, str) else device
    if any_absent(scene.arrays):
        raise ValueError(f"device {device!r} cannot simulate absent bodies yet; remove them, or use 'cpu'")
    from carom.gpu.engine import DeviceEngine

    return DeviceEngine.like(found, scene.arrays, scene.contact_arrays, count)


def open_device(name: str) -> Device:
    """A device by name: "cuda", "cuda:1".

    Raises:
        ValueError, ImportError: The machine has no such device, or Warp is not installed.
    """
    kind, _, number = name.partition(":")
    if name != _WARP_CPU and (kind != _CUDA or (":" in name and not number.isdigit())):
        raise ValueError(f"device must be 'cpu', 'cuda' or a GPU by number such as 'cuda:1', not {name!r}")
    if util.find_spec("warp") is None:
        raise ImportError(f"device {name!r} needs NVIDIA Warp: pip install 'carom[gpu]'")
    from carom.gpu.warp_device import WarpDevice, cuda_devices

    if name == _WARP_CPU:
        return WarpDevice("cpu")
    there = cuda_devices()
    if not there:
        raise ValueError(f"there is no device {name!r}: no NVIDIA GPU or no driver for it has been found")
    wanted = there[0] if name == _CUDA else name
    if wanted not in there:
        raise ValueError(f"there is no device {name!r}; there are {', '.join(there)}")
    return WarpDevice(wanted)
