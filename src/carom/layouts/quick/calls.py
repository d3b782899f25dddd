"""Quick calls: what the library knows of their parameters and results."""

from carom.layouts.quick.bodies import Body, Client
from carom.layouts.records import Double, Int32, Int64, Kernel, Maker, Object, Read, c_record

MAX_CALLS = 192
MAX_PARAMETERS = 26
MAX_NUMBERS = 32
MAX_RESULTS = 32
MAX_GROUPS = 8
MAX_SEQUENCES = 6

# How many numbers an argument of each kind is; sequences of any length are handed on as they are.
NUMBERS_OF_KIND = {"-": 0, "s": 0, "v": 0, "3": 3, "4": 4, "q": 4, "r": 1, "i": 1, "b": 1, "c": 1}


@c_record(sequences=MAX_SEQUENCES)
class Call:
    """A call of a kernel: what it is about, besides numbers.

    Attributes:
        client: The connection; null if the function names none.
        body: The body; likewise.
        sequences: Arguments of any length (lists, tuples, ranges and arrays); null for those left out.
    """

    client: Read[Client]
    body: Read[Body]
    sequences: Object


@c_record()
class Parameter:
    """A parameter of a quick call.

    Attributes:
        name: Its name, interned.
        missing: The default of each of its numbers; NaN for None.
        kind: A letter, see `carom.native.quick_calls.Parameter`.
        is_required: It has no default.
    """

    name: Object
    missing: Double
    kind: Int32
    is_required: Int32


@c_record(parameters=MAX_PARAMETERS, groups=MAX_GROUPS + 1)
class QuickCall:
    """A quick call.

    Attributes:
        kernel: Returns numbers.
        maker: Returns an object, and is used instead of a kernel if it is not null.
        parameter_count: Number of its parameters.
        parameters: Its parameters.
        groups: Lengths of the groups of results, 0 for a number alone, and -1 after the last one.
        is_flat: There is one group, and it is the result.
    """

    kernel: Kernel
    maker: Maker
    parameter_count: Int64
    parameters: Parameter
    groups: Int32
    is_flat: Int32
