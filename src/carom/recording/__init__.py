"""Recording videos of a world while it is stepped."""
