"""Some of many worlds in one window: side by side or in one place, one of them chosen."""
