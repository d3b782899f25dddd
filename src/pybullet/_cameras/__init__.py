"""Camera images and films."""
