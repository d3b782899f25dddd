"""Motion of trees of links: kinematics, inertia, forces, motors, integration."""
