"""Identification: parameters of a robot from measurements of its motion, by least squares."""

from carom.identification.excitation import ExcitingTrajectory, exciting_trajectory
from carom.identification.identify import identify
from carom.identification.mcap_file import read_mcap
from carom.identification.measurements import Measurements
from carom.identification.result import Combination, IdentificationResult

__all__ = [
    "Combination",
    "ExcitingTrajectory",
    "IdentificationResult",
    "Measurements",
    "exciting_trajectory",
    "identify",
    "read_mcap",
]
