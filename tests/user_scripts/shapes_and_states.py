"""A wall of bricks made in the script, thrown at twice from the same state."""

import pybullet as p


def build(rows: int, columns: int) -> list[int]:
    brick = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.2, 0.1, 0.1])
    look = p.createVisualShape(p.GEOM_BOX, halfExtents=[0.2, 0.1, 0.1], rgbaColor=[0.7, 0.3, 0.2, 1])
    bricks: list[int] = []
    for row in range(rows):
        for column in range(columns):
            place = [0.41 * column + 0.2 * (row % 2), 0, 0.1 + 0.2 * row]
            bricks.append(p.createMultiBody(0.5, brick, look, place))
    return bricks


def throw(ball: int, velocity: list[float]) -> list[tuple[float, float, float]]:
    p.resetBaseVelocity(ball, linearVelocity=velocity)
    for _ in range(60):
        p.stepSimulation()
    return [p.getBasePositionAndOrientation(p.getBodyUniqueId(i))[0] for i in range(p.getNumBodies())]


def main() -> bool:
    p.connect(p.DIRECT)
    p.setGravity(0, 0, -9.81)
    p.createMultiBody(0, p.createCollisionShape(p.GEOM_PLANE))
    bricks = build(3, 4)
    ball = p.createMultiBody(
        2, p.createCollisionShape(p.GEOM_SPHERE, radius=0.2), basePosition=[0.6, -2, 0.4]
    )
    p.changeDynamics(ball, -1, restitution=0.3, rollingFriction=0.01)
    batch = p.createMultiBody(
        1,
        p.createCollisionShape(p.GEOM_SPHERE),
        batchPositions=[[5, 5, 5], [7, 7, 7]],
        useMaximalCoordinates=0,
    )
    assert len(batch) == 2
    p.addUserData(bricks[0], "colour", "brick")
    state = p.saveState()
    first = throw(ball, [0, 6, 1])
    p.restoreState(state)
    second = throw(ball, [0, 6, 1])
    p.removeState(state)
    p.disconnect()
    return first == second


if __name__ == "__main__":
    print(main())
