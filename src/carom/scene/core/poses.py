"""The links of a world: whose rows they are, their poses and velocities for its present coordinates."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.native.change import Change
from carom.native.kernels import follow_nodes_kernel, link_twist_kernel, settle_loads_kernel
from carom.native.launch import TreeLaunch
from carom.scene.core.world_data import WorldData

if TYPE_CHECKING:
    from carom.engine.queries.present_poses import PresentPoses
    from carom.scene.core.body_core import BodyCore


class PoseUpdates(WorldData):
    """Whose the rows of links are, and their poses and velocities, computed only when they are asked for."""

    @property
    def link_places(self) -> list[tuple[int, int]]:
        """Body and link (-1 is the base) of each row of the link arrays."""
        if self._derived.link_places is None:
            bodies = sorted(self.bodies.values(), key=lambda body: body.first_link)
            self._derived.link_places = [
                (body.id, link) for body in bodies for link in range(-1, body.joint_count)
            ]
        return self._derived.link_places

    @property
    def link_columns(self) -> tuple[list[int], list[int]]:
        """The bodies and the links of `link_places` as two lists; row -1, which stands for no link, is -1."""
        if self._derived.link_columns is None:
            places = [*self.link_places, (-1, -1)]
            self._derived.link_columns = [body for body, _ in places], [link for _, link in places]
        return self._derived.link_columns

    def present_poses(self) -> PresentPoses:
        """A context in which `link_pose` is up to date with the coordinates of all bodies."""
        if self._derived.present_poses is None:
            from carom.engine.queries.present_poses import PresentPoses

            poses = self.arrays.state.bytes_of("link_pose")
            self._derived.present_poses = PresentPoses(poses, self._kernel_structs())
        return self._derived.present_poses

    def update_link_poses(self, body: BodyCore) -> None:
        """Bring `link_pose` up to date with the coordinates of a body."""
        (self._derived.pose_launch or self.prepare_poses())(body.rows.tree)

    def note_link_poses(self, change: Change, *bodies: BodyCore) -> None:
        """Bring `link_pose` up to date with the coordinates of bodies, by default all, after a change."""
        launch = self._derived.pose_launch or self.prepare_poses()
        if not bodies:
            change.run_record(launch.records(self.arrays.used["tree"]), launch)
        for body in bodies:
            change.run_record(launch.record(body.rows.tree), launch)

    def prepare_poses(self) -> TreeLaunch:
        """Set the addresses that the fast paths in the native library use, after a change of the scene.

        Returns:
            A function that updates the link poses of a body.
        """
        if self._derived.pose_launch is None:
            self.grow(self.contact_arrays.shapes.table, {"link": self.arrays.model.capacity["link"]})
            self._derived.pose_launch = self.quick.set_pose_addresses(self.arrays, self.contact_arrays)
        return self._derived.pose_launch

    def update_soft_poses(self) -> None:
        """Bring the poses and velocities of all soft bodies as a whole up to date with their nodes."""
        if self.contact_arrays.soft.bodies:
            if self._derived.step is None:
                # Nodes anchored to the world are left out; `write_anchors` marks these.
                self.contact_arrays.soft.write_anchors()
            self.engine.structs().launch(follow_nodes_kernel, first_world=0)()

    def note_soft_poses(self, change: Change) -> None:
        """The same after a change, which has noted the anchors."""
        if self.contact_arrays.soft.bodies:
            launch = self.engine.structs().launch(follow_nodes_kernel, first_world=0)
            # The kernel's number is that of the first world instead of a tree.
            change.run(launch.addresses("first_world"), 0, launch)

    def update_link_velocities(self, body: BodyCore) -> None:
        """Fill `link_velocity` for the present coordinates of a body."""
        self._prepare_velocities()(body.rows.tree)

    def settle_loads(self, body: BodyCore) -> None:
        """Find what the joints of a body transmitted in the last step, for sensors, if the step has not."""
        if self._derived.load_launch is None:
            self._derived.load_launch = TreeLaunch(settle_loads_kernel, self.engine.structs())
        self._derived.load_launch(body.rows.tree)

    def note_link_velocities(self, change: Change, body: BodyCore) -> None:
        """The same after a change."""
        launch = self._prepare_velocities()
        change.run(launch.addresses(), body.rows.tree, launch)

    def _prepare_velocities(self) -> TreeLaunch:
        if self._derived.twist_launch is None:
            self._derived.twist_launch = TreeLaunch(link_twist_kernel, self.engine.structs())
            self.quick.set_twist_addresses(self._derived.twist_launch)
        return self._derived.twist_launch
