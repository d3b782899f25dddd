"""Identification: parameters of a robot from measurements of its motion, by least squares."""

from carom.identification.identify import identify
from carom.identification.measurements import Measurements
from carom.identification.result import Combination, IdentificationResult

__all__ = ["Combination", "IdentificationResult", "Measurements", "identify"]
