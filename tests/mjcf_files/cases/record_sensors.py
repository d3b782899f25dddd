"""Records what MuJoCo's sensors show in the files of `sensor.py`: python record_sensors.py."""

import json
from pathlib import Path

import mujoco  # pyright: ignore[reportMissingImports]
import numpy as np
from sensor import SENSORS


def shown(text: str) -> dict:
    m = mujoco.MjModel.from_xml_string(text)
    d = mujoco.MjData(m)
    rng = np.random.default_rng(7)
    mujoco.mj_integratePos(m, d.qpos, rng.uniform(-0.3, 0.3, m.nv), 1.0)
    if m.nu:
        d.qpos[1] = -0.13
    d.qvel[:] = rng.uniform(-1, 1, m.nv)
    d.ctrl[:] = rng.uniform(0.1, 0.5, m.nu)
    state = {"q": d.qpos.tolist(), "v": d.qvel.tolist(), "control": d.ctrl.tolist()}
    m.opt.disableflags |= mujoco.mjtDisableBit.mjDSBL_LIMIT
    mujoco.mj_forward(m, d)
    names = [m.sensor(i).name for i in range(m.nsensor)]
    values = [d.sensor(i).data.tolist() for i in range(m.nsensor)]
    m.opt.disableflags = mujoco.mjtDisableBit.mjDSBL_CONTACT
    mujoco.mj_forward(m, d)
    for i in range(m.nsensor):
        if "LIMIT" in mujoco.mjtSensor(m.sensor_type[i]).name:
            values[i] = d.sensor(i).data.tolist()
    kinds = [mujoco.mjtSensor(kind).name for kind in m.sensor_type]
    return state | {"names": names, "kinds": kinds, "values": values}


if __name__ == "__main__":
    answers = {name: shown(text) for name, text in SENSORS.items()}
    Path(__file__).with_name("sensor_answers.json").write_text(json.dumps(answers, indent=0) + "\n")
