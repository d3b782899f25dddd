"""The face of the modern API: its names, in one world and in many, and what they do."""
