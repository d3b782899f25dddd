"""Every function of the interface called in every way, with either module, and what comes of it."""
