"""What parts of a body have in one world, with plain numbers, and in many, with arrays over the worlds."""
