"""What a connection has at hand of its world's bodies: their state, boxes, joints and texts."""
