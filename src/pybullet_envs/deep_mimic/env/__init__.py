"""Types of action spaces, and files of recorded motions."""
