"""The logs of one client."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from pybullet._clients import Client
    from pybullet._log_files import StateLog, TimingLog


class Logs:
    """Logs by id.

    Attributes:
        by_id: Those that are being written.
        next_id: Id of the next one; ids are not used again.
        zones: Names of the zones of `submitProfileTiming` that have begun.
    """

    def __init__(self) -> None:
        self.by_id: dict[int, StateLog] = {}
        self.next_id = 0
        self.zones: list[str] = []

    def timings(self) -> list[TimingLog]:
        """The logs of timings."""
        if not self.by_id:
            return []
        from pybullet._log_files import TimingLog

        return [log for log in self.by_id.values() if isinstance(log, TimingLog)]

    def stop(self, client: Client, number: int) -> None:
        """Ends a log and finishes its file; nothing if there is none."""
        log = self.by_id.pop(number, None)
        if log is not None:
            client.world.observers.remove(log)
            log.close()

    def stop_all(self, client: Client) -> None:
        """Ends all logs."""
        for number in list(self.by_id):
            self.stop(client, number)
