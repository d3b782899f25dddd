"""Bodies and links: poses, velocities, masses, forces, user data."""
