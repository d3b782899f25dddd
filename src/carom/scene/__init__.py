"""What a world consists of: bodies, joints, links, motors, constraints, and changes of these."""
