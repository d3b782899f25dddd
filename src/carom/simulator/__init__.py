"""The simulator of `python -m carom view`: files in the browser, simulated without a script."""
