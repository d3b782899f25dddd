"""Integrators other than the usual one: MuJoCo's Euler, implicit and RK4, and the midpoint rule."""
