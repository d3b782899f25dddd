"""User data, plugins and logs."""

from ..call import Call, Calls
from ..scene import ARM, BALL, COLOUR, NO_BODY, PLANE, ZOO

ROBOT_LOG, CONTACT_LOG, PROFILE = 1, 5, 6
LOG = "<temp>/log.bin"

CALLS = {
    "addUserData": Calls(
        {"bodyUniqueId": ZOO, "key": "taste", "value": "sweet"},
        other={"linkIndex": 1, "visualShapeIndex": 0},
        forms=[Call("an old key", (ZOO, "colour", "blue"))],
        bad=[{"bodyUniqueId": NO_BODY}, {"value": 5}, {"key": 5}],
    ),
    "getUserData": Calls({"userDataId": COLOUR}, forms=[Call("unknown", (77,))]),
    "getUserDataId": Calls(
        {"bodyUniqueId": ZOO, "key": "colour"},
        other={"linkIndex": 1, "visualShapeIndex": 0},
        forms=[Call("unknown", (ZOO, "taste"))],
    ),
    "getNumUserData": Calls({"bodyUniqueId": ZOO}, forms=[Call("unknown", (NO_BODY,))]),
    "getUserDataInfo": Calls(
        {"bodyUniqueId": ZOO, "userDataIndex": 0}, bad=[{"bodyUniqueId": NO_BODY}, {"userDataIndex": 7}]
    ),
    "removeUserData": Calls({"userDataId": COLOUR}, bad=[{"userDataId": 77}]),
    "loadPlugin": Calls(
        {"pluginPath": "fileIOPlugin"},
        other={"postFix": "_x"},
        forms=[Call("unknown", ("noSuchPlugin",))],
        bad=[{"pluginPath": 5}],
    ),
    "unloadPlugin": Calls({"pluginUniqueId": 77}, bad=[{"pluginUniqueId": None}]),
    "executePluginCommand": Calls(
        {"pluginUniqueId": 77},
        other={"textArgument": "x", "intArgs": [1, 2], "floatArgs": [0.5]},
        forms=[Call("all by position", (77, "x", [1], [0.5]))],
    ),
    "startStateLogging": Calls(
        {"loggingType": ROBOT_LOG, "fileName": LOG},
        other={
            "objectUniqueIds": [ARM],
            "maxLogDof": 4,
            "bodyUniqueIdA": BALL,
            "bodyUniqueIdB": PLANE,
            "linkIndexA": -1,
            "linkIndexB": -1,
            "deviceTypeFilter": 1,
            "logFlags": 1,
        },
        along={
            name: {"loggingType": CONTACT_LOG}
            for name in ("bodyUniqueIdA", "bodyUniqueIdB", "linkIndexA", "linkIndexB")
        },
        forms=[Call("profile", (PROFILE, "<temp>/profile.json"))],
        bad=[{"fileName": 5}, {"loggingType": "all"}],
    ),
    "stopStateLogging": Calls(
        {"loggingId": 0}, forms=[Call("unknown", (77,))], first=[("startStateLogging", ROBOT_LOG, LOG)]
    ),
}
