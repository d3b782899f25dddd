"""Rows of user constraints, linearised, except those between joints."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import ABSENT, UserConstraintKind
from carom.linearization.rows import HOLDS, Rows, status_of
from carom.linearization.turns import cross, euler_rates, inverse, matrix_of, multiplied

if TYPE_CHECKING:
    from carom.linearization.pair_rows import Places
    from carom.linearization.taken_step import TakenStep
    from carom.linearization.tangent import TangentSpace

_PARALLEL = 1e-6
# Lengths below this count as 0.
_LEAST = 1e-300
_NONE = np.zeros(3)
# Those whose rows are added by a kernel.
TIES = (UserConstraintKind.GEAR, UserConstraintKind.COUPLING)


class UserRows:
    """Adds the rows of the user constraints of a world in a step to `rows`."""

    def __init__(self, space: TangentSpace, taken: TakenStep, places: Places, rows: Rows) -> None:
        self._taken = taken
        self._places = places
        self._rows = rows
        self._space = space

    def add_all(self, count: int) -> None:
        """Add those of the first `count` constraints of the engine."""
        if not count:
            return
        users = self._taken.users
        absent: list[bool] = (self._taken.state["tree_activity"] == ABSENT).tolist()
        enabled, first, second, kinds = (
            users[f"user_{name}"][:count].tolist() for name in ("enabled", "tree_a", "tree_b", "kind")
        )
        for user in range(count):
            if not enabled[user] or any(tree >= 0 and absent[tree] for tree in (first[user], second[user])):
                continue
            kind = UserConstraintKind(kinds[user])
            if kind in TIES:
                continue
            if kind >= UserConstraintKind.TENDON:
                raise NotImplementedError(f"{_described(kind)} have no exact derivatives")
            if users["user_impedance"][user][1] > 0.0:
                raise NotImplementedError("compliant constraints have no exact derivatives")
            self._add_pose(user, kind)

    def _add(self, user: int, number: int, kind: UserConstraintKind, jacobian: np.ndarray) -> int | None:
        """Add a row; returns its number if it holds."""
        impulse = float(self._taken.state["user_impulse"][user, number])
        bound = float(self._taken.users["user_max_impulse"][user])
        status = status_of(impulse, -bound, bound)
        holds = status == HOLDS
        name = f"{_described(kind)} {user}"
        row = self._rows.add(name, status, jacobian, impulse, float(holds), 1.0 - float(holds))
        return row if holds else None

    def _add_pose(self, user: int, kind: UserConstraintKind) -> None:
        taken, users, places = self._taken, self._taken.users, self._places
        pivots, frames = [], []
        for end in "ab":
            tree, link = int(users[f"user_tree_{end}"][user]), int(users[f"user_link_{end}"][user])
            pivot, frame = users[f"user_pivot_{end}"][user], users[f"user_frame_{end}"][user]
            if tree >= 0:
                pose = taken.link_pose[link]
                pivot = pose[:3] + matrix_of(pose[3:]) @ pivot
                frame = multiplied(pose[3:], frame)
            pivots.append(places.point(link if tree >= 0 else -1, pivot))
            frames.append(frame)
        a, b = pivots
        apart = a.position - b.position
        turn = matrix_of(frames[0])
        relative = matrix_of(multiplied(inverse(frames[1]), frames[0]))
        directions = np.eye(3)
        linear_count, first_angle, angles = 3, 0, 3
        if kind == UserConstraintKind.PRISMATIC:
            link = int(users["user_link_a"][user])
            along = matrix_of(taken.link_pose[link, 3:]) @ users["user_axis"][user]
            first = cross(turn[:, 0], along)
            if np.sqrt(first @ first) <= _PARALLEL:
                first = cross(turn[:, 1], along)
            first /= max(np.sqrt(first @ first), _LEAST)
            second = cross(along, first)
            directions = np.stack([first, second / max(np.sqrt(second @ second), _LEAST)])
            linear_count, first_angle = 2, 2
        elif kind == UserConstraintKind.POINT_TO_POINT:
            angles = 0
        gain = taken.parameters.erp / taken.time_step
        for number in range(linear_count + angles):
            turned = np.zeros((2, 3, len(self._space)))
            if number < linear_count:
                linear, angular = directions[number], _NONE
                if kind == UserConstraintKind.PRISMATIC:
                    turned[0] = cross(a.turning.T, linear).T
                error = linear @ (a.moving - b.moving) + apart @ turned[0]
            else:
                axis = (number - linear_count + first_angle) % 3
                linear, angular = _NONE, turn[:, axis]
                turned[1] = cross(a.turning.T, angular).T
                error = euler_rates(relative)[axis] @ turn.T @ (a.turning - b.turning)
            jacobian, hessian = places.row(a, b, linear, angular, turned)
            row = self._add(user, number, kind, jacobian)
            self._rows.set_hessian(len(self._rows) - 1, hessian)
            if row is not None:
                self._rows.by_position[row] = -gain * error


def _described(kind: UserConstraintKind) -> str:
    return {
        UserConstraintKind.TENDON: "tendons",
        UserConstraintKind.TENDON_COUPLING: "couplings of tendons",
        UserConstraintKind.TRANSMISSION: "actuators of tendons and sites",
        UserConstraintKind.BASE_FRICTION: "frictions of free bodies",
    }.get(kind, f"{kind.name.lower().replace('_', ' ')} constraint")
