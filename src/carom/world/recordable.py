"""Recording of a world as a page that replays it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, cast

if TYPE_CHECKING:
    from carom.viewer.replay.recorder import ReplayRecorder
    from carom.world.world import World


class Recordable:
    """Recording of a world, and its display in notebooks."""

    def _repr_html_(self) -> str:
        from carom.scene.html_tables import world_table

        return world_table(cast("World", self))

    def record(
        self,
        path: str | Path,
        *,
        fps: float = 60.0,
        title: str | None = None,
        contacts: bool = True,
        joints: bool = True,
    ) -> ReplayRecorder:
        """Record all steps into one HTML file that replays them, without a server or a network.

            with world.record("fall.html"):
                world.step(480)

        Args:
            path: The file; an existing one is replaced.
            fps: Frames for each second of simulated time.
            title: Title of the page; the name of the file by default.
            contacts: Record contacts and their forces.
            joints: Record positions, velocities and torques of joints.

        Returns:
            A context manager that writes the file when the context is left, as its `stop()` does.

        Raises:
            ValueError: The rate is not positive.
        """
        from carom.viewer.replay.recorder import ReplayRecorder

        return ReplayRecorder(
            cast("World", self), path, fps=fps, title=title, contacts=contacts, joints=joints
        )
