"""Data of soft bodies: `SoftModel`, and `SoftWork`, the workspace of a step.

A soft body is *nodes* (points with mass), *springs* between two and *tetrahedra* between four of them, and a
surface of triangular *faces*. A tree without links represents it among all other bodies: a fixed base whose
pose and velocity follow the nodes. As in `layouts.model`, a field's axis is the first word of its name. The
rows of each soft body are contiguous, and all worlds share the topology.
"""

from carom.layouts.types import (
    Array,
    Index4,
    Index4Rows,
    Int32,
    IntRows,
    Ints,
    Matrix3,
    RealRows,
    Reals,
    Vector3,
    Vector3Rows,
    Vector4Rows,
    Vectors3,
    parameter,
    real,
    struct,
)

# Values of `SoftModel.node_anchored`: free; anchored to a link; the same, without damping of the link.
FREE, HELD, HELD_UNDAMPED = 0, 1, 2
# Columns of `SoftModel.count_soft`.
BODIES, ANCHORS = 0, 1
# Maximum number of shapes in contact with one node: the nearest ones are kept.
TOUCHES_PER_NODE = 3
# The same for one face.
TOUCHES_PER_FACE = 3
# Rows over a tree of a touch or an anchor: an impulse along each world axis.
PUSH_ROWS = 3
# Maximum number of faces of soft bodies stored for one node: the nearest ones.
FACES_PER_NODE = 4
# Number of buckets of the hash grid of nodes; a power of two.
BUCKETS = 4096


@struct
class SoftBodyModel:
    """One soft body."""

    tree: Int32  # the tree that represents it
    first_node: Int32
    node_count: Int32
    first_spring: Int32
    spring_count: Int32
    first_tetra: Int32
    tetra_count: Int32
    first_face: Int32
    face_count: Int32
    self_collision: Int32
    margin: real  # distance of resting nodes from shapes [m]
    thickness: real  # minimum distance of nodes from its faces [m]
    mu: real  # Neo-Hookean parameters [Pa]
    lam: real
    damping: real  # viscosity of tetrahedra, per unit of `mu` and `lam` [s]
    frequency: real  # upper bound of its natural angular frequencies [rad/s]
    gravity_factor: real  # factor on the world's gravity


@struct
class SpringModel:
    """A spring between two nodes."""

    a: Int32
    b: Int32
    all_directions: Int32  # 1: damps all relative motion of its ends; 0: only along the spring
    length: real  # at rest [m]
    stiffness: real  # [N/m]
    damping: real  # [N s/m]
    frequency: real  # upper bound of the natural angular frequencies of its nodes [rad/s]


@struct
class TetraModel:
    """A tetrahedron between four nodes."""

    nodes: Index4
    inverse: Matrix3  # of the matrix of edges from the first node (columns), at rest [1/m]
    volume: real  # at rest [m³]
    frequency: real  # as for a spring, at rest [rad/s]


@struct
class AnchorModel:
    """A node held at a point of a link."""

    node: Int32
    tree: Int32
    link: Int32
    pivot: Vector3  # in the inertial frame of the link
    late_force: real  # share of the external force on the link that acts after the node has followed it


@struct
class SoftModel:
    """Topology and parameters of all soft bodies."""

    soft: Array[SoftBodyModel] = parameter("soft")
    spring: Array[SpringModel] = parameter("spring")
    tetra: Array[TetraModel] = parameter("tetra")
    anchor: Array[AnchorModel] = parameter("anchor")
    node_inverse_mass: Reals = parameter("node")  # 0: fixed in the world
    # `FREE`, `HELD` or `HELD_UNDAMPED`; held ones have no contacts with any shapes
    node_anchored: Ints = parameter("node")
    node_rest: Vectors3 = parameter("node")  # position as loaded, from its body's centre of mass [m]
    face_nodes: Array[Index4] = parameter("face")  # three nodes, counter-clockwise from outside
    count_soft: Ints = parameter("count")  # columns: BODIES, ANCHORS


@struct
class SoftWork:
    """Intermediate results of a step of soft bodies.

    A *touch* is a node or a point of a face near a shape. During a substep the shape is approximated by a
    plane through a point that moves with the link. Each node has `TOUCHES_PER_NODE` contiguous rows for
    touches; behind those of all nodes, each face has `TOUCHES_PER_FACE`.
    """

    node_start_position: Vector3Rows  # at the start of the step
    node_start_velocity: Vector3Rows
    node_start_push: Vector3Rows
    node_before: Vector3Rows  # position at the start of the smaller time step
    node_touches: IntRows  # number of touches
    face_touches: IntRows  # number of touches
    node_body: IntRows
    node_faces: IntRows  # number of faces near it
    node_next: IntRows  # next node in the same bucket
    bucket_first: IntRows
    near_face: IntRows  # `FACES_PER_NODE` for each node
    near_side: RealRows  # 1: the node is on the side of the face's normal; -1: on the other
    near_distance: RealRows  # when the face was found
    near_impulse: Vector3Rows  # on the node, in this substep [N s]
    touch_row: IntRows  # first of its rows over a tree, -1 if no dof moves the link
    touch_shape: IntRows
    touch_point: Vector3Rows
    touch_velocity: Vector3Rows  # of the point at the start of the substep
    touch_normal: Vector3Rows  # towards the node or face
    touch_offset: RealRows  # distance of a resting node or face from the plane [m]
    touch_weights: Vector3Rows  # of a face's corners: barycentric coordinates of its touching point
    touch_friction: RealRows
    touch_impulse: Vector3Rows  # on the node or face, in this substep [N s]
    anchor_row: IntRows  # likewise
    anchor_point: Vector3Rows
    anchor_velocity: Vector3Rows
    anchor_impulse: Vector3Rows
    dof_start: RealRows  # velocity at the start of the substep
    tree_ready: IntRows  # 1: its inverse mass matrix has been computed
    polytope_point: Vector3Rows  # workspace of EPA, as in `Pairs`
    polytope_point_a: Vector3Rows
    polytope_plane: Vector4Rows
    polytope_face: Index4Rows
    polytope_edge: Index4Rows
