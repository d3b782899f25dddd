"""Camera images."""
