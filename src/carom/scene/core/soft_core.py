"""A soft body as everything below it knows it: nodes tied by springs and tetrahedra."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.checks import Array, finite
from carom.description.pose import Pose
from carom.description.transform import compose, inverse, rotation_matrix
from carom.model.soft_spec import Anchor, SoftRows, SoftSpec
from carom.native.change import Change, first_change
from carom.native.gates import gated
from carom.native.products import dots, length, product
from carom.native.uninterrupted import uninterrupted
from carom.scene.core.body_core import BodyCore
from carom.scene.handles import world_of

if TYPE_CHECKING:
    from carom.checks import Array
    from carom.scene.core.world_core import WorldCore


class SoftCore(BodyCore):
    """What a soft body is without the handles of its parts; `SoftBody` says more."""

    @property
    def rows_of_nodes(self) -> slice:
        """Rows of its nodes in `World.arrays.state`."""
        first = self.rows.first["node"]
        return slice(first, first + self.rows.count["node"])

    @property
    def soft_spec(self) -> SoftSpec:
        """Its specification."""
        assert self.spec.soft is not None
        return self.spec.soft

    @property
    def soft_rows(self) -> SoftRows:
        """Its rows in the arrays of soft bodies."""
        return next(soft for soft in self.world.contact_arrays.soft.bodies if soft.rows is self.rows)

    @property
    def mass(self) -> float:
        """Mass of all nodes [kg]."""
        return float(self.soft_spec.masses.sum())

    @property
    def nodes(self) -> Array:
        """Positions of the nodes in world axes [m], shape (n, 3), a view.

        Call `update` after writing to it.
        """
        return self.world.arrays.state.numpy["node_position"][0, self.rows_of_nodes]

    @property
    def node_velocities(self) -> Array:
        """Velocities of the nodes [m/s], shape (n, 3), a view; call `update` after writing to it."""
        return self.world.arrays.state.numpy["node_velocity"][0, self.rows_of_nodes]

    @property
    def node_forces(self) -> Array:
        """Forces that act on the nodes in the next step and are cleared by it [N], shape (n, 3); a view."""
        return self.world.arrays.state.numpy["node_force"][0, self.rows_of_nodes]

    @property
    def faces(self) -> NDArray[np.int32]:
        """Nodes of the triangles of the surface, shape (f, 3)."""
        return self.soft_spec.faces

    @property
    @gated("world.call_lock")
    def surface(self) -> tuple[Array, NDArray[np.int32]]:
        """Its visible mesh: (v, 3) vertices in world axes [m], a copy, and (t, 3) triangles."""
        skin = self.soft_spec.skin
        if skin is None:
            return self.nodes.copy(), self.soft_spec.faces
        return dots(skin.weights[:, None], np.swapaxes(self.nodes[skin.nodes], 1, 2)), skin.triangles

    @property
    def tetrahedra(self) -> NDArray[np.int32]:
        """Nodes of the tetrahedra, shape (t, 4)."""
        return self.soft_spec.tetras

    @property
    def anchors(self) -> list[Anchor]:
        """Its anchors."""
        return [it for it in self.world.contact_arrays.soft.anchors.values() if it.soft.rows is self.rows]

    @gated("world.call_lock")
    def update(self) -> None:
        """Update the pose and the velocity of the base after nodes have been written."""
        self.world.update_soft_poses()

    @gated("world.call_lock", commits=True)
    def set_nodes(self, positions: Array | Sequence[Sequence[float]]) -> None:
        """Set the positions of the nodes; their velocities do not change.

        Args:
            positions: In world axes [m], shape (n, 3).

        Raises:
            ValueError: The shape is wrong, or a number is not finite.
        """
        change = first_change()
        self._change_nodes(change, positions=_as_many(positions, self.nodes.shape, "positions"))

    @gated("world.call_lock", commits=True)
    def set_node_velocities(self, velocities: Array | Sequence[Sequence[float]]) -> None:
        """Set the velocities of the nodes [m/s], shape (n, 3).

        Raises:
            ValueError: The shape is wrong, or a number is not finite.
        """
        change = first_change()
        self._change_nodes(change, velocities=_as_many(velocities, self.node_velocities.shape, "velocities"))

    @gated("world.call_lock", commits=True)
    def set_inertial_pose(self, position: Sequence[float], orientation: Sequence[float]) -> None:
        """Move and rotate all nodes; the centre of mass moves to `position`. See `Body.set_inertial_pose`."""
        change = first_change()
        state = world_of(self).arrays.state.numpy
        first = self.first_position
        center = state["position"][0, first : first + 3].copy()
        before = np.array(rotation_matrix(_unit(state["position"][0, first + 3 : first + 7])))
        turn = product(np.array(rotation_matrix(_unit(orientation))), before.T)
        self._change_nodes(
            change,
            product(self.nodes - center, turn.T) + np.asarray(position),
            product(self.node_velocities, turn.T),
        )

    @gated("world.call_lock", commits=True)
    def set_base_velocity(self, linear: Sequence[float], angular: Sequence[float]) -> None:
        """Give the nodes the velocities of a rigid body: linear (centre of mass) [m/s], angular [rad/s]."""
        change = first_change()
        first = self.first_position
        center = self.world.arrays.state.numpy["position"][0, first : first + 3]
        turning = np.cross(np.asarray(angular), self.nodes - center)
        self._change_nodes(change, velocities=np.asarray(linear) + turning)

    def _change_nodes(
        self, change: Change, positions: Array | None = None, velocities: Array | None = None
    ) -> None:
        """Set positions or velocities of nodes, and with them the pose and the velocity of the base."""
        world_of(self)  # raises an error if the body has been removed
        for target, values in ((self.nodes, positions), (self.node_velocities, velocities)):
            if values is not None:
                change.write(target, values)
        self.world.contact_arrays.soft.note_anchors(change)
        self.world.note_soft_poses(change)
        change.commit()

    @gated("world.call_lock")
    def corners(self) -> tuple[Array, Array]:
        """Minimum and maximum corner of its bounding box in world axes, margin included [m]."""
        margin = self.soft_spec.margin
        return self.nodes.min(axis=0) - margin, self.nodes.max(axis=0) + margin

    @gated("world.call_lock")
    def anchor(
        self,
        node: int,
        body: BodyCore | None = None,
        link: int = -1,
        *,
        damped: bool = True,
        late_force: float = 0.0,
    ) -> Anchor:
        """Anchor a node at its present position to the world, or to a link, on which the force then acts.

        Args:
            node: The node, from 0.
            body: The body that holds it; None for the world.
            link: Its link; -1 is the base.
            damped: Damping within the soft body acts on the link, too. Without, as in PyBullet, the nodes
                around follow the anchored one, and the link feels nothing of it.
            late_force: Share of the external force on a body without joints, 0 to 1, that acts in each step
                only after the node has followed it. In PyBullet external forces act twice on bodies with
                maximal coordinates, the second time after that: half of the force.

        Returns:
            The anchor, for `release`.

        Raises:
            IndexError: There is no such node or link.
            ValueError: The other body is soft, or `late_force` is not between 0 and 1.
        """
        if not 0.0 <= late_force <= 1.0:
            raise ValueError(f"late_force is {late_force}; it has to be between 0 and 1")
        world = self.world
        if not 0 <= node < len(self.nodes):
            raise IndexError(f"body {self.id} has {len(self.nodes)} nodes; there is no node {node}")
        pivot = (0.0, 0.0, 0.0)
        if body is not None:
            if not -1 <= link < body.joint_count:
                raise IndexError(f"body {body.id} has {body.joint_count} links; there is no link {link}")
            if body.spec.soft is not None:
                raise ValueError(f"body {body.id} is soft: only the world and rigid bodies hold nodes")
            px, py, pz, *turn = world.link_pose[body.first_link + 1 + link].tolist()
            x, y, z = self.nodes[node].tolist()
            qx, qy, qz, qw = turn
            local = compose(inverse(Pose((px, py, pz), (qx, qy, qz, qw))), Pose((x, y, z)))
            pivot = local.position
        with uninterrupted:
            change = Change(world.change_scene)
            number = world.user_constraints.take_id(change)
            rows = None if body is None else body.rows
            anchor = Anchor(number, self.soft_rows, node, rows, link, pivot, damped, late_force)
            change.put(world.contact_arrays.soft.anchors, number, anchor)
            if body is None:
                change.write(self.node_velocities[node], 0.0)
            _commit(change, world)
        return anchor

    @gated("world.call_lock")
    def release(self, anchor: Anchor) -> None:
        """Remove an anchor."""
        remove_anchor(self.world, anchor.id)


@gated("call_lock")
def remove_anchor(world: WorldCore, number: int) -> None:
    """Remove the anchor with a number, if it exists."""
    with uninterrupted:
        change = Change(world.change_scene)
        change.drop(world.contact_arrays.soft.anchors, number)
        _commit(change, world)


def _commit(change: Change, world: WorldCore) -> None:
    """Make a change of anchors, and update what depends on them with it."""
    world.contact_arrays.soft.note_anchors(change)
    world.note_soft_poses(change)
    world.change_scene(change)
    change.commit()


def _unit(quaternion: Sequence[float] | np.ndarray) -> tuple[float, float, float, float]:
    four = np.asarray(quaternion, dtype=np.float64)
    x, y, z, w = (four / length(four)).tolist()
    return x, y, z, w


def _as_many(values: Array | Sequence[Sequence[float]], shape: tuple[int, ...], name: str) -> Array:
    array = finite(values, name)
    if array.shape != shape:
        raise ValueError(f"{name} must have shape {shape}, not {array.shape}")
    return array
