"""The stateful fuzzer of the API: `python -m tests.fuzz.api --operations 1000000 --seed 1`.

It makes random calls in one world, many with arguments that are hard to take, and sees after them that what
has to hold does (`invariants.py`). Where something does not, it prints the latest calls and how to repeat the
run.
"""

from __future__ import annotations

import argparse
import faulthandler
import os
import sys
import tempfile
from collections import Counter, deque
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from random import Random
from time import process_time

from tests.fuzz.invariants import Broken, Fingerprint, check_finite, check_states
from tests.fuzz.memory import check_memory
from tests.fuzz.operations import Operation, operations
from tests.surface.perform import Places
from tests.surface.scene import build

import pybullet as p
import pybullet_data
from pybullet._clients.clients import clients

LONGEST = 5.0
"""A call may take so long [s]: time of the processor, of which a busy machine gives less."""
ALLOWED = (p.error, TypeError, OverflowError)
"""`pybullet.error`, and what Python raises for arguments of another type and integers that are too large."""
_SHOWN = 40
_SCENE_LASTS = 1000
_MAX_BODIES = 40
_MAX_SUBSTEPS, _MAX_SWEEPS = 100, 1000


class Fuzzer:
    """One run.

    Args:
        seed: Decides about everything.
        folder: An empty folder, in which all files are written.
    """

    def __init__(self, seed: int, folder: Path) -> None:
        self.random = Random(seed)
        self.latest: deque[str] = deque(maxlen=_SHOWN)
        self.outcomes: Counter[str] = Counter()
        self.slowest = (0.0, "")
        self._bodies: list[int] = []
        self._operations = operations(self.random, Places(str(folder)), self._bodies)

    def run(self, count: int) -> None:
        """Makes so many calls; raises `Broken` at the first thing that is not as it has to be."""
        for number in range(count):
            if number % _SCENE_LASTS == 0 or p.getNumBodies() > _MAX_BODIES:
                self._begin()
            self._bodies[:] = [p.getBodyUniqueId(place) for place in range(p.getNumBodies())]
            self._perform(next(self._operations))
            _lighten()
            if number % 100 == 99:
                check_finite()
            if number % 250 == 249:
                check_states()
        check_memory()

    def _begin(self) -> None:
        # A process may have so many files open; videos and logs would use them up in a million calls.
        clients[0].logs.stop_all(clients[0].world)
        p.resetSimulation()
        p.setPhysicsEngineParameter(fixedTimeStep=1 / 240, numSubSteps=0)
        p.setAdditionalSearchPath(pybullet_data.getDataPath())
        build(p)

    def _perform(self, operation: Operation) -> None:
        self.latest.append(str(operation))
        before = Fingerprint() if self.random.random() < 0.3 else None
        start = process_time()
        try:
            getattr(p, operation.function)(*operation.arguments, **operation.keywords)
            self.outcomes["done"] += 1
        except ALLOWED as problem:
            self.outcomes[type(problem).__name__] += 1
            if before is not None:
                before.check(Fingerprint(), but=_DROPPED if operation.function == "stepSimulation" else ())
        except Exception as problem:
            raise Broken(f"{type(problem).__name__}: {problem}") from problem
        seconds = process_time() - start
        self.slowest = max(self.slowest, (seconds, str(operation)))
        if seconds > LONGEST:
            raise Broken(f"it took {seconds:.1f} s, with {clients[0].world.parameters}")


def _lighten() -> None:
    """Take back parameters with which a step takes seconds, or a million operations would take weeks."""
    parameters = clients[0].world.parameters
    sweeps = parameters.solver_iterations * parameters.noncontact_inner_iterations
    if parameters.substeps > _MAX_SUBSTEPS or sweeps > _MAX_SWEEPS:
        p.setPhysicsEngineParameter(numSubSteps=0, numSolverIterations=50, numNonContactInnerIterations=1)


# A step that fails drops the forces and torques that were applied for it.
_DROPPED = ("link_wrench", "dof_torque", "node_force")


@contextmanager
def own_folder() -> Iterator[Path]:
    """An empty folder, which is the working directory as long as the context lasts."""
    before = Path.cwd()
    with tempfile.TemporaryDirectory(prefix="carom-fuzz-") as name:
        os.chdir(name)
        try:
            yield Path(name)
        finally:
            os.chdir(before)


def fuzz(count: int, seed: int) -> Fuzzer:
    """Makes `count` calls in a connection of their own; raises `Broken`."""
    with own_folder() as folder:
        client = p.connect(p.DIRECT)
        assert client == 0, "the first connection of the process"
        fuzzer = Fuzzer(seed, folder)
        try:
            fuzzer.run(count)
        except BaseException:
            print("\n".join(fuzzer.latest), file=sys.stderr)
            raise
        finally:
            if p.isConnected(client):
                p.disconnect(client)
    return fuzzer


def main() -> None:
    """Does what the command line says."""
    parser = argparse.ArgumentParser(description="Random calls with arguments that are hard to take.")
    parser.add_argument("--operations", type=int, default=10_000)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args()
    faulthandler.enable()
    start = process_time()
    fuzzer = fuzz(asked.operations, asked.seed)
    seconds, operation = fuzzer.slowest
    print(f"{asked.operations} calls in {process_time() - start:.0f} s: {dict(fuzzer.outcomes)}")
    print(f"the slowest, {seconds:.2f} s: {operation[:200]}")


if __name__ == "__main__":
    main()
