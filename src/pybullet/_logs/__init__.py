"""Logs of states, contacts and commands."""
