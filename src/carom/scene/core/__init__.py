"""What a world and a body are for everything below them: their data, and what they do by themselves."""
