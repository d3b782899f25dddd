"""Control of steps by pages: pausing, slow motion, going back, and tasks between steps."""
