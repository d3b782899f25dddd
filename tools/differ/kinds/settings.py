"""Dynamics of links, parameters of the engine, filters, and saved states."""

from __future__ import annotations

from tools.differ.maker import Maker


def dynamics(maker: Maker) -> None:
    """Change dynamics of links, and ask for them."""
    body = maker.body()
    for _ in range(maker.random.randint(1, 2)):
        keywords = maker.some(
            mass=maker.one((0, 1, maker.positive(0.1, 10))),
            lateralFriction=maker.share(),
            spinningFriction=maker.one((0, 0.01, 0.1)),
            rollingFriction=maker.one((0, 0.01, 0.1)),
            restitution=maker.one((0, 0.3, 0.8)),
            linearDamping=maker.one((0, 0.04, maker.share())),
            angularDamping=maker.one((0, 0.04, maker.share())),
            localInertiaDiagonal=[maker.positive(0.01, 1) for _ in range(3)],
            ccdSweptSphereRadius=0.0,
            contactProcessingThreshold=maker.one((0, 0.01)),
            activationState=maker.one((1, 2, 4, 8, 16, 32)),
            jointDamping=maker.one((0, 0.1, maker.share())),
            anisotropicFriction=[1, maker.share(), 0.1],
            maxJointVelocity=maker.positive(0.5, 100),
            jointLowerLimit=-maker.share(),
            jointUpperLimit=maker.share(),
            jointLimitForce=maker.one((1, 10, 100)),
            sleepThreshold=maker.one((0.01, 1, 0)),
        )
        if maker.chance(0.2):
            keywords |= {
                "contactStiffness": maker.positive(100, 1e5),
                "contactDamping": maker.positive(1, 1e3),
            }
        if maker.chance(0.05):
            keywords["collisionMargin"] = maker.one((0.0, 0.001, 0.02))
        if maker.chance(0.1):
            keywords["frictionAnchor"] = maker.one((0, 1))
        maker.call("changeDynamics", body.reference, maker.link(body), **keywords)
        maker.call("getDynamicsInfo", body.reference, maker.link(body))


def engine(maker: Maker) -> None:
    """Change parameters of the engine."""
    if maker.chance(0.2):
        maker.call("setTimeStep", maker.one((1 / 240, 1 / 60, 0.001, maker.random.uniform(0.001, 0.02))))
    else:
        keywords = maker.some(
            fixedTimeStep=maker.one((1 / 240, 1 / 100, 0.002)),
            numSolverIterations=maker.one((1, 5, 50, 200)),
            useSplitImpulse=maker.one((0, 1)),
            splitImpulsePenetrationThreshold=maker.one((-0.04, 0.01)),
            numSubSteps=maker.one((0, 1, 2, 4)),
            collisionFilterMode=maker.one((0, 1)),
            contactBreakingThreshold=maker.one((0.02, 0.001)),
            enableFileCaching=maker.one((0, 1)),
            restitutionVelocityThreshold=maker.one((0.2, 0, 1)),
            erp=maker.one((0.2, 0.1, 0.8)),
            contactERP=maker.one((0.08, 0.2, 0.9)),
            frictionERP=maker.one((0.2, 0.05)),
            enableConeFriction=maker.one((0, 1)),
            deterministicOverlappingPairs=maker.one((0, 1)),
            jointFeedbackMode=maker.one((0, 1, 2, 3)),
            solverResidualThreshold=maker.one((1e-7, 0, 1e-2)),
            contactSlop=maker.one((0, 1e-4, 0.001)),
            globalCFM=maker.one((0, 1e-6, 0.01)),
            minimumSolverIslandSize=maker.one((128, 1, 0)),
            numNonContactInnerIterations=maker.one((1, 2, 5)),
        )
        maker.call("setPhysicsEngineParameter", **keywords)
    if maker.chance(0.4):
        maker.call("getPhysicsEngineParameters")


def filtering(maker: Maker) -> None:
    """Say what collides."""
    first, second = maker.body(), maker.body()
    if maker.chance(0.5):
        group, mask = maker.one((0, 1, 2, 3)), maker.one((0, 1, 2, 3, 255))
        maker.call("setCollisionFilterGroupMask", first.reference, maker.link(first), group, mask)
    else:
        links = maker.link(first), maker.link(second)
        maker.call("setCollisionFilterPair", first.reference, second.reference, *links, maker.one((0, 1)))


def save(maker: Maker) -> None:
    """Save the state, restore one, or remove it."""
    kind = maker.random.randrange(5)
    if kind < 2 or not maker.states:
        maker.states.append(maker.call("saveState"))
    elif kind < 4:
        maker.call("restoreState", maker.one(maker.states))
    else:
        maker.call("removeState", maker.one(maker.states))
