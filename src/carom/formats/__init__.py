"""Readers of robot, scene and mesh files, and a writer of URDF files; no physics."""
