"""An xArm over a tray (`xarm_sim`)."""
