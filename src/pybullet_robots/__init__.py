"""Example robots: classes that simulate an arm with objects to grasp, and scripts that show the robots."""
