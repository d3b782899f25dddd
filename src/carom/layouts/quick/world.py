"""What quick calls need of a world, as addresses.

Functions are null while their data are missing; the host writes them last.
"""

from carom.layouts.contacts import Candidate
from carom.layouts.dynamics_parameters import OF_BODY, SURFACE
from carom.layouts.programs import KernelCall, Run, TreeCall
from carom.layouts.records import At, Double, Int32, Int64, Object, Read, c_record

SURFACE_COUNT, OF_BODY_COUNT = len(SURFACE), len(OF_BODY)


@c_record()
class ContactQuery:
    """Numbers among the arguments of the kernel that lists contacts, by their names there."""

    count: At[Int32]
    body_a: At[Int32]
    link_a: At[Int32]
    body_b: At[Int32]
    link_b: At[Int32]
    time_step: At[Double]


@c_record()
class ContactColumns:
    """Results of the kernel that lists contacts: fields of `ContactReport` without their axis."""

    count: Read[Int32]
    body_a: Read[Int32]
    body_b: Read[Int32]
    link_a: Read[Int32]
    link_b: Read[Int32]
    point_a: Read[Double]
    point_b: Read[Double]
    normal: Read[Double]
    distance: Read[Double]
    force: Read[Double]
    force1: Read[Double]
    force2: Read[Double]
    direction1: Read[Double]
    direction2: Read[Double]


@c_record()
class ContactLister:
    """The kernel that lists contacts, its query and its results.

    Attributes:
        there: Number of contacts in the world.
        room: Number of contacts that fit into the results.
    """

    call: KernelCall
    asked: ContactQuery
    there: Read[Int32]
    room: Int64
    found: ContactColumns


@c_record()
class Detection:
    """Collision detection at the current coordinates of all bodies.

    Attributes:
        run: Null if the other fields are not filled.
        find_poses: Computes the poses of all links.
        poses: Poses of all links.
        poses_before: Where they are kept meanwhile; they are restored afterwards.
        pose_count: How many numbers these are.
        status: Not 0 if nothing was done, because arrays are too short.
    """

    run: At[Run]
    find_poses: KernelCall
    poses: At[Double]
    poses_before: At[Double]
    pose_count: Int64
    status: Read[Int32]


@c_record()
class Placement:
    """The shapes of all links, and the kernels that place them at the current coordinates.

    Attributes:
        place: Null if the other fields are not filled.
        find_poses: Computes the poses of all links.
        positions: Of all bodies.
        placed_at: These positions when shapes were placed last.
        position_count: How many numbers these are.
        poses: Poses of all links.
        poses_before: Where they are kept meanwhile; they are restored afterwards.
        pose_count: How many numbers these are.
        readiness: Less than `contacts.PLACED` if shapes have been placed elsewhere since.
        shapes: An object whose attribute counts changes of shapes.
        changes_name: The name of this attribute.
        changes: This count when shapes were placed last; -1 if they have not been.
        lower: Bounds of each shape.
        upper: Bounds of each shape.
        kind: Kind of each shape.
        path: Where each shape is in the tree of its compound.
        link: Row of the link of each shape.
        shape_count: Number of shapes.
        first_shape: By row of link, its first shape.
        link_shapes: By row of link, the number of its shapes.
        place_body: By row of link, the number of its body.
        place_link: By row of link, its index in the body.
        has_bare_links: There are links without shapes.
    """

    place: KernelCall
    find_poses: KernelCall
    positions: Read[Double]
    placed_at: At[Double]
    position_count: Int64
    poses: At[Double]
    poses_before: At[Double]
    pose_count: Int64
    readiness: Read[Int32]
    shapes: Object
    changes_name: Object
    changes: Int64
    lower: Read[Double]
    upper: Read[Double]
    kind: Read[Int32]
    path: Read[Int32]
    link: Read[Int32]
    shape_count: Int64
    first_shape: Read[Int32]
    link_shapes: Read[Int32]
    place_body: Read[Int32]
    place_link: Read[Int32]
    has_bare_links: Int64


@c_record()
class PairSearch:
    """The kernel that finds nearest points, its query, and the arrays of its results.

    Attributes:
        search: The kernel.
        count: Number of pairs of shapes, among the kernel's arguments.
        max_distance: Greatest distance [m], among the kernel's arguments.
        first: First shapes of the pairs.
        second: Second shapes of the pairs.
        room: Number of pairs that fit.
        found: Number of points found.
        pairs: The pair of each point.
        points: The points.
    """

    search: KernelCall
    count: At[Int32]
    max_distance: At[Double]
    first: At[Int32]
    second: At[Int32]
    room: Int64
    found: Read[Int32]
    pairs: Read[Int32]
    points: Read[Candidate]


@c_record()
class Step:
    """A step of the world.

    Attributes:
        run: Null if Python has to perform steps.
        status: The status of the world; not 0 if the step failed.
        observers: The list of objects that Python tells of steps.
        contact_count: Number of contacts, in a world of few links; null in others.
        substeps: Number of substeps in a step.
        is_long: 1: it may take so long that handlers of signals should not have to wait for its end.
        was_broken_off: 1: the last one was broken off for handlers, which are to be called before the next.
    """

    run: At[Run]
    status: At[Int32]
    observers: Object
    contact_count: Read[Int32]
    substeps: Int32
    is_long: Int32
    was_broken_off: Int32


@c_record(surface=SURFACE_COUNT, surface_names=SURFACE_COUNT, of_body=OF_BODY_COUNT)
class Scene:
    """Data derived from the bodies and arrays of a world; functions are null if their data are missing.

    Attributes:
        find_poses: Computes the link poses of a tree.
        find_twists: Computes the link velocities of a tree.
        position: Position coordinates of all bodies; known with `find_poses`.
        velocity: Velocity coordinates of all bodies.
        contact_count: Columns of `State.count_contacts` of the world.
        contact_warm_starts: Counters of warm starting, one for each contact.
        contact_room: Number of contacts that fit.
        tree_resets: By row of tree, see `note_reset`.
        surface: By row of shape: contact parameters, in the order of `SURFACE`.
        node_friction: By row of link: lateral friction once more, for nodes of soft bodies.
        surface_first: By row of link: its first shape.
        surface_shapes: By row of link: the number of its shapes.
        surface_names: Names of the attributes of `LinkDynamics`.
        of_body: By row of tree: damping and maximum velocity, in the order of `OF_BODY`.
        mass: By row of link.
        inertia: By row of link, three numbers.
        mass_name: Name of the attribute of `LinkDynamics`.
        inertia_name: Name of the attribute of `LinkDynamics`.
        fixed_base_name: Name of the attribute of `Body`.
    """

    find_poses: TreeCall
    find_twists: TreeCall
    position: At[Double]
    velocity: At[Double]
    contact_count: At[Int32]
    contact_warm_starts: At[Double]
    contact_room: Int64
    tree_resets: At[Int32]
    surface: At[Double]
    node_friction: At[Double]
    surface_first: Read[Int32]
    surface_shapes: Read[Int32]
    surface_names: Object
    of_body: At[Double]
    mass: At[Double]
    inertia: At[Double]
    mass_name: Object
    inertia_name: Object
    fixed_base_name: Object
    report: ContactLister
    detection: Detection
    placement: Placement
    nearest: PairSearch
    step: Step
