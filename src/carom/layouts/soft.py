"""Data of soft bodies: `SoftModel`, and `SoftWork`, the workspace of a step.

A soft body is *nodes* (points with mass), *springs* between two and *tetrahedra* between four of them, and a
surface of triangular *faces*. A tree without links stands for it among all other bodies: a fixed base whose
pose and velocity follow the nodes. As in `layouts.model`, a field's axis is the first word of its name; rows
of all soft bodies follow each other, and all worlds share the topology.
"""

from typing import TYPE_CHECKING, Any

from carom.layouts.types import (
    ArrayType,
    Index4,
    Int32,
    IntRows,
    Ints,
    Matrix3,
    RealRows,
    Reals,
    Vector3,
    Vector3Rows,
    Vectors3,
    real,
    struct,
)

# Columns of `SoftModel.count_soft`.
BODIES, ANCHORS = 0, 1
# Shapes that one node can touch at a time: the nearest ones are kept.
TOUCHES_PER_NODE = 3
# Rows over a tree that a touch or an anchor needs: a push along each axis of the world.
PUSH_ROWS = 3
# Faces of soft bodies that one node remembers at a time: the nearest ones.
FACES_PER_NODE = 4
# Lists of the nodes in the cells of a grid; a power of two.
BUCKETS = 4096


@struct
class SoftBodyModel:
    """One soft body."""

    tree: Int32  # the tree that stands for it
    first_node: Int32
    node_count: Int32
    first_spring: Int32
    spring_count: Int32
    first_tetra: Int32
    tetra_count: Int32
    first_face: Int32
    face_count: Int32
    self_collision: Int32
    margin: real  # distance from other surfaces at which a node rests [m]
    thickness: real  # distance at which nodes are kept off its faces [m]
    mu: real  # Neo-Hookean parameters [Pa]
    lam: real
    damping: real  # viscosity of tetrahedra as a share of `mu` and `lam` [s]
    frequency: real  # bound of the angular frequencies at which it can vibrate [rad/s]
    gravity_factor: real  # share of the world's gravity that pulls it


@struct
class SpringModel:
    """A spring between two nodes."""

    a: Int32
    b: Int32
    all_directions: Int32  # 1: damps every relative motion of its ends; 0: that along it
    length: real  # at rest [m]
    stiffness: real  # [N/m]
    damping: real  # [N s/m]
    frequency: real  # bound of the angular frequencies at which its ends can vibrate [rad/s]


@struct
class TetraModel:
    """A tetrahedron between four nodes."""

    nodes: Index4
    inverse: Matrix3  # of the edges from the first node, as columns, at rest [1/m]
    volume: real  # at rest [m³]
    frequency: real  # as of a spring, at rest [rad/s]


@struct
class AnchorModel:
    """A node held at a point of a link."""

    node: Int32
    tree: Int32
    link: Int32
    pivot: Vector3  # in the inertial frame of the link


if TYPE_CHECKING:
    SoftBodies = Any
    Springs = Any
    Tetras = Any
    Anchors = Any
    Index4s = Any
else:
    SoftBodies = ArrayType(SoftBodyModel)
    Springs = ArrayType(SpringModel)
    Tetras = ArrayType(TetraModel)
    Anchors = ArrayType(AnchorModel)
    Index4s = ArrayType(Index4)


@struct
class SoftModel:
    """Topology and parameters of all soft bodies."""

    soft: SoftBodies
    spring: Springs
    tetra: Tetras
    anchor: Anchors
    node_inverse_mass: Reals  # 0: held where it is in the world
    node_anchored: Ints  # 1: held at a link, whose shapes and those of others it does not touch
    node_rest: Vectors3  # from the centre of mass of its body, as it was loaded [m]
    face_nodes: Index4s  # three nodes, counter-clockwise from outside
    count_soft: Ints  # its columns are BODIES, ANCHORS


@struct
class SoftWork:
    """Intermediate results of a step of soft bodies.

    A *touch* is a node near a shape. While a substep lasts it sees the shape as a plane through a point that
    moves with the link; `TOUCHES_PER_NODE` of them follow each other for each node.
    """

    node_start_position: Vector3Rows  # at the start of the step
    node_start_velocity: Vector3Rows
    node_before: Vector3Rows  # at the start of the small step
    node_touches: IntRows  # how many
    node_body: IntRows
    node_faces: IntRows  # how many it is near
    node_next: IntRows  # in the list of its bucket
    bucket_first: IntRows
    near_face: IntRows  # `FACES_PER_NODE` for each node
    near_side: RealRows  # 1: the node is where the normal of the face points; -1: behind
    near_distance: RealRows  # when it was found
    near_impulse: Vector3Rows  # on the node, in this substep [N s]
    touch_row: IntRows  # the first of its rows over a tree, -1 if nothing moves the link
    touch_shape: IntRows
    touch_point: Vector3Rows
    touch_velocity: Vector3Rows  # of the point at the start of the substep
    touch_normal: Vector3Rows  # towards the node
    touch_offset: RealRows  # distance of the node from the plane at which it rests [m]
    touch_friction: RealRows
    touch_impulse: Vector3Rows  # on the node, in this substep [N s]
    anchor_row: IntRows  # likewise
    anchor_point: Vector3Rows
    anchor_velocity: Vector3Rows
    anchor_impulse: Vector3Rows
    dof_start: RealRows  # velocity at the start of the substep
    tree_ready: IntRows  # 1: its inverse mass matrix is there
