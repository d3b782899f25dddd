"""The parts of a world: bodies, joints, links, motors, constraints, and changes of these."""
