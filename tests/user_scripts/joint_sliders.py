"""A slider for each joint of an arm, keys to quit and to reset, text above the hand."""

import time

import pybullet as p
import pybullet_data


def main(method: int = p.DIRECT, seconds: float = 0.05) -> dict[str, float]:
    client = p.connect(method)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.configureDebugVisualizer(p.COV_ENABLE_SHADOWS, 0)
    p.resetDebugVisualizerCamera(1.5, 50, -35, [0, 0, 0.5])
    arm = p.loadURDF("kuka_iiwa/model.urdf", useFixedBase=True)
    sliders: dict[int, int] = {}
    names: dict[int, str] = {}
    for joint in range(p.getNumJoints(arm)):
        info = p.getJointInfo(arm, joint)
        if info[2] in (p.JOINT_REVOLUTE, p.JOINT_PRISMATIC):
            names[joint] = info[1].decode("utf-8")
            sliders[joint] = p.addUserDebugParameter(names[joint], info[8], info[9], 0.0)
    label = p.addUserDebugText("hand", [0, 0, 1.3], textColorRGB=[0, 0, 1])

    end = time.time() + seconds
    while p.isConnected() and time.time() < end:
        keys = p.getKeyboardEvents()
        if keys.get(ord("q"), 0) & p.KEY_WAS_TRIGGERED:
            break
        for event in p.getMouseEvents():
            print("mouse at", event[1], event[2])
        for joint, slider in sliders.items():
            target = p.readUserDebugParameter(slider) if method == p.GUI else 0.1
            p.setJointMotorControl2(arm, joint, p.POSITION_CONTROL, targetPosition=target, force=200)
        p.stepSimulation()
        hand = p.getLinkState(arm, 6)
        assert hand is not None
        label = p.addUserDebugText("hand", hand[0], replaceItemUniqueId=label)
    states = p.getJointStates(arm, list(names))
    assert states is not None
    p.disconnect(client)
    return {name: state[0] for name, state in zip(names.values(), states, strict=True)}


if __name__ == "__main__":
    print(main(p.GUI, seconds=60))
