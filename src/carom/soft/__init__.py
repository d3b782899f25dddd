"""What soft bodies are made of: cloths, ropes and solids from meshes or from numbers."""
