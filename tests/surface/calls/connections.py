"""Connections and what concerns the server."""

from ..call import Call, Calls

DIRECT, SHARED_MEMORY = 2, 3

CALLS = {
    "connect": Calls(
        forms=[
            Call("a second world", (DIRECT,)),
            Call("by name", (), {"method": DIRECT}),
            Call("with a key", (DIRECT, 12345)),
            Call("with a key by name", (DIRECT,), {"key": 12345}),
            Call("with options", (DIRECT,), {"options": "--width=100"}),
            Call("with a host", (), {"method": DIRECT, "hostName": "localhost"}),
            Call(
                "with a host and a port",
                (),
                {"method": DIRECT, "hostName": "localhost", "port": 1, "options": ""},
            ),
            Call("to nobody", (SHARED_MEMORY, 987654)),
        ],
        bad=[
            Call("without a method"),
            Call("unknown method", (99,)),
            Call("a method that is no number", ("DIRECT",)),
            Call("unknown keyword", (DIRECT,), {"foo": 1}),
        ],
    ),
    "disconnect": Calls(forms=[Call("the client by position", (0,))]),
    "isConnected": Calls(forms=[Call("the client by position", (0,))]),
    "getConnectionInfo": Calls(),
    "getAPIVersion": Calls(),
    "isNumpyEnabled": Calls(),
    "setTimeOut": Calls({"timeOutInSeconds": 5.0}, bad=[{"timeOutInSeconds": "soon"}]),
    "syncBodyInfo": Calls(),
    "syncUserData": Calls(
        other={"bodyUniqueId": 1},
        forms=[
            Call("several bodies", (), {"bodyUniqueIds": [0, 1]}),
            Call("several bodies, and a client", (), {"bodyUniqueIds": [0, 1], "physicsClientId": 0}),
        ],
    ),
}
