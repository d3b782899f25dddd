"""Shapes, and bodies made of them."""

from ..call import Call, Calls
from ..scene import BALL, CRATE, DATA, NO_BODY, PLANE, SPARE_BOX, SPARE_LOOK, SPARE_SPHERE, TILTED, ZOO

SPHERE, BOX, CYLINDER, MESH, PLANE_SHAPE, CAPSULE, HEIGHTFIELD = 2, 3, 4, 5, 6, 7, 9
OBJ = "<repo>/tests/formats/data/meshes/two_boxes.obj"
CORNERS = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
FACES = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]
HEIGHTS = [0.0, 0.1, 0.0, 0.1, 0.3, 0.1, 0.0, 0.1, 0.0]
# Shapes are seen through a body made of them.
_TWO_LINKS = {
    "linkMasses": [1, 0.5],
    "linkCollisionShapeIndices": [SPARE_SPHERE, SPARE_BOX],
    "linkVisualShapeIndices": [-1, SPARE_LOOK],
    "linkPositions": [[0, 0, 1], [0, 0.5, 0]],
    "linkOrientations": [[0, 0, 0, 1], list(TILTED)],
    "linkInertialFramePositions": [[0, 0, 0], [0.1, 0, 0]],
    "linkInertialFrameOrientations": [[0, 0, 0, 1], [0, 0, 0, 1]],
    "linkParentIndices": [0, 1],
    "linkJointTypes": [0, 1],
    "linkJointAxis": [[0, 1, 0], [1, 0, 0]],
}
_HEIGHTFIELD = {
    "shapeType": HEIGHTFIELD,
    "heightfieldData": HEIGHTS,
    "numHeightfieldRows": 3,
    "numHeightfieldColumns": 3,
    "meshScale": [0.5, 0.5, 1],
}

CALLS = {
    "createCollisionShape": Calls(
        {"shapeType": SPHERE},
        other={
            "radius": 0.3,
            "halfExtents": [0.1, 0.2, 0.3],
            "height": 2.0,
            "fileName": OBJ,
            "meshScale": [2, 2, 2],
            "planeNormal": [0, 1, 1],
            "flags": 1,
            "collisionFramePosition": [0.1, 0.2, 0.3],
            "collisionFrameOrientation": list(TILTED),
            "vertices": CORNERS,
            "indices": FACES,
            "heightfieldTextureScaling": 2.0,
            "heightfieldData": HEIGHTS,
            "numHeightfieldRows": 3,
            "numHeightfieldColumns": 3,
            "replaceHeightfieldIndex": -1,
        },
        along={
            "halfExtents": {"shapeType": BOX},
            "height": {"shapeType": CAPSULE},
            "fileName": {"shapeType": MESH},
            "meshScale": {"shapeType": MESH, "fileName": OBJ},
            "planeNormal": {"shapeType": PLANE_SHAPE},
            "flags": {"shapeType": MESH, "fileName": OBJ},
            "vertices": {"shapeType": MESH},
            "indices": {"shapeType": MESH, "vertices": CORNERS},
            "heightfieldTextureScaling": _HEIGHTFIELD,
            "heightfieldData": _HEIGHTFIELD,
            "numHeightfieldRows": _HEIGHTFIELD,
            "numHeightfieldColumns": _HEIGHTFIELD,
            "replaceHeightfieldIndex": _HEIGHTFIELD,
        },
        forms=[Call("cylinder", (CYLINDER,), {"radius": 0.1, "height": 0.4})],
        bad=[
            {"shapeType": BOX},
            {"shapeType": MESH},
            {"shapeType": MESH, "fileName": "<temp>/missing.obj"},
            {"shapeType": 99},
            {**_HEIGHTFIELD, "numHeightfieldRows": 4},
        ],
    ),
    "createCollisionShapeArray": Calls(
        {"shapeTypes": [SPHERE, SPHERE], "radii": [0.1, 0.2]},
        other={
            "halfExtents": [[0.1, 0.2, 0.3], [0.2, 0.2, 0.2]],
            "lengths": [1.0, 2.0],
            "fileNames": [OBJ, OBJ],
            "meshScales": [[1, 1, 1], [2, 2, 2]],
            "planeNormals": [[0, 0, 1], [0, 1, 0]],
            "flags": [0, 0],
            "collisionFramePositions": [[0, 0, 0], [1, 0, 0]],
            "collisionFrameOrientations": [[0, 0, 0, 1], list(TILTED)],
        },
        along={
            "halfExtents": {"shapeTypes": [BOX, BOX]},
            "lengths": {"shapeTypes": [CAPSULE, CYLINDER]},
            "fileNames": {"shapeTypes": [MESH, MESH]},
            "meshScales": {"shapeTypes": [MESH, MESH], "fileNames": [OBJ, OBJ]},
        },
        bad=[{"shapeTypes": 5}, {"shapeTypes": [99, 99]}],
    ),
    "removeCollisionShape": Calls(
        {"collisionShapeId": SPARE_SPHERE}, forms=[Call("unknown", (77,)), Call("of a body", (4,))]
    ),
    "createVisualShape": Calls(
        {"shapeType": SPHERE},
        other={
            "radius": 0.3,
            "halfExtents": [0.1, 0.2, 0.3],
            "length": 2.0,
            "fileName": OBJ,
            "meshScale": [2, 2, 2],
            "planeNormal": [0, 1, 1],
            "flags": 1,
            "rgbaColor": [1, 0, 0, 0.5],
            "specularColor": [0.1, 0.2, 0.3],
            "visualFramePosition": [0.1, 0.2, 0.3],
            "visualFrameOrientation": list(TILTED),
            "vertices": CORNERS,
            "indices": FACES,
            "normals": CORNERS,
            "uvs": [[0, 0], [1, 0], [0, 1], [1, 1]],
        },
        along={
            "halfExtents": {"shapeType": BOX},
            "length": {"shapeType": CAPSULE},
            "fileName": {"shapeType": MESH},
            "meshScale": {"shapeType": MESH, "fileName": OBJ},
            "planeNormal": {"shapeType": PLANE_SHAPE},
            "vertices": {"shapeType": MESH, "indices": FACES},
            "indices": {"shapeType": MESH, "vertices": CORNERS},
            "normals": {"shapeType": MESH, "vertices": CORNERS, "indices": FACES},
            "uvs": {"shapeType": MESH, "vertices": CORNERS, "indices": FACES},
        },
        bad=[{"shapeType": 99}, {"shapeType": BOX}, {"shapeType": MESH}],
    ),
    "createVisualShapeArray": Calls(
        {"shapeTypes": [SPHERE, SPHERE], "radii": [0.1, 0.2]},
        other={
            "halfExtents": [[0.1, 0.2, 0.3], [0.2, 0.2, 0.2]],
            "lengths": [1.0, 2.0],
            "fileNames": [OBJ, OBJ],
            "meshScales": [[1, 1, 1], [2, 2, 2]],
            "planeNormals": [[0, 0, 1], [0, 1, 0]],
            "flags": [0, 0],
            "rgbaColors": [[1, 0, 0, 1], [0, 1, 0, 1]],
            "visualFramePositions": [[0, 0, 0], [1, 0, 0]],
            "visualFrameOrientations": [[0, 0, 0, 1], list(TILTED)],
        },
        along={
            "halfExtents": {"shapeTypes": [BOX, BOX]},
            "lengths": {"shapeTypes": [CAPSULE, CYLINDER]},
            "fileNames": {"shapeTypes": [MESH, MESH]},
            "meshScales": {"shapeTypes": [MESH, MESH], "fileNames": [OBJ, OBJ]},
        },
        bad=[{"shapeTypes": 5}, {"shapeTypes": [99, 99]}],
    ),
    "createMultiBody": Calls(
        other={
            "baseMass": 2.0,
            "baseCollisionShapeIndex": SPARE_BOX,
            "baseVisualShapeIndex": SPARE_LOOK,
            "basePosition": [1, 2, 3],
            "baseOrientation": list(TILTED),
            "baseInertialFramePosition": [0.1, 0, 0],
            "baseInertialFrameOrientation": list(TILTED),
            "useMaximalCoordinates": 0,
            "flags": 8,
            "batchPositions": [[0, 0, 7], [0, 0, 8], [0, 0, 9]],
            **_TWO_LINKS,
        },
        along={
            **{name: {"basePosition": [8, 8, 8], **_TWO_LINKS} for name in _TWO_LINKS},
            "baseInertialFramePosition": {
                "baseMass": 1,
                "baseCollisionShapeIndex": SPARE_BOX,
                "basePosition": [8, 8, 8],
            },
            "baseInertialFrameOrientation": {
                "baseMass": 1,
                "baseCollisionShapeIndex": SPARE_BOX,
                "basePosition": [8, 8, 8],
            },
            "batchPositions": {"baseMass": 1, "baseCollisionShapeIndex": SPARE_BOX},
        },
        forms=[Call("a base", (1.0, SPARE_SPHERE, SPARE_LOOK, [5, 5, 5], [0, 0, 0, 1]))],
        bad=[{**_TWO_LINKS, "linkMasses": [1]}],
    ),
    "getMeshData": Calls(
        {"bodyUniqueId": CRATE},
        other={"linkIndex": 0, "collisionShapeIndex": 0, "flags": 1},
        along={"linkIndex": {"bodyUniqueId": ZOO}},
        bad=[{"bodyUniqueId": NO_BODY}],
    ),
    "vhacd": Calls(
        {
            "fileNameIn": "<temp>/missing.obj",
            "fileNameOut": "<temp>/out.obj",
            "fileNameLogging": "<temp>/log.txt",
        },
        other={
            "concavity": 0.01,
            "alpha": 0.1,
            "beta": 0.1,
            "gamma": 0.001,
            "minVolumePerCH": 0.001,
            "resolution": 1000,
            "maxNumVerticesPerCH": 32,
            "depth": 10,
            "planeDownsampling": 8,
            "convexhullDownsampling": 8,
            "pca": 1,
            "mode": 1,
            "convexhullApproximation": 0,
        },
    ),
    "setCollisionFilterPair": Calls(
        {
            "bodyUniqueIdA": PLANE,
            "bodyUniqueIdB": BALL,
            "linkIndexA": -1,
            "linkIndexB": -1,
            "enableCollision": 0,
        },
        forms=[Call("unknown", (NO_BODY, BALL, -1, -1, 0))],
    ),
    "setCollisionFilterGroupMask": Calls(
        {"bodyUniqueId": BALL, "linkIndexA": -1, "collisionFilterGroup": 0, "collisionFilterMask": 0},
        forms=[Call("unknown", (NO_BODY, -1, 0, 0))],
    ),
    "getVisualShapeData": Calls(
        {"objectUniqueId": CRATE},
        other={"flags": 1},
        forms=[Call("of a robot", (ZOO,)), Call("unknown", (NO_BODY,))],
        bad=[{"objectUniqueId": -1}],
    ),
    "getCollisionShapeData": Calls(
        {"objectUniqueId": CRATE, "linkIndex": -1},
        forms=[
            Call("a plane", (PLANE, -1)),
            Call("a capsule", (ZOO, 3)),
            Call("a link without shapes", (ZOO, 2)),
        ],
        bad=[{"objectUniqueId": NO_BODY}, {"linkIndex": 77}],
    ),
    "changeVisualShape": Calls(
        {"objectUniqueId": CRATE, "linkIndex": -1},
        other={
            "shapeIndex": 0,
            "textureUniqueId": 0,
            "rgbaColor": [1, 0, 0, 0.5],
            "specularColor": [0.1, 0.2, 0.3],
            "flags": 4,
        },
        along={"shapeIndex": {"rgbaColor": [0, 1, 0, 1]}},
    ),
    "resetVisualShapeData": Calls(
        {"objectUniqueId": CRATE, "linkIndex": -1},
        other={
            "shapeIndex": 0,
            "textureUniqueId": 0,
            "rgbaColor": [1, 0, 0, 0.5],
            "specularColor": [0.1, 0.2, 0.3],
            "flags": 4,
        },
        along={"shapeIndex": {"rgbaColor": [0, 1, 0, 1]}},
    ),
    "loadTexture": Calls(
        {"textureFilename": f"{DATA}/checker_blue.png"},
        bad=[{"textureFilename": "<temp>/missing.png"}, {"textureFilename": 1}],
    ),
    "changeTexture": Calls(
        {"textureUniqueId": 0, "pixels": [255, 0, 0] * 4, "width": 2, "height": 2},
        bad=[{"textureUniqueId": -1}, {"pixels": 5}, {"width": 0}, {"width": -1}, {"height": 0}],
    ),
}
