"""The world: loading, steps, states, logs."""
