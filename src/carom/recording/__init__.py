"""Videos of a world: pictures of its steps, written to a file."""
