"""Quick calls: functions that loops call every step, which the native library tries first.

This module lists them, with the kinds of their arguments and results. If the library cannot handle a call,
the builtin calls its Python function as usual.
"""

from __future__ import annotations

from math import nan
from threading import Lock
from typing import TYPE_CHECKING

from carom.layouts.dynamics_parameters import CHANGE_DYNAMICS
from carom.native.change import Change, changes_made
from carom.native.uninterrupted import in_section
from pybullet._calls.builtin import Export, exports, vectorcall
from pybullet._calls.conduct import COMMITS, FREE, client_place, reads
from pybullet._calls.errors import logger

if TYPE_CHECKING:
    from carom.native.quick_calls import QuickCalls

_KERNELS: dict[str, tuple[str, str, tuple[int, ...] | None]] = {
    "getQuaternionFromEuler": ("quaternion_from_euler", "3-", (4,)),
    "getEulerFromQuaternion": ("euler_from_quaternion", "4-", (3,)),
    "getMatrixFromQuaternion": ("matrix_from_quaternion", "q-", (9,)),
    "multiplyTransforms": ("multiply_transforms", "3q3q-", (3, 4)),
    "invertTransform": ("invert_transform", "3q-", (3, 4)),
    "rotateVector": ("rotate_vector", "43-", (3,)),
    "getQuaternionFromAxisAngle": ("quaternion_from_axis_angle", "3r-", (4,)),
    "getAxisAngleFromQuaternion": ("axis_angle_from_quaternion", "4-", (3, 0)),
    "getQuaternionSlerp": ("quaternion_slerp", "qqr-", (4,)),
    "getDifferenceQuaternion": ("difference_quaternion", "44-", (4,)),
    "getAxisDifferenceQuaternion": ("axis_difference_quaternion", "qq-", (3,)),
    "calculateVelocityQuaternion": ("velocity_quaternion", "44r-", (3,)),
    "getBasePositionAndOrientation": ("base_pose", "bc", (3, 4)),
    "getBaseVelocity": ("base_velocity", "bc", (3, 3)),
    "getLinkState": ("link_state", "biiic", (3, 4, 3, 4, 3, 4, 3, 3)),
    "getLinkStates": ("link_states", "bsiic", None),
    "performCollisionDetection": ("detect_collisions", "c", ()),
    "getContactPoints": ("contact_points", "iiiic", None),
    "getClosestPoints": ("closest_points", "biriiii----c", None),
    "getOverlappingObjects": ("overlapping", "33c", None),
    "applyExternalForce": ("apply_force", "bi33ic", ()),
    "applyExternalTorque": ("apply_torque", "bi3ic", ()),
    "resetBasePositionAndOrientation": ("place_base", "b3qc", ()),
    "resetBaseVelocity": ("set_base_velocity", "b33c", ()),
    "getJointState": ("joint_state", "bic", (0, 0, 6, 0)),
    "getJointStates": ("joint_states", "bsc", None),
    "getJointStateMultiDof": ("joint_state_multi_dof", "bic", None),
    "getJointStatesMultiDof": ("joint_states_multi_dof", "bsc", None),
    "setJointMotorControl2": ("command_motor", "biirrrrrrc", ()),
    "setJointMotorControlArray": ("command_motors", "bsivvvvvc", ()),
    "setJointMotorControlMultiDof": ("command_joint_by_lists", "biivvvvvrvc", ()),
    "setJointMotorControlMultiDofArray": ("command_joints_by_lists", "bsivvvvv-c", ()),
    "changeDynamics": ("change_dynamics", "".join(CHANGE_DYNAMICS.values()), ()),
    "resetJointState": ("reset_joint", "birrc", ()),
    "stepSimulation": ("step", "c", None),
    "getAABB": ("link_box", "bic", (3, 3)),
    "isConnected": ("is_connected", "c", None),
    "getNumBodies": ("body_count", "c", None),
    "getBodyUniqueId": ("body_at", "ic", None),
    "getNumJoints": ("joint_count", "ic", None),
    "getBodyInfo": ("body_names", "ic", None),
}
"""Kernel, kinds of parameters and lengths of the groups of results (None if the kernel makes the result
itself), by the name of the function. `carom.native.quick_calls.Parameter` explains the letters."""


class _Installed:
    """The state of the quick calls in this process: None before they are installed, or if unavailable.

    `is_paused`: whether all calls that name a connection are left to Python.
    """

    calls: QuickCalls | None = None
    tried = False
    is_paused = False


_installing = Lock()


def install() -> QuickCalls | None:
    """Lets the native library try these functions from now on; returns None if it cannot."""
    with _installing:
        if not _Installed.tried:
            from carom.native.quick_calls import quick_calls

            calls = quick_calls(vectorcall)
            _Installed.tried = True
            if calls is None:
                logger.info("small calls take the way through Python here, and more time; see docs/install")
            else:
                calls.is_paused.value = _Installed.is_paused
                _Installed.calls = calls
                for name, export in exports.items():
                    _guard(calls, name, export)
    if _Installed.calls is not None:
        _Installed.calls.meet_numpy()
    return _Installed.calls


def first_change() -> Change:
    """The change that a function of `COMMITS` makes; to be asked for first.

    It may be any one in a section, where nothing comes in between, and where the library does not call again.
    """
    return Change(begun=-1 if _Installed.calls is None or in_section() else changes_made())


def pause(*, paused: bool) -> None:
    """Leaves all calls that name a connection to Python if `paused`, otherwise lets the library try them."""
    with _installing:
        _Installed.is_paused = paused
        if _Installed.calls is not None:
            _Installed.calls.is_paused.value = paused


def _guard(calls: QuickCalls, name: str, export: Export) -> None:
    from carom.layouts.gates import Conduct

    conduct = Conduct.READS if reads(name) else Conduct.COMMITS if name in COMMITS else Conduct.CHANGES
    conduct = Conduct.FREE if name in FREE else conduct
    if name in _KERNELS:
        _quicken(calls, export, *_KERNELS[name])
    elif conduct == Conduct.FREE:
        return
    export.definition.code = calls.guard(conduct, client_place(export.code))


def _quicken(
    calls: QuickCalls, export: Export, kernel: str, kinds: str, groups: tuple[int, ...] | None
) -> None:
    from carom.native.quick_calls import Parameter

    # Not the function's present code, which has no named parameters while there are detours.
    names = export.code.co_varnames[: export.code.co_argcount]
    defaults = export.function.__defaults__ or ()
    required = len(names) - len(defaults)
    missing = [None] * required + [nan if value is None else float(value) for value in defaults]
    parameters = [Parameter(*parts) for parts in zip(names, kinds, missing, strict=True)]
    calls.quicken(kernel, parameters, groups, flat=groups is not None and len(groups) == 1)
