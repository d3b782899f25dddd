"""The hold of pages on the steps of a world: pausing, slowing, going back, and what waits between steps."""
