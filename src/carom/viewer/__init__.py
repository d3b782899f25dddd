"""The viewer: a page in the browser that shows a world as it moves, and whose controls a script can read."""
