"""From files to descriptions. Knows no physics."""
