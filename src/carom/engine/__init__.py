"""The engine: tables, workspaces and launches; performs the steps of any number of worlds."""
