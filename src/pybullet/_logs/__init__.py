"""Logs of states, commands and timings, and videos."""
