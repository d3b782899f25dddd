"""What quick calls know of a world: kernels that bring its poses up to date, and its contacts."""

from __future__ import annotations

from ctypes import addressof
from typing import TYPE_CHECKING, Any

from carom.native.quick_calls import Launch, Scene

if TYPE_CHECKING:
    from carom.engine.contact_arrays import ContactArrays
    from carom.native.launch import TreeLaunch


class QuickScene:
    """Addresses that hold until bodies, constraints or arrays of the world change.

    Attributes:
        record: The addresses; functions that are not known are null.
    """

    __slots__ = ("_kept", "record")

    def __init__(self) -> None:
        self.record = Scene()
        # What the addresses point to.
        self._kept: list[Any] = []

    def forget(self) -> None:
        """Forget all addresses: the world has changed."""
        self.record.find_poses.function = None
        self.record.find_twists.function = None
        self._kept.clear()

    def know_poses(self, launch: TreeLaunch, contact_arrays: ContactArrays) -> None:
        """Take what brings the link poses of a body up to date, and where contacts are."""
        contacts = contact_arrays.contacts.struct()
        self._kept += (launch, contacts)
        self.record.contact_count = contacts.count_contacts.data
        self.record.contact_impulses = contacts.contact_impulse.data
        self.record.contact_room = contact_arrays.contacts.capacity["contact"]
        _know(self.record.find_poses, launch)

    def know_twists(self, launch: TreeLaunch) -> None:
        """Take what brings the link velocities of a body up to date."""
        self._kept.append(launch)
        _know(self.record.find_twists, launch)

    @property
    def address(self) -> int:
        """Address of the record, which is there as long as this is."""
        return addressof(self.record)


def _know(record: Launch, launch: TreeLaunch) -> None:
    # The function last: without it nothing else is looked at.
    function, record.bounds, record.arguments, record.tree = launch.addresses()
    record.function = function
