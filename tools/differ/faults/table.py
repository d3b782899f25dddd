"""All faults, those first that once went unseen."""

from __future__ import annotations

from tools.differ.faults import answers, motion
from tools.differ.faults.spoiling import Fault

_FIRST = 7
FAULTS: dict[str, Fault] = {
    fault.name: fault for fault in (*answers.FAULTS[:_FIRST], *motion.FAULTS, *answers.FAULTS[_FIRST:])
}
"""By name."""
assert len(FAULTS) == len(answers.FAULTS) + len(motion.FAULTS)
