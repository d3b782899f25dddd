"""How scenes look: materials, textures, lights and the sky."""
