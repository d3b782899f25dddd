"""The past of a run, kept by the process that simulates, and sent to pages that join."""
