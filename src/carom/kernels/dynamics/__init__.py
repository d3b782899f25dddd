"""Dynamics of articulated bodies: kinematics, inertia, forces, motors, limits, integration."""
