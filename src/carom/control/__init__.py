"""Controllers and reference trajectories for joints. Pure NumPy: no engine needed."""

from carom.control.pid import PID
from carom.control.trajectory import QuinticTrajectory, Sample, TrapezoidalTrajectory

__all__ = ["PID", "QuinticTrajectory", "Sample", "TrapezoidalTrajectory"]
