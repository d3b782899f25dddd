"""Sites and sensors of bodies: what they measure, computed for one world or many at once."""
