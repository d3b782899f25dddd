"""Columns and values of `State.status_entry`, the status of a world."""

# Columns: result of the last step; numbers of pairs of shapes and of contacts that it would have needed, if
# they did not fit; number of steps done in the present run.
STATUS, PAIRS_WANTED, CONTACTS_WANTED, STEPS_DONE = 0, 1, 2, 3

# Values of the first column: success; pairs, contacts or rows did not fit; the world is left out of launches
# over all worlds. Positive values are 1 + the first tree whose velocities were not finite.
WELL, OVERFLOW, LEFT_OUT = 0, -1, -2
