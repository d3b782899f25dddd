"""What pages are told about how things look: shapes, and lights, sky and cameras of files."""
