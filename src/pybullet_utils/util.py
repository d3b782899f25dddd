"""Seeds of random number generators."""

from __future__ import annotations

import random
import sys

import numpy as np


def set_global_seeds(seed: int) -> None:
    """Seeds the random numbers of Python and NumPy, and of TensorFlow if it has been imported."""
    tensorflow = sys.modules.get("tensorflow")
    if tensorflow is not None:
        tensorflow.random.set_seed(seed)
    np.random.seed(seed)
    random.seed(seed)
