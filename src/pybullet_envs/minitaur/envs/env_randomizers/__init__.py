"""What makes Minitaurs differ, pushes them, and puts blocks in their way."""
