"""Inverse kinematics: joint positions for given poses of links."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sized
from functools import cache
from math import isnan
from typing import TYPE_CHECKING, Any, overload

from pybullet._algorithms.algebra import converted_rotations, joint_coordinates
from pybullet._calls.arguments import (
    NOT_GIVEN,
    Indices,
    Vector,
    Vectors,
    indices,
    integer,
    length,
    numbers,
    one_body,
    real,
    rotation,
    sequence,
    vector3,
)
from pybullet._calls.builtin import exported, exported_requiring
from pybullet._calls.constants import IK_DLS, IK_SDLS
from pybullet._calls.errors import fail, warn_once
from pybullet._clients.clients import client_of
from pybullet._clients.lookup import body_of, link_of
from pybullet._maths.maths import getEulerFromQuaternion

if TYPE_CHECKING:
    from carom.scene.body import Body

__all__ = ["calculateInverseKinematics", "calculateInverseKinematics2"]

_PROBLEM = "Error in calculateInverseKinematics"
_NO_POSITION = "calculateInverseKinematics couldn't extract position vector3"
_CURRENT_POSITIONS = (
    "calculateInverseKinematics the size of input current positions needs to be equal to the number of "
    "degrees of freedom."
)
_LIMITS = ("lowerLimits", "upperLimits", "jointRanges", "restPoses")
_MISSING: Any = object()
_UNSTATED = -1
_SOLVERS = (IK_DLS, IK_SDLS)
# As `carom.model.body_spec.BASE`, which is not imported for this.
_BASE = -1
_ORIGIN = (0.0, 0.0, 0.0)
_ALL_FOUR = (
    "calculateInverseKinematics: limits and rest poses are heeded only if lowerLimits, upperLimits, "
    "jointRanges and restPoses are all given, with a number for each degree of freedom, as in PyBullet; "
    "solver=IK_SDLS keeps lowerLimits and upperLimits by themselves"
)


@overload
def calculateInverseKinematics(
    bodyUniqueId: int,
    endEffectorLinkIndex: int,
    targetPosition: Vector,
    targetOrientation: Vector | None = None,
    lowerLimits: Vector | None = None,
    upperLimits: Vector | None = None,
    jointRanges: Vector | None = None,
    restPoses: Vector | None = None,
    jointDamping: Vector | None = None,
    solver: int = 0,
    currentPositions: Vector | None = None,
    maxNumIterations: int = -1,
    residualThreshold: float = -1,
    physicsClientId: int = 0,
) -> tuple[float, ...]: ...
@overload
def calculateInverseKinematics(
    *,
    bodyIndex: int,
    endEffectorLinkIndex: int,
    targetPosition: Vector,
    targetOrientation: Vector | None = None,
    lowerLimits: Vector | None = None,
    upperLimits: Vector | None = None,
    jointRanges: Vector | None = None,
    restPoses: Vector | None = None,
    jointDamping: Vector | None = None,
    solver: int = 0,
    currentPositions: Vector | None = None,
    maxNumIterations: int = -1,
    residualThreshold: float = -1,
    physicsClientId: int = 0,
) -> tuple[float, ...]: ...
@exported_requiring(3)
def calculateInverseKinematics(
    bodyUniqueId: int = NOT_GIVEN,
    endEffectorLinkIndex: int = _MISSING,
    targetPosition: Vector = _MISSING,
    targetOrientation: Vector | None = None,
    lowerLimits: Vector | None = None,
    upperLimits: Vector | None = None,
    jointRanges: Vector | None = None,
    restPoses: Vector | None = None,
    jointDamping: Vector | None = None,
    solver: int = 0,
    currentPositions: Vector | None = None,
    maxNumIterations: int = -1,
    residualThreshold: float = -1,
    physicsClientId: int = 0,
    *,
    bodyIndex: int = NOT_GIVEN,
) -> tuple[float, ...]:
    """Joint positions that bring a link nearer to a target pose; the body does not move.

    The answer is PyBullet's: damped least squares from the present pose, or from `currentPositions`, for at
    most `maxNumIterations` steps, arrived or not. It may be far from the target, above all with an
    orientation or a `jointDamping`; programs ask again in each step of the simulation. With all of
    `lowerLimits`, `upperLimits`, `jointRanges` and `restPoses` joints are pulled towards their rest poses and
    back from beyond their limits, as far as this does not move the link; the answer may still be beyond.

    With `solver=IK_SDLS`, which crashes PyBullet, Carom's own search goes on where PyBullet's stops, until
    the link is at the target, and keeps `lowerLimits` and `upperLimits`. It also answers for bodies with
    spherical or planar joints.

    Args:
        bodyUniqueId: The body.
        endEffectorLinkIndex: The link, from 0; -1 is the base.
        targetPosition: Target of the origin of its link frame [m], in the world frame; with
            `currentPositions` in the inertial frame of the base, as in PyBullet.
        targetOrientation: Target orientation of its inertial frame, a quaternion (x, y, z, w).
        lowerLimits: One for each degree of freedom of the joints [rad or m]; heeded with the other three
            lists only, unless `IK_SDLS` is asked for. Lists of another length are ignored, as in PyBullet.
        upperLimits: Upper limits.
        jointRanges: Differences of upper and lower limits. The pull back into the limits is divided by them.
        restPoses: Preferred joint positions.
        jointDamping: Damping of each joint in the search; default 0.5. Not heeded with the four lists.
        solver: `IK_DLS`, PyBullet's search, or `IK_SDLS`, Carom's; with the four lists always the former.
        currentPositions: Joint positions to start from.
        maxNumIterations: Maximum number of steps; default 20.
        residualThreshold: The step after the link is within this distance [m] is the last; default 1e-4. For
            Carom's search the tolerance of distances [m] and angles [rad].
        physicsClientId: The connection.
        bodyIndex: Another name of `bodyUniqueId`.

    Returns:
        A position for each degree of freedom of the joints, in the order of `getJointInfo`; fixed joints have
        none, spherical joints roll, pitch and yaw.

    Raises:
        pybullet.error: Not connected, there is no such body or link, or an argument does not fit.

    Examples:
        >>> angles = p.calculateInverseKinematics(arm, 6, [0.5, 0, 0.5], maxNumIterations=100)
        >>> for joint, angle in enumerate(angles):
        ...     p.resetJointState(arm, joint, angle)
        >>> [round(x, 2) + 0.0 for x in p.getLinkState(arm, 6, computeForwardKinematics=1)[4]]
        [0.5, 0.0, 0.5]
    """
    given = locals()
    body_id = one_body(bodyUniqueId, bodyIndex, "calculateInverseKinematics")
    if endEffectorLinkIndex is _MISSING or targetPosition is _MISSING:
        name = "endEffectorLinkIndex" if endEffectorLinkIndex is _MISSING else "targetPosition"
        raise TypeError(f"calculateInverseKinematics() missing required argument {name!r}")
    link = integer(endEffectorLinkIndex, "endEffectorLinkIndex")
    client = client_of(physicsClientId)
    position = vector3(targetPosition, _NO_POSITION, "targetPosition")
    orientation = _orientation(targetOrientation)
    body = body_of(client, body_id, _PROBLEM)
    options = _options(body, given)
    link_of(body, link, "endEffectorLinkIndex", _PROBLEM)
    orientations = None if orientation is None else (orientation,)
    search = _search(body, options)
    with client.call_lock:
        return _result(body, search(body, (link,), (position,), orientations, **options))


@exported
def calculateInverseKinematics2(
    bodyUniqueId: int,
    endEffectorLinkIndices: Indices,
    targetPositions: Vectors,
    lowerLimits: Vector | None = None,
    upperLimits: Vector | None = None,
    jointRanges: Vector | None = None,
    restPoses: Vector | None = None,
    jointDamping: Vector | None = None,
    solver: int = 0,
    currentPositions: Vector | None = None,
    maxNumIterations: int = -1,
    residualThreshold: float = -1,
    physicsClientId: int = 0,
) -> tuple[float, ...]:
    """Joint positions that bring several links nearer to target positions; the body does not move.

    The answer is PyBullet's, as that of `calculateInverseKinematics`, which says what gives a better one.

    Args:
        bodyUniqueId: The body.
        endEffectorLinkIndices: The links, from 0. Links without a position are ignored.
        targetPositions: Targets of the origins of the link frames, as in `calculateInverseKinematics`.
        lowerLimits: This and the following as in `calculateInverseKinematics`. If all four lists of limits
            and rest poses are given, the targets are ignored, as in PyBullet: only the lists have an effect.
        upperLimits: One for each degree of freedom of the joints [rad or m].
        jointRanges: Differences of upper and lower limits.
        restPoses: Preferred joint positions.
        jointDamping: Damping of each joint in the search.
        solver: `IK_DLS` or `IK_SDLS`.
        currentPositions: Joint positions to start from.
        maxNumIterations: Maximum number of steps.
        residualThreshold: Tolerance of distances [m].
        physicsClientId: The connection.

    Returns:
        A position for each degree of freedom of the joints, in the order of `getJointInfo`.

    Raises:
        pybullet.error: Not connected, there is no such body or link, or an argument does not fit.

    Examples:
        >>> angles = p.calculateInverseKinematics2(arm, [6], [[0.5, 0, 0.5]], maxNumIterations=100)
        >>> len(angles)
        7
    """
    given = locals()
    client = client_of(physicsClientId)
    links = indices(endEffectorLinkIndices, _NO_POSITION, "endEffectorLinkIndices")
    positions = [
        vector3(position, _NO_POSITION, "targetPositions")
        for position in sequence(targetPositions, _NO_POSITION, "targetPositions")
    ]
    if not positions:
        fail(_NO_POSITION, "targetPositions is empty.")
    if len(links) < len(positions):
        fail(_PROBLEM, f"There are {len(links)} links and {len(positions)} positions for them.")
    links = links[: len(positions)]
    body = body_of(client, bodyUniqueId, _PROBLEM)
    options = _options(body, given)
    for link in links:
        link_of(body, link, "endEffectorLinkIndices", _PROBLEM)

    if "rests" in options:
        warn_once(
            "calculateInverseKinematics2 ignores its targets when lowerLimits, upperLimits, jointRanges and "
            "restPoses are all given, as PyBullet does"
        )
        links, positions = (_BASE,), [_ORIGIN]
    search = _search(body, options)
    with client.call_lock:
        return _result(body, search(body, links, positions, **options))


# The functions of `carom.algorithms` are imported at the first call, to keep the module's import quick.
@cache
def _pybullets() -> Callable[..., tuple[float, ...]]:
    from carom.algorithms.pybullet_search import pybullet_positions

    return pybullet_positions


@cache
def _caroms() -> Callable[..., tuple[float, ...]]:
    from carom.algorithms.inverse_kinematics import find_positions

    return find_positions


def _search(body: Body, options: dict[str, Any]) -> Callable[..., tuple[float, ...]]:
    """The search for a body: PyBullet's for the options of `_options`, where it has an answer."""
    return _caroms() if "selective" in options or _needs_own_search(body) else _pybullets()


def _needs_own_search(body: Body) -> bool:
    """Whether a joint neither turns nor slides: PyBullet refuses then, or writes beyond its memory."""
    needs = body.derived.get(_needs_own_search)
    if needs is None:
        needs = body.derived[_needs_own_search] = any(count > 1 for count in body.velocity_count)
    return needs


def _orientation(values: Any) -> tuple[float, ...] | None:
    """The target orientation. As in PyBullet, anything without four numbers is ignored."""
    if values is None:
        return None
    try:
        if len(values) == 4:
            x, y, z, w = values
            if 0.5 < x * x + y * y + z * z + w * w < 2.0:
                return float(x), float(y), float(z), float(w)
    except (TypeError, ValueError, OverflowError):
        pass
    name = "targetOrientation"
    given = numbers(values, _PROBLEM, name)
    if len(given) != 4:
        warn_once("calculateInverseKinematics: targetOrientation does not have 4 values and is ignored")
        return None
    return rotation(given, _PROBLEM, name)


def _options(body: Body, given: Mapping[str, Any]) -> dict[str, Any]:
    """Options of `_search` for the arguments of a call, given by name."""
    solver, damping, current_positions = given["solver"], given["jointDamping"], given["currentPositions"]
    iterations, threshold = given["maxNumIterations"], given["residualThreshold"]
    freedoms = sum(body.velocity_count)
    if freedoms == 0:
        fail(_PROBLEM, f"Body {body.id} ({body.name}) has no joint that moves.")
    if integer(solver, "solver") not in _SOLVERS:
        fail(_PROBLEM, f"solver is {solver!r}, neither IK_DLS ({IK_DLS}) nor IK_SDLS ({IK_SDLS}).")
    options: dict[str, Any] = {}
    if iterations is not _UNSTATED and integer(iterations, "maxNumIterations") > 0:
        options["iterations"] = iterations
    if threshold is not _UNSTATED and real(threshold, "residualThreshold") >= 0.0:
        options["threshold"] = threshold
    if any(given[name] is not None for name in _LIMITS):
        lists = [_for_each_freedom(given[name], name, freedoms) for name in _LIMITS]
        lower, upper, ranges, rest = lists
        has_limits = lower is not None and upper is not None
        has_all = has_limits and ranges is not None and rest is not None
        if _needs_own_search(body) or (solver == IK_SDLS and not has_all):
            if has_limits:
                options |= {"lower": lower, "upper": upper, "ranges": ranges, "rest": rest}
        elif has_all:
            options["rests"] = lower, upper, ranges, rest
        elif lists != [None] * 4 and any(given[name] is None for name in _LIMITS):
            warn_once(_ALL_FOUR)
    if solver == IK_SDLS and "rests" not in options:
        options["selective"] = True
    if damping is not None:
        values = numbers(damping, _PROBLEM, "jointDamping")
        if len(values) >= freedoms:
            options["damping"] = values[:freedoms]
        elif values:
            warn_once(
                "calculateInverseKinematics: the size of input joint damping values should be equal to the "
                "number of degrees of freedom, not using joint damping."
            )
    if current_positions is not None:
        start = numbers(current_positions, _CURRENT_POSITIONS, "currentPositions")
        if start:
            if len(start) != freedoms:
                fail(_CURRENT_POSITIONS, f"They are {len(start)} and {freedoms}.")
            options["start"] = joint_coordinates(body, start)
            options["in_base_frame"] = True
    return options


def _for_each_freedom(values: Any, name: str, freedoms: int) -> tuple[float, ...] | None:
    """A list with one number, perhaps infinite, for each degree of freedom; None if its length differs."""
    if values is None:
        return None
    if not isinstance(values, (Sized, Iterator)):
        fail(_PROBLEM, f"{name} is {values!r}, not a list of numbers.")
    count = length(values, _PROBLEM, name)
    if count != freedoms:
        if count:
            warn_once(
                f"calculateInverseKinematics: {name} has {count} numbers, not {freedoms}, one for each "
                "degree of freedom; it is ignored, as in PyBullet"
            )
        return None
    try:
        result = tuple(map(float, sequence(values, _PROBLEM, name)))
    except (TypeError, ValueError):
        fail(_PROBLEM, f"{name} is {values!r}, not a list of numbers.")
    if any(map(isnan, result)):
        fail(_PROBLEM, f"{name} is {values!r}, with a value that is not a number.")
    return result


def _result(body: Body, coordinates: tuple[float, ...]) -> tuple[float, ...]:
    """Positions in PyBullet's form: roll, pitch and yaw of spherical joints instead of a quaternion."""
    return converted_rotations(body, coordinates, body.position_count, getEulerFromQuaternion)
