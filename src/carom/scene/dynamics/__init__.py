"""Inertia, surfaces, joint terms and limits of links: where they are kept, and how they are changed."""
