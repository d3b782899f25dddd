"""Performing steps: which kernels run, in which order, and what happens when something does not fit."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import Any

from carom.collision.collide import collide_kernel
from carom.collision.hierarchy import PAIRS
from carom.collision.manifold import WANTED
from carom.model.launch import KernelStructs, Launch, argument_indices, launch
from carom.physics.coupled_step import coupled_step_kernel
from carom.physics.kinematics import link_poses_kernel
from carom.physics.quarantine import OVERFLOW
from carom.physics.slumber import settle_kernel, watch_kernel
from carom.physics.step import step_kernel
from carom.touch_arrays import TouchArrays

# Arguments of a step's kernel.
SUBSTEPS, BEGINS, ENDS = "substeps", "begins", "ends"


class Detection:
    """Collision detection of a world, over arrays that grow until everything fits."""

    def __init__(self, structs: KernelStructs, touch: TouchArrays, device: str) -> None:
        self._touch = touch
        self._poses = launch(link_poses_kernel, structs, device).function
        self._collide = launch(collide_kernel, structs, device).function
        self._pair_room = touch.pairs.capacity["pair"]
        self._contact_room = touch.contacts.capacity["contact"]
        self._pair_counts = memoryview(touch.pairs.numpy["count_pairs"][0])
        self._contact_counts = memoryview(touch.contacts.numpy["count_contacts"][0])

    def run(self) -> bool:
        """Bring all link poses up to date and find all contacts.

        Returns:
            False if pairs or contacts did not fit; then the arrays have been replaced by longer ones.
        """
        self._detect()
        fits = (
            self._pair_counts[PAIRS] <= self._pair_room and self._contact_counts[WANTED] <= self._contact_room
        )
        if not fits:
            self._touch.grow_detection()
        return fits

    def _detect(self) -> None:
        self._poses()
        self._collide()


class Slumber:
    """Who is asleep: looked at before and after each substep, in a world where bodies can be."""

    def __init__(self, structs: KernelStructs, device: str, *, touching: bool) -> None:
        self.settle: Launch = launch(settle_kernel, structs, device, touching=int(touching))
        self.watch: Launch = launch(watch_kernel, structs, device)


class Stepper:
    """One step of a world as it is now: its bodies, parameters and arrays.

    Without anything that can touch, a step is one launch whatever the number of substeps, and a
    simpler one if nothing is tied together either. Otherwise each substep is collision detection and
    a launch, between those of `Slumber` if need be.

    Args:
        structs: Warp structs by the name kernels give them.
        touch: The arrays of what bodies do to each other.
        fault: `State.fault_tree` of the world.
        substeps: Greatest number of substeps.
        device: Warp device name.
        touching: Some shapes could touch.
        sleeping: Some body could fall asleep, or is asleep.
        watched: Somebody wants to know of every substep.
    """

    def __init__(
        self,
        structs: KernelStructs,
        touch: TouchArrays,
        fault: memoryview,
        substeps: int,
        device: str,
        *,
        touching: bool,
        sleeping: bool,
        watched: bool,
    ) -> None:
        self._coupled = touching or sleeping or watched or touch.user_count > 0
        kernel = coupled_step_kernel if self._coupled else step_kernel
        self._launch: Any = launch(kernel, structs, device, **{SUBSTEPS: 1, BEGINS: 1, ENDS: 1})
        self._index: Mapping[str, Any] = argument_indices(kernel)
        self._touch = touch
        self._fault = fault
        self.detection: Detection | None = Detection(structs, touch, device) if touching else None
        self.slumber: Slumber | None = Slumber(structs, device, touching=touching) if sleeping else None
        if not touching:
            touch.forget_contacts()
        self._substeps = substeps
        # A step of one substep; nothing changes the launch where there are never more.
        self._once = self._launch.function if substeps <= 1 and not sleeping else None

    @property
    def single(self) -> Callable[[], None] | None:
        """A step of one substep as one launch, where nothing can fail to fit."""
        return None if self._coupled or self._substeps > 1 else self._launch.function

    def step(self, substeps: int, done: int = 0, between: Callable[[], None] | None = None) -> int:
        """Perform a step of `substeps` substeps, or the rest of one.

        Args:
            substeps: How many there are.
            done: How many have been performed already.
            between: Called after each substep but the last.

        Returns:
            How many have now been performed: all, at least 1, or fewer if rows or contacts did not
            fit. Then the arrays have been replaced by longer ones, and another stepper can go on.
        """
        if substeps == 1 and done == 0 and between is None and self._once is not None:
            return int(self._step_once(self._once))
        rounds = max(1, substeps)
        if self.detection is None and self.slumber is None and between is None:
            self._launch.replace(self._index[SUBSTEPS], substeps)
            self._launch()
            return rounds if self._fits() else 0
        for substep in range(done, rounds):
            if self.detection is not None and not self.detection.run():
                return substep
            if self.slumber is not None:
                self.slumber.settle()
            self._launch.replace(self._index[SUBSTEPS], min(1, substeps))
            self._launch.replace(self._index[BEGINS], int(substep == 0))
            self._launch.replace(self._index[ENDS], int(substep >= substeps - 1))
            self._launch()
            if self._fault[0]:
                # Whatever went wrong, the coordinates are those of the start of the step.
                return rounds if self._fits() else 0
            if self.slumber is not None:
                self.slumber.watch()
            if between is not None and substep < rounds - 1:
                between()
        return rounds

    def _step_once(self, advance: Callable[[], None]) -> bool:
        """A step of one substep where bodies touch and none sleeps; returns whether everything did fit."""
        if self.detection is not None and not self.detection.run():
            return False
        advance()
        return not self._fault[0] or self._fits()

    def _fits(self) -> bool:
        if self._fault[0] == OVERFLOW:
            self._touch.grow_couplings()
            return False
        return True
