"""Link poses for the present coordinates, during a query."""

from __future__ import annotations

from carom.native.kernels import link_poses_kernel
from carom.native.launch import KernelStructs


class PresentPoses:
    """A context in which `link_pose` has the link poses for the present coordinates of all bodies.

    On entry it returns the memory of `link_pose`. On exit it restores the former poses: after a step they are
    those at the start of the last substep, as getters expect. Contexts may be nested.
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
