"""`<flexcomp>`: cables, cloth and solids of nodes that move freely."""
