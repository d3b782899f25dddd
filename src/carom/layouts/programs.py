"""Kernels as native code calls them: steps of worlds as programs of them, and questions about bodies."""

from carom.layouts.gates import Gate
from carom.layouts.records import (
    Anything,
    At,
    Bytes,
    Double,
    Int32,
    Int64,
    KernelFunction,
    Object,
    Read,
    c_record,
)

# More launches than in any program, and the number of its parts.
MAX_LAUNCHES = 48
PROGRAM_PARTS = 5
# Worlds that move at once.
LANES = 4
# Lists of numbers in a question about a body, at most.
MAX_PARTS = 6
# Numbers from one counter to the next: threads that count in the same cache line wait for each other.
COUNTER_STRIDE = 16
# Columns of what a world says of the rows that it has written and not relaxed: the root of their island, or
# -1 if there are none; number of rows over one tree, of those over two and of blocks of these, of visits; and
# of the sweeps that were made.
WAITING_ROOT, WAITING_ROWS, WAITING_PAIR_ROWS, WAITING_BLOCKS, WAITING_VISITS, WAITING_SWEEPS = range(6)
# After each of so many sweeps, the first ones, rows that have settled are left out of those that follow. The
# second corrects what the first has rounded.
SETTLING_SWEEPS = 2


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
class ShareCall:
    """A kernel as one of several threads performs its shares.

    Attributes:
        call: The kernel.
        first_world: The world, among its arguments.
        status: The status of the world: that of the first thread is the world's, and gets those of others.
    """

    call: KernelCall
    first_world: At[Int32]
    status: At[Int32]


@c_record(room=COUNTER_STRIDE)
class Helper:
    """A thread that performs shares for a `Team`; see `native/source/team.cpp`.

    Attributes:
        team: Its team.
        begin: A lock that it waits for, until there are shares.
        ended: A lock that is free when it has ended.
        waits: 1 while it waits.
        number: Which of the threads it is; the one that takes the step is number 0.
        part: The last launch that it has performed shares of.
        room: Others are in other cache lines.
    """

    team: Anything
    begin: Anything
    ended: Anything
    waits: Int32
    number: Int32
    part: Int32
    room: Int32


@c_record()
class Team:
    """Threads that perform shares of the launches of a lone world.

    Attributes:
        helpers: All but the one that takes the step.
        helper_count: How many there are.
        begun: How many have begun.
        process: The process in which they have, by `carom_forks` + 1; 0 before.
        over: 1 when they are to end.
        calls: The present launch, once for each thread.
        taken: How many of its shares have been taken.
        done: A lock that the thread that takes the step waits for, until helpers are done.
        waits: 1 while it waits.
        part: Number of the last launch.
        open: The same while its shares may be taken, else 0.
        inside: How many helpers are performing shares, or look whether there are any.
    """

    helpers: At[Helper]
    helper_count: Int32
    begun: Int32
    process: Int32
    over: Int32
    calls: Read[ShareCall]
    taken: At[Int32]
    done: Anything
    waits: Int32
    part: Int32
    open: Int32
    inside: Int32


@c_record()
class Shares:
    """A launch whose shares several threads perform.

    Attributes:
        team: The threads.
        calls: The kernel, for each of them.
        amount: A number that tells how much there is to do, as of contacts.
        fewest: If it is less than this, one thread performs all.
    """

    team: At[Team]
    calls: Read[ShareCall]
    amount: Read[Int32]
    fewest: Int32


@c_record()
class WorldCall:
    """A kernel that is run for one world, with two numbers among its arguments; null if it has none such.

    Attributes:
        call: The kernel.
        first_world: The world.
        substeps: Number of substeps.
        shares: The same kernel for several threads; null if one performs it.
    """

    call: KernelCall
    first_world: At[Int32]
    substeps: At[Int32]
    shares: Read[Shares]


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


@c_record(lone=LANES)
class LaneRows:
    """Numbers in rows of the arrays of single worlds, and the same of several worlds side by side.

    Attributes:
        lone: For each lane: the first number of the first world that it can have.
        world_stride: Bytes from one world to the next; 0 in workspaces, of which each lane has its own.
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
class LaneWorld:
    """The step of a world in a lane, which has a workspace of its own.

    Attributes:
        program: Its launches; `continued_motion_kernel` takes what was found out about free motion.
        solve: What solves the rows if they cannot be relaxed together with those of other worlds.
        keep: What stores the impulses of rows that were.
        waiting: What its rows are, in `WAITING_ROOT`...
        residual: The last residual of its sweeps.
        row_numbers: The beginnings of its rows over one tree.
        row_places: The same of places of rows over two trees, four numbers each.
        row_starts: Where their Jacobians begin.
        visits: The order of all rows.
    """

    program: Program
    solve: WorldCall
    keep: WorldCall
    waiting: At[Int32]
    residual: At[Double]
    row_numbers: Bytes
    row_places: Read[Int32]
    row_starts: Read[Int32]
    visits: Read[Int32]


@c_record()
class LaneSweeps:
    """Sweeps over the rows of `LANES` worlds at once.

    Attributes:
        row: The numbers of rows over one tree, from the requested change on.
        row_impulse: Their impulses alone.
        share: See `Scratch.row_share`.
        softness: See `Scratch.row_softness`.
        response: Blocks of `Scratch.block_response`.
        delta: Blocks of `Scratch.delta_velocity`.
        terms: Rows over two trees.
        term_impulse: Their impulses alone.
        jacobian: Blocks of `PairRows.jacobian_row`.
        jacobian_response: Blocks of `PairRows.jacobian_response`.
        sweep: One sweep.
        visits: Its number of visits.
        number: Its number.
        residuals: Its residual in each lane.
        order: The order of all rows in lanes; negative numbers are those of `PairRows.visit_row`.
        slots: For each row over one tree in lanes: which row it is in each world, -1 for none.
        slot_count: Number of these for which there is room.
        row_numbers: The beginnings of rows over one tree in lanes.
        row_stride: Bytes from one such row to the next.
        wide_row_stride: The same in lanes.
        iterations: The greatest number of sweeps.
        inner_iterations: Sweeps over joint rows in each; more than one are made one world at a time.
        threshold: The residual that ends the sweeps.
        begun: How many sweeps have been made.
    """

    row: LaneRows
    row_impulse: LaneRows
    share: LaneRows
    softness: LaneRows
    response: LaneRows
    delta: LaneRows
    terms: LaneRows
    term_impulse: LaneRows
    jacobian: LaneRows
    jacobian_response: LaneRows
    sweep: KernelCall
    visits: At[Int32]
    number: At[Int32]
    residuals: Read[Double]
    order: At[Int32]
    slots: At[Int32]
    slot_count: Int64
    row_numbers: Bytes
    row_stride: Int64
    wide_row_stride: Int64
    iterations: Read[Int32]
    inner_iterations: Read[Int32]
    threshold: Read[Double]
    begun: At[Int64]


@c_record(worlds=LANES)
class LaneMotion:
    """Steps of `LANES` worlds at once.

    Attributes:
        gathered: What their free motion is computed from.
        scattered: Its results, which each world takes in its step.
        gathered_count: Number of entries of `gathered`.
        scattered_count: The same of `scattered`.
        joint_terms: For each tree and lane: whether it has joint terms. All lanes have to be alike.
        tree_count: Number of trees.
        steps_begun: How many steps of `LANES` worlds have begun so.
        motion: The kernel.
        worlds: The steps of single worlds.
        solving: The number of launches of such a step before its rows are relaxed.
        sweeps: Sweeps over the rows of all.
    """

    gathered: Read[LaneRows]
    scattered: Read[LaneRows]
    gathered_count: Int32
    scattered_count: Int32
    joint_terms: Read[Double]
    tree_count: Int64
    steps_begun: At[Int64]
    motion: KernelCall
    worlds: LaneWorld
    solving: Int64
    sweeps: LaneSweeps


@c_record()
class Run:
    """Steps of worlds that are to be performed.

    Attributes:
        program: The launches.
        worlds: Indices of the worlds.
        due: Substeps of each step; if it is 0, contacts are found and nothing moves.
        counters: For each thread, `COUNTER_STRIDE` numbers apart: how many worlds of its share have been
            taken by any thread. Null for one thread.
        world_count: Number of worlds.
        step_count: Number of steps.
        chunk: Number of worlds that a thread takes at a time.
        threads: Number of threads that run at once.
        thread: Which of them this is.
        resumed: 1: continue after the steps that each world has already done.
        first_substep: If it is not 0, the step has already begun.
        end_substep: The step is ended only after its last substep.
        lanes: Free motion of several worlds at once; null if worlds move one at a time.
        times: Simulated time of each world [s], which goes on with each step that goes well; null if nobody
            asks for it.
        unspent_times: The part of it that substeps have not covered yet [s].
        unspent_after: The same of a world after each step; null if it stays as it is.
        watch: A `Watch` of signals, for which a long step is broken off between two launches; null without.
        duration: Of a step [s].
        repeatable: 1: a step that fails is undone completely, whatever the reason, for another attempt.
    """

    program: Read[Program]
    worlds: Read[Int32]
    due: Read[Int32]
    counters: At[Int32]
    lanes: Read[LaneMotion]
    times: At[Double]
    unspent_times: At[Double]
    unspent_after: Read[Double]
    watch: Anything
    duration: Double
    world_count: Int32
    step_count: Int32
    chunk: Int32
    threads: Int32
    thread: Int32
    resumed: Int32
    first_substep: Int32
    end_substep: Int32
    repeatable: Int32


@c_record()
class QuestionPart:
    """A list of numbers in a question.

    Attributes:
        numbers: Where they go.
        count: How many they are.
        is_required: They are not 0 if they are left out.
    """

    numbers: At[Double]
    count: Int64
    is_required: Int64


@c_record(parts=MAX_PARTS)
class Question:
    """A question and its answer.

    Attributes:
        gate: The lock of the world.
        call: The kernel.
        parts: What is asked, a list for each argument of the builtin.
        part_count: How many there are.
        quaternion: Four numbers of these, which may not all be 0; null if there are none such.
        answer: The answer. Its first number is NaN if any is not finite.
        answer_count: How many numbers it has.
        makers: A tuple of functions without arguments that make the objects to return of the answer.
    """

    gate: At[Gate]
    call: KernelCall
    parts: QuestionPart
    part_count: Int64
    quaternion: At[Double]
    answer: At[Double]
    answer_count: Int64
    makers: Object
