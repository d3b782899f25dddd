"""A contact solver that converges, for worlds whose contacts are rigid; see docs/solver.md."""
