"""Trees whose links have late velocities: those loaded with `URDF_GLOBAL_VELOCITIES_MB`."""
