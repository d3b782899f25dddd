"""Readers of robot and scene files, and a writer of URDF files; no physics."""
