"""The data of one connection: its world, its registries, its clock, files of logs."""
