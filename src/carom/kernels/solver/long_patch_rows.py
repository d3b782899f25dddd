"""Writing the rows of patches of trees of any size; see `long_patches`."""

from carom.kernels.maths.blocks import combine4, combine8, fill_zero
from carom.kernels.solver.couplings import write_jacobians
from carom.kernels.solver.long_patches import RUN_PER_BLOCK, run_parts
from carom.kernels.solver.patch_rows import row_direction, write_row_numbers
from carom.kernels.structs import ContactTerms, Couplings, Model, Scratch, Settings, Shapes, State
from carom.kernels.types import Index4, Int32, func, real


@func
def clear_run(couplings: Couplings, world: Int32, patch: Int32):
    """Set the matrices of a patch to zero."""
    place = couplings.patch[world, patch].place
    fill_zero(
        couplings.run_block, couplings.patch[world, patch].run, world, RUN_PER_BLOCK * (place[1] + place[3])
    )


@func
def write_normal_matrices(
    couplings: Couplings, world: Int32, part: Index4, blocks: Int32, contact: Int32, mass: real, start: Int32
):
    """Write the weighted Jacobian and the response of a normal row, which are at block `start`."""
    block = Int32(0)
    while block < blocks:
        jacobian = couplings.jacobian_row[world, start + block]
        for i in range(4):
            entry = 4 * (part[0] + 4 * block + i) + contact
            couplings.entry_run[world, entry] = mass * jacobian[i]
        response = couplings.jacobian_response[world, start + block]
        couplings.run_block[world, part[2] + 4 * block + contact] = response
        block += 1


@func
def write_friction_matrices(
    couplings: Couplings, world: Int32, part: Index4, blocks: Int32, row: Int32, mass: real, start: Int32
):
    """As `write_normal_matrices`, for friction row `row` of eight."""
    block = Int32(0)
    while block < blocks:
        jacobian = couplings.jacobian_row[world, start + block]
        for i in range(4):
            entry = 4 * (part[1] + 8 * block + 2 * i) + row
            couplings.entry_run[world, entry] = mass * jacobian[i]
        response = couplings.jacobian_response[world, start + block]
        couplings.run_block[world, part[3] + 8 * block + row] = response
        block += 1


@func
def write_normal_gains(
    couplings: Couplings, world: Int32, patch: Int32, contact: Int32, mass: real, start: Int32
):
    """Write by how much the normal rows before this, of effective mass `mass`, lower its impulse wanted.

    The response to this row says by how much it lowers theirs; masses tell the two apart.
    """
    place = couplings.patch[world, patch].place
    part = run_parts(couplings.patch[world, patch].run, place)
    lowered = couplings.patch[world, patch].normal_share * real(0.0)
    if place[1] > 0:
        lowered += combine4(couplings.run_block, part[0], couplings.jacobian_response, start, world, place[1])
    if place[3] > 0:
        lowered += combine4(
            couplings.run_block, part[0] + 4 * place[1], couplings.jacobian_response, start + place[1],
            world, place[3],
        )  # fmt: skip
    for i in range(4):
        inverse_mass = couplings.patch[world, patch].normal_inverse_mass[i]
        couplings.patch[world, patch].normal_gain[i, contact] = lowered[i] * inverse_mass * mass


@func
def write_friction_gains(
    couplings: Couplings, world: Int32, patch: Int32, row: Int32, mass: real, start: Int32
):
    """As `write_normal_gains`, for friction row `row` of eight."""
    place = couplings.patch[world, patch].place
    part = run_parts(couplings.patch[world, patch].run, place)
    lowered = couplings.patch[world, patch].friction_share * real(0.0)
    if place[1] > 0:
        lowered += combine8(couplings.run_block, part[1], couplings.jacobian_response, start, world, place[1])
    if place[3] > 0:
        lowered += combine8(
            couplings.run_block, part[1] + 8 * place[1], couplings.jacobian_response, start + place[1],
            world, place[3],
        )  # fmt: skip
    for i in range(8):
        inverse_mass = couplings.patch[world, patch].friction_inverse_mass[i]
        couplings.patch[world, patch].friction_gain[i, row] = lowered[i] * inverse_mass * mass


@func
def write_long_contact(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    couplings: Couplings,
    terms: ContactTerms,
    world: Int32,
    patch: Int32,
    contact: Int32,
    start: Int32,
):
    """Write the three rows of a contact; blocks of rows over two trees from `start` on are free."""
    place = couplings.patch[world, patch].place
    part_a = run_parts(couplings.patch[world, patch].run, place)
    part_b = part_a + Index4(4 * place[1], 8 * place[1], 4 * place[1], 8 * place[1])
    start_b = start + place[1]
    row = Int32(0)
    while row < 3:
        direction = row_direction(terms, row)
        moved = write_jacobians(
            model, state, scratch, couplings, world, terms.ends, terms.point_a, terms.point_b, direction,
            0.0 * direction, start,
        )  # fmt: skip
        mass = write_row_numbers(
            settings, shapes, couplings, terms, world, patch, contact, row, moved[1], moved[0]
        )
        if row == 0:
            write_normal_matrices(couplings, world, part_a, place[1], contact, mass, start)
            write_normal_matrices(couplings, world, part_b, place[3], contact, mass, start_b)
            write_normal_gains(couplings, world, patch, contact, mass, start)
        else:
            line = 2 * contact + row - 1
            write_friction_matrices(couplings, world, part_a, place[1], line, mass, start)
            write_friction_matrices(couplings, world, part_b, place[3], line, mass, start_b)
            write_friction_gains(couplings, world, patch, line, mass, start)
        row += 1
