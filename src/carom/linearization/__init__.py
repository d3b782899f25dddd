"""Linearisation of steps: derivatives of a world's next state by its state, its controls and parameters."""

from carom.linearization.linearized_step import LinearizedStep

__all__ = ["LinearizedStep"]
