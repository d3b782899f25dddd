"""Kinds of actions, and files of recorded motions."""
