"""Contacts, welds and controllers of MJCF files beside answers of MuJoCo."""
