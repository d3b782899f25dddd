"""What belongs to one connection: its world, its registries, its clock."""
