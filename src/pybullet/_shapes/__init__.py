"""Collision shapes, visual shapes, textures."""
