"""Example robots of Carom: classes that simulate an arm with objects to grasp; scripts that show robots."""
