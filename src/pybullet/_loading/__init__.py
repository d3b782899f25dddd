"""Bodies from files and from shapes, and scenes as scripts."""
