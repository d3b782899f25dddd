"""The engine for worlds on a device."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from carom.engine.contact_arrays import ContactArrays
from carom.engine.engine import Engine
from carom.engine.interpreter import Stepper
from carom.engine.workspace import Workspace
from carom.gpu.device import Device
from carom.gpu.memory import check_room
from carom.gpu.programs import parallel_detection_program, parallel_step_program
from carom.gpu.stepper import StepStepper, TaskStepper
from carom.gpu.tables import DeviceTable, MirroredTable
from carom.gpu.workspace import DeviceStructs, DeviceWorkspace
from carom.layouts.contacts import Contacts
from carom.layouts.model import State
from carom.layouts.status import STEPS_DONE
from carom.model.builder import WorldArrays


class DeviceEngine(Engine):
    """Steps many worlds on a device, with all tables of their arrays there.

    State, contacts and intermediate results are on the device only; model, shapes, user constraints and the
    model of soft bodies are on the host, with a copy on the device. The programs of a step and of collision
    detection differ from those for CPUs. Steps are requested, and repeated if arrays were too small, as on
    CPUs.
    """

    step_program = staticmethod(parallel_step_program)
    detection_program = staticmethod(parallel_detection_program)

    allows_absence = False
    # Workspaces also depend on whether shapes can touch.
    keeps_structs = False
    keeps_times = False
    moves_together = False

    def __init__(self, device: Device, arrays: WorldArrays, contact_arrays: ContactArrays) -> None:
        self.device = device
        super().__init__(arrays, contact_arrays)

    @classmethod
    def like(
        cls, device: Device, arrays: WorldArrays, contact_arrays: ContactArrays, count: int
    ) -> DeviceEngine:
        """An engine of copies of a world; raises `MemoryError` if the device has not enough free memory."""
        check_room(device, count, lambda counter: cls.made(counter, arrays, contact_arrays, count).structs())
        return cls.made(device, arrays, contact_arrays, count)

    @classmethod
    def made(
        cls, device: Device, arrays: WorldArrays, contact_arrays: ContactArrays, count: int
    ) -> DeviceEngine:
        """As `like`, but without checking the free memory and for soft bodies."""
        own_arrays = arrays.repeated(1, contact_arrays.user_count)
        own_contact_arrays = contact_arrays.repeated(own_arrays)
        rows = {**own_arrays.used, "user": own_contact_arrays.user_count, "status": STEPS_DONE + 1}
        own_arrays.world_count = count
        own_arrays.model = MirroredTable(device, own_arrays.model)
        own_arrays.state = DeviceTable.repeated(device, own_arrays.state, State, count, rows)
        own_contact_arrays.shapes.table = MirroredTable(device, own_contact_arrays.shapes.table)
        own_contact_arrays.users = MirroredTable(device, own_contact_arrays.users)
        own_contact_arrays.soft.table = MirroredTable(device, own_contact_arrays.soft.table)
        own_contact_arrays.contacts = DeviceTable.repeated(
            device, own_contact_arrays.contacts, Contacts, count, own_contact_arrays.contacts.capacity
        )
        return cls(device, own_arrays, own_contact_arrays)

    def take(self, value: Any) -> Any:  # noqa: D102
        return value if isinstance(value, slice) else self.device.take(value)

    def table(self, struct: Any) -> DeviceTable:  # noqa: D102
        return DeviceTable(self.device, struct)

    def update_settings(self, parameters: Any) -> None:  # noqa: D102
        super().update_settings(parameters)
        # Launches hold copies of the settings.
        self.changed()

    def _make_status(self) -> np.ndarray:
        return np.zeros((self.arrays.world_count, STEPS_DONE + 1), dtype=np.int32)

    def _make_workspaces(self, threads: int) -> list[Workspace]:
        return [DeviceWorkspace(self.device, self.arrays.world_count)]

    def _make_interpreters(self, due: np.ndarray) -> list[Stepper]:
        return [StepStepper(self._device_structs, self._state, self.status, self._runner.worlds, due)]

    def _make_task_interpreters(self) -> list[Stepper]:
        return [TaskStepper(self._runner.worlds)]

    @property
    def _device_structs(self) -> DeviceStructs:
        structs = self.workspace.structs
        assert isinstance(structs, DeviceStructs)
        return structs

    @property
    def _state(self) -> Mapping[str, Any]:
        return self.arrays.state.numpy
