"""Random numbers that are the same in every run."""

from __future__ import annotations

import random
import sys

import numpy as np


def set_global_seeds(seed: int) -> None:
    """Seeds Python's and NumPy's random numbers, and TensorFlow's where it has been imported."""
    tensorflow = sys.modules.get("tensorflow")
    if tensorflow is not None:
        tensorflow.random.set_seed(seed)
    np.random.seed(seed)
    random.seed(seed)
