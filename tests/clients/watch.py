"""Runs somebody's PyBullet script unmodified and writes down what happened.

    python watch.py record.json STEPS SECONDS script.py [argument ...]

Run by the Python whose `pybullet` is to be watched, Carom's or the real one: this file imports nothing of
either project. The script sees a clock that moves only as it sleeps, asks for the time or simulates, so that
two runs of it do the same things at the same steps; in real-time mode the clock steps the world. It ends
after its own last line, after STEPS steps of the simulation, or after SECONDS.
"""

from __future__ import annotations

import builtins
import contextlib
import json
import os
import random
import runpy
import signal
import sys
import time
import traceback
import types
from collections.abc import Callable
from typing import Any

# Steps at which the world is written down: all at first, every tenth later.
_DENSE = 20
_SPARSE = 10
# Seconds of the script's clock that a call takes.
_TICK = 1e-3
_LIBRARIES = frozenset({"carom", "pybullet", "warp"})


class Over(BaseException):
    """The script has had its steps or its time; no `except Exception` of its own catches this."""


class Wrapped:
    """A function in place of a builtin, which `inspect.isbuiltin` still takes for one."""

    __class__ = property(lambda self: types.BuiltinFunctionType)  # type: ignore[assignment]

    def __init__(self, function: Callable[..., Any]) -> None:
        self.function = function

    def __call__(self, *arguments: Any, **keywords: Any) -> Any:
        return self.function(*arguments, **keywords)


class Watch:
    """The clock, the worlds and the record of one run."""

    def __init__(self, bullet: Any, step_limit: int) -> None:
        self.bullet = bullet
        self.step_limit = step_limit
        self.step_count = 0
        self.clock = 1_000_000_000.0
        self.stepping = False
        self.real_time: dict[int, float] = {}
        self.states: list[tuple[int, list[list[float]]]] = []
        self.originals = {
            name: getattr(bullet, name)
            for name in (
                "connect",
                "stepSimulation",
                "setRealTimeSimulation",
                "disconnect",
                "resetSimulation",
            )
        }

    def install(self) -> None:
        """Puts the watch between the script and its world, its clock and its chance."""
        bullet = self.bullet
        bullet.connect = Wrapped(self._connect)
        bullet.stepSimulation = Wrapped(self._step)
        bullet.setRealTimeSimulation = Wrapped(self._set_real_time)
        for name in (
            "getKeyboardEvents",
            "getMouseEvents",
            "setGravity",
            "readUserDebugParameter",
            "getContactPoints",
        ):
            setattr(bullet, name, Wrapped(self._taking_time(getattr(bullet, name))))
        for module_name in ("time", "perf_counter", "monotonic", "process_time"):
            setattr(time, module_name, self._now)
        time.sleep = self._sleep
        builtins.input = lambda prompt="": ""
        random.seed(1)
        with contextlib.suppress(ImportError):
            import numpy

            numpy.random.seed(1)

    def _connect(self, mode: int, *arguments: Any, **keywords: Any) -> int:
        bullet = self.bullet
        if mode in (bullet.GUI, bullet.SHARED_MEMORY) and os.environ.get("WATCH_WITHOUT_WINDOWS"):
            return -1 if mode == bullet.SHARED_MEMORY else self.originals["connect"](bullet.DIRECT)
        return self.originals["connect"](mode, *arguments, **keywords)

    def _step(self, physicsClientId: int = 0) -> Any:
        self.stepping = True
        result = self.originals["stepSimulation"](physicsClientId=physicsClientId)
        self.stepping = False
        self.step_count += 1
        if self.step_count <= _DENSE or self.step_count % _SPARSE == 0:
            self.states.append((self.step_count, self._state(physicsClientId)))
        if self.step_count >= self.step_limit:
            raise Over
        return result

    def _state(self, client: int) -> list[list[float]]:
        """Of each body the base's position and orientation, then the joints' positions."""
        bullet = self.bullet
        state = []
        for row in range(min(bullet.getNumBodies(physicsClientId=client), 50)):
            body = bullet.getBodyUniqueId(row, physicsClientId=client)
            with contextlib.suppress(bullet.error):
                position, orientation = bullet.getBasePositionAndOrientation(body, physicsClientId=client)
                joints = range(bullet.getNumJoints(body, physicsClientId=client))
                angles = [bullet.getJointState(body, joint, physicsClientId=client)[0] for joint in joints]
                state.append([*position, *orientation, *angles])
        return state

    def _set_real_time(self, enableRealTimeSimulation: int, physicsClientId: int = 0) -> None:
        if enableRealTimeSimulation:
            self.real_time[physicsClientId] = self.clock
        else:
            self.real_time.pop(physicsClientId, None)

    def _now(self) -> float:
        # What the simulator itself asks for the time does not count.
        if sys._getframe(1).f_globals.get("__name__", "").partition(".")[0] not in _LIBRARIES:
            self._advance(_TICK)
        return self.clock

    def _sleep(self, seconds: float) -> None:
        self._advance(max(seconds, 0.0))

    def _taking_time(self, function: Callable[..., Any]) -> Callable[..., Any]:
        def call(*arguments: Any, **keywords: Any) -> Any:
            result = function(*arguments, **keywords)
            self._advance(_TICK)
            return result

        return call

    def _advance(self, seconds: float) -> None:
        if self.stepping:
            return
        self.clock += seconds
        for client, since in list(self.real_time.items()):
            while since + 1 / 240 <= self.clock:
                since += 1 / 240
                self.real_time[client] = since
                self._step(client)


def main() -> None:
    record_path, step_limit, seconds, script, *arguments = sys.argv[1:]
    data = os.environ.get("WATCH_DATA")
    if data:
        import pybullet_data

        pybullet_data.getDataPath = lambda: data
    import pybullet

    watch = Watch(pybullet, int(step_limit))
    real_clock = time.perf_counter
    watch.install()
    folder = os.path.dirname(os.path.abspath(script))
    sys.argv = [script, *arguments]
    sys.path[0] = folder

    def ring(signum: int, frame: object) -> None:
        raise Over

    signal.signal(signal.SIGALRM, ring)
    signal.alarm(int(float(seconds)))
    start = real_clock()
    record: dict[str, Any] = {"end": "last line", "error": ""}
    try:
        runpy.run_path(script, run_name="__main__")
    except Over:
        record["end"] = "steps" if watch.step_count >= watch.step_limit else "time"
    except SystemExit as leaving:
        record["end"] = f"exit {leaving.code}"
    except BaseException as error:
        record["end"] = "error"
        record["error"] = f"{type(error).__name__}: {error}"
        record["traceback"] = traceback.format_exc()
    signal.alarm(0)
    record |= {
        "module": pybullet.__file__,
        "wall": real_clock() - start,
        "steps": watch.step_count,
        "states": watch.states,
    }
    with open(record_path, "w") as file:
        json.dump(record, file)
    sys.stdout.flush()
    # Neither servers nor threads of the script keep the process.
    os._exit(0)


if __name__ == "__main__":
    main()
