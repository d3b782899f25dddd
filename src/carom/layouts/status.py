"""What `State.status_entry` says of a world."""

# Columns: what became of the last step; how many pairs of shapes and contacts there would have been, if
# they did not fit; how many steps of the present run are done.
STATUS, PAIRS_WANTED, CONTACTS_WANTED, STEPS_DONE = 0, 1, 2, 3

# Values of the first column, besides 1 + the tree whose velocities were not finite: all is well; pairs,
# contacts or rows did not fit; the world has no part in what is being done, where all are launched together.
WELL, OVERFLOW, LEFT_OUT = 0, -1, -2
