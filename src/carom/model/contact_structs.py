"""What collision detection and contact response work on: `Shapes`, `Pairs`, `Contacts`.

As in `structs`, a field's axis is the first word of its name. A *manifold* is a run of at most four
contacts of the same two shapes; the first shape of a pair has the lower row.
"""

import warp as wp

from carom.model.real import (
    Index4Rows,
    IntRows,
    Ints,
    RealRows,
    Reals,
    Transforms,
    Vector3Rows,
    Vector4Rows,
    Vectors3,
    Vectors4,
)


@wp.struct
class Shapes:
    """Geometry and surface of everything that touches; shared by all worlds."""

    shape_link: Ints
    shape_tree: Ints
    shape_kind: Ints
    shape_size: Vectors3  # see `codes.ShapeKind`
    shape_pose: Transforms  # in the link's inertial frame
    shape_margin: Reals
    shape_breaking: Reals  # distance at which a contact is given up [m]
    shape_ccd_radius: Reals
    shape_first_vertex: Ints
    shape_vertex_count: Ints
    shape_first_face: Ints
    shape_face_count: Ints

    # Polyhedra: vertices in the shape frame; faces with their outward planes (n, d), n x = d, and
    # their corners counter-clockwise as seen from outside. A triangle mesh's faces are its triangles.
    vertex_position: Vectors3
    face_plane: Vectors4
    face_first_corner: Ints
    face_corner_count: Ints
    corner_vertex: Ints

    link_first_shape: Ints
    link_shape_count: Ints
    link_group: Ints
    link_mask: Ints
    link_self_collision: Ints  # loading flags that decide about collisions within the body
    link_lateral_friction: Reals
    link_rolling_friction: Reals
    link_spinning_friction: Reals
    link_restitution: Reals
    link_stiffness: Reals  # negative: rigid
    link_contact_damping: Reals
    link_friction_anchor: Ints

    # Pairs of links whose collisions users switched on or off, sorted by the two link rows.
    filter_link_a: Ints
    filter_link_b: Ints
    filter_enabled: Ints


@wp.struct
class Pairs:
    """Intermediate results of collision detection."""

    shape_lower: Vector3Rows  # bounds in world axes
    shape_upper: Vector3Rows
    pair_shapes: Index4Rows  # shape a, shape b, 0, 0
    count_pairs: IntRows  # its first entry; more than the capacity of `pair` means overflow


@wp.struct
class Contacts:
    """Contact points; they persist from step to step."""

    contact_shapes: Index4Rows  # shape a, shape b, link a, link b
    contact_local_a: Vector3Rows  # in the links' inertial frames
    contact_local_b: Vector3Rows
    contact_point_a: Vector3Rows  # in world axes
    contact_point_b: Vector3Rows
    contact_normal: Vector3Rows  # on b, towards a
    contact_direction1: Vector3Rows  # friction directions
    contact_direction2: Vector3Rows
    contact_distance: RealRows  # negative: penetration
    contact_impulse: Vector4Rows  # normal, along direction 1, along direction 2, 0; of the last substep
    contact_age: IntRows  # substeps
    count_contacts: IntRows  # its first entry; more than the capacity of `contact` means overflow
