"""Which shapes touch, and where: broad phase, narrow phase, persistent contacts, rays, distances."""
