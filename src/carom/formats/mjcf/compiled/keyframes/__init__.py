"""`<keyframe>`: named states, those of attached models included."""
