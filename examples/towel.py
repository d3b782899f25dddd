"""A Franka Panda takes a towel off its pins, and squeezes a soft cube."""

import tempfile
from pathlib import Path

import pybullet as p
import pybullet_data
from carom.examples.window import connect, steps, wants_window

ARM = range(7)
FINGERS = (9, 10)
GRASP_TARGET = 11
HOME = (0.0, -0.3, 0.0, -2.3, 0.0, 2.0, 0.785)
MAX_FORCES = (87, 87, 87, 87, 12, 12, 12)
OPEN, CLOSED = 0.04, 0.0
GRIP = 20.0  # force of each finger [N]
SIDE, NODES = 0.16, 33  # of the towel: 16 cm, with nodes 5 mm apart, several of them between the fingers
EDGE = 0.4  # height at which it hangs [m]


def towel_mesh(folder):
    """A square that hangs in the plane y = 0 from z = 0, as an OBJ file."""
    step = SIDE / (NODES - 1)
    lines = [f"v {i * step - SIDE / 2} 0 {-j * step}" for j in range(NODES) for i in range(NODES)]
    for j in range(NODES - 1):
        for i in range(NODES - 1):
            a = j * NODES + i + 1
            lines += [f"f {a} {a + 1} {a + NODES + 1}", f"f {a} {a + NODES + 1} {a + NODES}"]
    path = Path(folder) / "towel.obj"
    path.write_text("\n".join(lines) + "\n")
    return str(path)


def load_panda():
    """The floor, and the Panda with its hand open."""
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(0, 0, -9.81)
    p.loadURDF("plane.urdf")
    panda = p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)
    for joint, angle in zip(ARM, HOME, strict=True):
        p.resetJointState(panda, joint, angle)
    for finger in FINGERS:
        p.resetJointState(panda, finger, OPEN)
        p.changeDynamics(panda, finger, lateralFriction=1.0)
    return panda


def command(panda, place, opening):
    """Ask the hand to be at a place, looking down, and the fingers to be apart."""
    downwards = p.getQuaternionFromEuler([3.14159265, 0, 0])
    angles = p.calculateInverseKinematics(
        panda, GRASP_TARGET, place, downwards, maxNumIterations=50, residualThreshold=1e-5
    )
    for joint in ARM:
        p.setJointMotorControl2(
            panda, joint, p.POSITION_CONTROL, angles[joint], force=MAX_FORCES[joint], maxVelocity=0.6
        )
    for finger in FINGERS:
        p.setJointMotorControl2(panda, finger, p.POSITION_CONTROL, opening, force=GRIP, maxVelocity=0.1)


def nodes_of(body):
    """Where the nodes of a soft body are."""
    return p.getMeshData(body, flags=p.MESH_DATA_SIMULATION_MESH)[1]


def grip_force(panda, soft):
    """With how much force the fingers press on a soft body, together [N]."""
    return sum(contact[9] for finger in FINGERS for contact in p.getContactPoints(panda, soft, finger))


def take_towel(duration, window):
    """Over the towel, down, grasp, off the pins, up; `duration` seconds each."""
    panda = load_panda()
    with tempfile.TemporaryDirectory() as folder:
        towel = p.loadSoftBody(
            towel_mesh(folder), basePosition=[0.5, 0, EDGE], mass=0.1, collisionMargin=0.003,
            useMassSpring=1, springElasticStiffness=100, springDampingStiffness=0.02,
            useBendingSprings=1, springBendingStiffness=0.5, frictionCoeff=1,
        )  # fmt: skip
    p.changeVisualShape(towel, -1, rgbaColor=[0.3, 0.5, 0.9, 1])
    pins = [p.createSoftBodyAnchor(towel, node) for node in (0, NODES - 1)]
    above, at, lifted = [0.5, 0, EDGE + 0.15], [0.5, 0, EDGE - 0.045], [0.5, 0, EDGE + 0.2]
    record = {"edge": [], "hand": [], "lowest": [], "press": []}
    for place, opening, pinned in (
        (above, OPEN, True),
        (at, OPEN, True),
        (at, CLOSED, True),
        (lifted, CLOSED, False),
        (lifted, CLOSED, False),
    ):
        while pins and not pinned:
            p.removeConstraint(pins.pop())
        for _ in steps(duration, window):
            command(panda, place, opening)
            p.stepSimulation()
        nodes = nodes_of(towel)
        record["edge"].append(nodes[NODES // 2][2])
        record["hand"].append(p.getLinkState(panda, GRASP_TARGET)[0][2])
        record["lowest"].append(min(node[2] for node in nodes))
        record["press"].append(grip_force(panda, towel))
    return record


def squeeze_cube(duration, window):
    """A soft cube of 5 cm between the fingers: its width free and squeezed, and lifted."""
    panda = load_panda()
    size = 0.05
    cube = p.loadSoftBody(
        "reduced_cube/cube_mesh.vtk", basePosition=[0.5, 0, size / 2 + 0.002], scale=size, mass=0.1,
        useNeoHookean=1, NeoHookeanMu=2e4, NeoHookeanLambda=3e4, NeoHookeanDamping=0.02,
        collisionMargin=0.002, frictionCoeff=1,
    )  # fmt: skip
    p.changeVisualShape(cube, -1, rgbaColor=[0.9, 0.6, 0.2, 1])
    record = {"width": [], "height": [], "press": []}
    for place, opening in (
        ([0.5, 0, 0.15], OPEN),
        ([0.5, 0, 0.025], OPEN),
        ([0.5, 0, 0.025], 0.018),
        ([0.5, 0, 0.25], 0.018),
        ([0.5, 0, 0.25], 0.018),
    ):
        for _ in steps(duration, window):
            command(panda, place, opening)
            p.stepSimulation()
        nodes = nodes_of(cube)
        between = sum(p.getJointState(panda, finger)[0] for finger in FINGERS)
        record["width"].append(min(size, between))
        record["height"].append(sum(node[2] for node in nodes) / len(nodes))
        record["press"].append(grip_force(panda, cube))
    return record


def main(duration=1.0, window=False):
    """Take the towel, then the cube; what was measured at the end of each phase."""
    connect(window)
    record = {"towel": take_towel(duration, window), "cube": squeeze_cube(duration, window)}
    p.disconnect()
    return record


if __name__ == "__main__":
    measured = main(window=wants_window())
    towel, cube = measured["towel"], measured["cube"]
    print(f"the towel's edge is {towel['hand'][-1] - towel['edge'][-1]:.3f} m below the point of grasp")
    print(f"the fingers press with {towel['press'][-1]:.1f} N, together")
    free, squeezed = cube["width"][0], cube["width"][-1]
    print(f"the cube is {free * 1000:.1f} mm wide, and {squeezed * 1000:.1f} mm in the hand")
