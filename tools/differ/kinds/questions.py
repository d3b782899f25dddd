"""Questions of geometry, and images."""

from __future__ import annotations

from tools.differ.maker import Maker, Vector

_TEXTURES = ("tex256.png", "checker_blue.png", "duckCM.png")


def query(maker: Maker) -> None:
    """Ask for nearest points, bounds, overlaps, or cast rays."""
    body = maker.body()
    kind = maker.random.randrange(10)
    if kind < 3:
        other = maker.body()
        links = maker.some(linkIndexA=maker.link(body), linkIndexB=maker.link(other))
        distance = maker.one((0, 0.1, 1, 5))
        maker.call("getClosestPoints", body.reference, other.reference, distance, **links)
    elif kind == 3 and maker.shapes:
        _nearest_of_shapes(maker)
    elif kind == 4:
        low = maker.place()
        high = [coordinate + maker.one((0.2, 1, 3)) for coordinate in low]
        maker.call("getOverlappingObjects", low, high)
    elif kind == 5:
        maker.call("getAABB", body.reference, maker.link(body))
    elif kind < 8:
        keywords = maker.some(
            collisionFilterMask=maker.one((-1, 0, 1, 2)), reportHitNumber=maker.one((-1, 0, 1))
        )
        maker.call("rayTest", _end(maker), _end(maker), **keywords)
    else:
        _rays(maker)


def _nearest_of_shapes(maker: Maker) -> None:
    first, second = maker.one(maker.shapes), maker.one(maker.shapes)
    distance = maker.one((0.5, 5))
    keywords = {"collisionShapeB": second, "collisionShapePositionB": maker.place()}
    keywords |= maker.some(collisionShapeOrientationB=maker.turn())
    if maker.chance(0.5):
        maker.call("getClosestPoints", maker.body().reference, -1, distance, **keywords)
        return
    keywords |= {"collisionShapeA": first, "collisionShapePositionA": maker.place()}
    keywords |= maker.some(collisionShapeOrientationA=maker.turn())
    maker.call("getClosestPoints", -1, -1, distance, **keywords)


def _rays(maker: Maker) -> None:
    keywords = maker.some(
        numThreads=maker.one((0, 1)),
        collisionFilterMask=maker.one((-1, 1, 2)),
        reportHitNumber=maker.one((-1, -1, 0, 1)),
        fractionEpsilon=maker.one((0, 0.01)),
    )
    if maker.chance(0.4):
        body = maker.body()
        keywords |= {"parentObjectUniqueId": body.reference, **maker.some(parentLinkIndex=maker.link(body))}
    count = maker.random.randint(1, 6)
    starts, ends = ([_end(maker) for _ in range(count)] for _ in range(2))
    maker.call("rayTestBatch", starts, ends, **keywords)


def _end(maker: Maker) -> Vector:
    return [coordinate + maker.random.uniform(-2, 2) for coordinate in maker.place()]


def camera(maker: Maker) -> None:
    """Take an image."""
    uniform = maker.random.uniform
    width, height = maker.one(((32, 24), (24, 32), (40, 40)))
    if maker.chance(0.5):
        eye = [uniform(-2, 2), uniform(-2, 2), uniform(0.2, 3)]
        view = maker.call("computeViewMatrix", eye, [0, 0, 0.3], [0, 0, 1])
    else:
        angles = uniform(-180, 180), uniform(-80, 10), maker.one((0, 20))
        view = maker.call("computeViewMatrixFromYawPitchRoll", [0, 0, 0.3], uniform(1, 4), *angles, 2)
    if maker.chance(0.6):
        depths = maker.one((0.01, 0.1)), maker.one((10, 100))
        projection = maker.call("computeProjectionMatrixFOV", uniform(30, 90), width / height, *depths)
    else:
        near = maker.one((0.05, 0.1))
        projection = maker.call("computeProjectionMatrix", -0.05, 0.05, -0.05, 0.05, near, 20)
    maker.call(
        "getCameraImage",
        width,
        height,
        {"whole": view["$"]},
        {"whole": projection["$"]},
        **maker.some(
            lightDirection=maker.one(([1, 1, 1], [0, 0, 1], [-1, 2, 3])),
            lightColor=[1, maker.share(), 1],
            lightDistance=maker.one((2, 10)),
            shadow=0,
            lightAmbientCoeff=maker.share(),
            lightDiffuseCoeff=maker.share(),
            lightSpecularCoeff=maker.share(),
            renderer=65536,
            flags=maker.one((0, 1, 4, 5)),
        ),
    )


def texture(maker: Maker) -> None:
    """Put a texture on a link, or take it away."""
    body = maker.body()
    if not maker.textures or maker.chance(0.3):
        maker.textures.append(maker.call("loadTexture", maker.one(_TEXTURES)))
    chosen = maker.one((*maker.textures, -1))
    maker.call("changeVisualShape", body.reference, maker.link(body), textureUniqueId=chosen)
