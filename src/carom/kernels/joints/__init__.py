"""The motion of joints: each type, once for each of the tables that trees have."""
