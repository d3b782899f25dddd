"""What a short script does first: import, connect, load the Panda, step. Prints the import time."""

from __future__ import annotations

import sys
import time
from pathlib import Path

start = time.perf_counter()
import pybullet as p  # noqa: E402

seconds = time.perf_counter() - start

PANDA = Path(__file__).resolve().parents[1] / "src" / "pybullet_data" / "franka_panda" / "panda.urdf"
p.connect(p.DIRECT)
p.setGravity(0, 0, -9.81)
p.loadURDF(str(PANDA), useFixedBase=True)
p.stepSimulation()
sys.stdout.write(f"import {seconds}\n")
sys.stdout.flush()
