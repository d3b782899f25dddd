"""Kernels as native code calls them, and steps of worlds as programs of them."""

from carom.layouts.records import Anything, At, Bytes, Double, Int32, Int64, KernelFunction, Read, c_record

# More launches than in any program, and the number of its parts.
MAX_LAUNCHES = 32
PROGRAM_PARTS = 5
# Worlds that move at once.
LANES = 4


@c_record()
class KernelCall:
    """A kernel, its bounds and its arguments."""

    function: KernelFunction
    bounds: Anything
    arguments: Anything


@c_record()
class TreeCall:
    """A kernel that is run for one tree, which is among its arguments."""

    call: KernelCall
    tree: At[Int32]


@c_record()
class WorldCall:
    """A kernel that is run for one world, with two numbers among its arguments; null if it has none such."""

    call: KernelCall
    first_world: At[Int32]
    substeps: At[Int32]


@c_record(part_ends=PROGRAM_PARTS, launches=MAX_LAUNCHES)
class Program:
    """The launches of a step.

    Attributes:
        status: The status of the first world.
        status_stride: Bytes from one world's status to the next.
        part_ends: Where each part ends in the list of launches: beginning, detection of collisions, motion,
            end, and what follows a step that failed.
        launches: All launches, part by part.
    """

    status: Bytes
    status_stride: Int64
    part_ends: Int64
    launches: WorldCall


@c_record()
class LaneRows:
    """Numbers in rows of the arrays of single worlds, and the same of several worlds side by side.

    Attributes:
        lone: The first number of the first world.
        world_stride: Bytes from one world to the next.
        row_stride: Bytes from one row to the next.
        wide: The first number of all lanes.
        wide_stride: Bytes from one row of these to the next.
        rows: Number of rows.
        numbers: Numbers in each.
    """

    lone: Bytes
    world_stride: Int64
    row_stride: Int64
    wide: Bytes
    wide_stride: Int64
    rows: Int32
    numbers: Int32


@c_record()
class LaneMotion:
    """Free motion of `LANES` worlds at once.

    Attributes:
        gathered: What it is computed from.
        scattered: Its results, which each world takes in its step.
        gathered_count: Number of entries of `gathered`.
        scattered_count: The same of `scattered`.
        joint_terms: For each tree and lane: whether it has joint terms. All lanes have to be alike.
        tree_count: Number of trees.
        steps_begun: How many steps of `LANES` worlds have begun so.
        motion: The kernel.
        free_motion: The kernel of single worlds that computes their free motion from the beginning.
        continued: The launch in its place that continues with the results.
    """

    gathered: Read[LaneRows]
    scattered: Read[LaneRows]
    gathered_count: Int32
    scattered_count: Int32
    joint_terms: Read[Double]
    tree_count: Int64
    steps_begun: At[Int64]
    motion: KernelCall
    free_motion: KernelFunction
    continued: WorldCall


@c_record()
class Run:
    """Steps of worlds that are to be performed.

    Attributes:
        program: The launches.
        worlds: Indices of the worlds.
        due: Substeps of each step; if it is 0, contacts are found and nothing moves.
        counter: Index in `worlds` of the next chunk, shared by all threads; null for one thread.
        world_count: Number of worlds.
        step_count: Number of steps.
        chunk: Number of worlds that a thread takes at a time.
        resumed: 1: continue after the steps that each world has already done.
        first_substep: If it is not 0, the step has already begun.
        end_substep: The step is ended only after its last substep.
        lanes: Free motion of several worlds at once; null if worlds move one at a time.
        repeatable: 1: a step that fails is undone completely, whatever the reason, for another attempt.
    """

    program: Read[Program]
    worlds: Read[Int32]
    due: Read[Int32]
    counter: At[Int32]
    lanes: Read[LaneMotion]
    world_count: Int32
    step_count: Int32
    chunk: Int32
    resumed: Int32
    first_substep: Int32
    end_substep: Int32
    repeatable: Int32
