"""Camera images and videos."""
