"""Link poses for the present coordinates, during a query."""

from __future__ import annotations

from carom.native.kernels import link_poses_kernel
from carom.native.launch import KernelStructs


class PresentPoses:
    """A context in which `link_pose` is up to date with the coordinates of all bodies; it gives its memory.

    Afterwards it is restored: after a step its rows are those of the start of the last substep, as getters
    expect. Contexts may be nested.

    Args:
        poses: The memory of `link_pose`.
        structs: Warp structs by the name kernels give them.
    """

    __slots__ = ("_before", "_find", "_poses")

    def __init__(self, poses: memoryview[int], structs: KernelStructs) -> None:
        self._poses = poses
        self._find = structs.launch(link_poses_kernel, first_world=0).function
        self._before: list[bytes] = []

    def __enter__(self) -> memoryview[int]:
        self._before.append(self._poses.tobytes())
        self._find()
        return self._poses

    def __exit__(self, *_: object) -> None:
        self._poses[:] = self._before.pop()
