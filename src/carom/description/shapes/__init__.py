"""The shapes a link can have, one file each: what a shape is to files, mass, contact, pictures and PyBullet.

Whoever needs something of a shape asks the shape: `Shape` lists what there is to ask, with answers for shapes
that have no better one. `carom.description.geometry` has all of them together.
"""
