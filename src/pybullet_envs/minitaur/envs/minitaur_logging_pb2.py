"""The messages of the Minitaur's logs, in the format that PyBullet writes; needs `protobuf`.

Made from the table below, not by protoc, whose code works with few versions of the library only.
"""

from __future__ import annotations

from typing import Any

from google.protobuf import descriptor_pb2, descriptor_pool, message_factory

_FIELD = descriptor_pb2.FieldDescriptorProto
_PACKAGE = "robotics.reinforcement_learning.minitaur.envs"
_VECTOR = dict.fromkeys("xyz", _FIELD.TYPE_DOUBLE)
# Fields by name: a scalar type or the name of a message, in a list for repeated fields. Field numbers count
# from 1.
_MESSAGES: dict[str, dict[str, Any]] = {
    "Timestamp": {"seconds": _FIELD.TYPE_INT64, "nanos": _FIELD.TYPE_INT32},
    "Vector3d": _VECTOR,
    "MinitaurMotorState": dict.fromkeys(("angle", "velocity", "torque", "action"), _FIELD.TYPE_DOUBLE),
    "MinitaurStateAction": {
        "time": "Timestamp",
        "base_position": "Vector3d",
        "base_orientation": "Vector3d",
        "base_angular_vel": "Vector3d",
        "motor_states": ["MinitaurMotorState"],
        "info_valid": _FIELD.TYPE_BOOL,
    },
    "MinitaurEpisode": {"state_action": ["MinitaurStateAction"]},
}


def _classes() -> dict[str, Any]:
    file = descriptor_pb2.FileDescriptorProto(
        name="carom/minitaur_logging.proto", package=_PACKAGE, syntax="proto3"
    )
    for name, fields in _MESSAGES.items():
        message = file.message_type.add(name=name)
        for number, (field, kind) in enumerate(fields.items(), 1):
            many = isinstance(kind, list)
            declared = message.field.add(
                name=field, number=number, label=_FIELD.LABEL_REPEATED if many else _FIELD.LABEL_OPTIONAL
            )
            if many or isinstance(kind, str):
                declared.type = _FIELD.TYPE_MESSAGE
                declared.type_name = f".{_PACKAGE}.{kind[0] if many else kind}"
            else:
                declared.type = kind
    # A separate pool, because scripts may have PyBullet's descriptors in the default one.
    pool = descriptor_pool.DescriptorPool()
    pool.Add(file)
    return {
        name: message_factory.GetMessageClass(pool.FindMessageTypeByName(f"{_PACKAGE}.{name}"))
        for name in _MESSAGES
    }


_made = _classes()
Timestamp: Any = _made["Timestamp"]
Vector3d: Any = _made["Vector3d"]
MinitaurMotorState: Any = _made["MinitaurMotorState"]
MinitaurStateAction: Any = _made["MinitaurStateAction"]
MinitaurEpisode: Any = _made["MinitaurEpisode"]
