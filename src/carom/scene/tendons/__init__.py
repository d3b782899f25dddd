"""Tendons of a body, as handles; how long they are, and what is made from them."""
