"""What a world offers beside its bodies: questions, controls and sensors as vectors, and its start."""
