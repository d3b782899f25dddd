"""A cloth falls on a ball, a soft cube is squeezed by a box, and a rope hangs between two hooks."""

import carom
import pybullet as p
import pybullet_data
from carom.examples.window import TIME_STEP, connect, steps, wants_window


def cloth_on_a_ball():
    """PyBullet's way: a mesh, and the stiffness of its springs."""
    ball = p.createCollisionShape(p.GEOM_SPHERE, radius=0.3)
    p.createMultiBody(0, ball, basePosition=[0, 0, 0.3])
    cloth = p.loadSoftBody(
        "cloth_z_up.obj", basePosition=[0, 0, 0.9], mass=1, scale=0.5, collisionMargin=0.02, useMassSpring=1,
        springElasticStiffness=60, springDampingStiffness=0.5, useBendingSprings=1, springBendingStiffness=2,
        frictionCoeff=1, useSelfCollision=1,
    )  # fmt: skip
    p.changeVisualShape(cloth, -1, rgbaColor=[0.9, 0.2, 0.2, 1])
    return cloth


def main(duration=2.0, window=False):
    """Let the cloth fall, then use the modern API for the cube and the rope."""
    connect(window)
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    p.setGravity(0, 0, -9.81)
    p.loadURDF("plane.urdf")
    cloth = cloth_on_a_ball()
    for _ in steps(duration, window):
        p.stepSimulation()
    _, nodes = p.getMeshData(cloth, flags=p.MESH_DATA_SIMULATION_MESH)
    p.disconnect()
    return {"cloth": nodes, **squeezed_cube(duration), **hanging_rope(duration)}


def squeezed_cube(duration):
    """A cube of 10 kPa under a box of 2 kg: by how much it becomes lower."""
    world = carom.World()
    world.gravity = (0, 0, -9.81)
    world.load_urdf("plane.urdf", fixed_base=True)
    cube = world.load_soft_solid(
        (0.2, 0.2, 0.2), (4, 4, 4), (0, 0, 0.105), youngs_modulus=1e4, poissons_ratio=0.3, damping=0.05
    )
    start = float(cube.nodes[:, 2].max())
    # The file states the inertia of a larger cube; as in PyBullet, that of the shape is used instead.
    box = world.load_urdf("cube.urdf", (0, 0, 0.32), scale=0.2, as_pybullet=True)
    box.change_dynamics(-1, mass=2.0)
    world.step(round(duration / TIME_STEP))
    return {"height": start - float(cube.nodes[:, 2].max())}


def hanging_rope(duration):
    """A rope of 1 m between two hooks 80 cm apart: how deep it hangs."""
    world = carom.World()
    world.gravity = (0, 0, -9.81)
    rope = world.load_rope(1.0, 40, stiffness=2e4, damping=2.0)
    rope.set_nodes([[0.02 * k - 0.4, 0, -0.265 * (1 - (k / 20 - 1) ** 2)] for k in range(41)])
    rope.anchor(0)
    rope.anchor(40)
    for _ in range(round(duration / TIME_STEP)):
        world.step()
        rope.node_velocities[:] *= 0.98  # the air
    return {"rope": rope.nodes.copy()}


if __name__ == "__main__":
    result = main(window=wants_window())
    print(f"the cube became {result['height'] * 1000:.1f} mm lower")
    print(f"the rope hangs {-result['rope'][:, 2].min():.3f} m deep")
