"""The engine performs the steps of any number of worlds: tables, workspaces and launches."""
