"""Union-find: sets as trees, in an array that has the member above each; roots are above themselves."""

from carom.kernels.types import Int32, IntRows, func


@func
def find_root(above: IntRows, world: Int32, member: Int32) -> Int32:
    """Root of a member's set; compresses the path to it."""
    root = member + 0
    while above[world, root] != root:
        higher = above[world, root]
        above[world, root] = above[world, higher]
        root = above[world, root]
    return root
