"""Derivatives of steps of MuJoCo's integrators: Euler, implicitfast, implicit and RK4, on the host."""
