"""The window: sliders, keys, the mouse, the camera."""

from __future__ import annotations

from typing import Any

from pybullet._calls.arguments import Vector, integer, real, text
from pybullet._calls.builtin import exported
from pybullet._calls.constants import COV_ENABLE_SINGLE_STEP_RENDERING
from pybullet._calls.errors import fail
from pybullet._calls.optional_vectors import optional_rotation, optional_vector3
from pybullet._clients.clients import client_of

__all__ = [
    "addUserDebugParameter",
    "configureDebugVisualizer",
    "getDebugVisualizerCamera",
    "getKeyboardEvents",
    "getMouseEvents",
    "getVREvents",
    "readUserDebugParameter",
    "removeAllUserParameters",
    "resetDebugVisualizerCamera",
    "setVRCameraState",
]


@exported
def addUserDebugParameter(
    paramName: str, rangeMin: float = 0, rangeMax: float = 1, startValue: float = 0, physicsClientId: int = 0
) -> int:
    """Adds a slider to the window, or a button.

    Args:
        paramName: Its name.
        rangeMin: Minimum value.
        rangeMax: Maximum value; if less than the minimum, a button is made, which counts its clicks.
        startValue: Initial value.
        physicsClientId: The connection.

    Returns:
        Its id, for `readUserDebugParameter`; -1 in `DIRECT`.

    Raises:
        pybullet.error: Not connected, or a number is not finite.

    Examples:
        >>> slider = p.addUserDebugParameter("speed", 0, 2, 1)
    """
    from carom.viewer.items import Slider

    slider = Slider(
        text(paramName, "paramName"),
        real(rangeMin, "rangeMin"),
        real(rangeMax, "rangeMax"),
        real(startValue, "startValue"),
    )
    return client_of(physicsClientId).window.add_slider(slider)


@exported
def readUserDebugParameter(itemUniqueId: int, physicsClientId: int = 0) -> float:
    """The value of a slider, or the number of clicks of a button.

    Args:
        itemUniqueId: The slider or button.
        physicsClientId: The connection.

    Returns:
        Its value.

    Raises:
        pybullet.error: Not connected, or there is no such slider or button; in `DIRECT` there are none.

    Examples:
        >>> slider = p.addUserDebugParameter("speed", 0, 2, 1)
        >>> speed = p.readUserDebugParameter(slider) if slider >= 0 else 1.0
    """
    item = integer(itemUniqueId, "itemUniqueId")
    value = client_of(physicsClientId).window.slider_value(item)
    if value is None:
        fail("Failed to read parameter.", f"There is no slider or button {item}.")
    return value


@exported
def removeAllUserParameters(physicsClientId: int = 0) -> None:
    """Removes all sliders and buttons.

    Args:
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.removeAllUserParameters()
    """
    client_of(physicsClientId).window.remove_sliders()


@exported
def getKeyboardEvents(physicsClientId: int = 0) -> dict[int, int]:
    """Keys pressed, held or released since the last call.

    Args:
        physicsClientId: The connection.

    Returns:
        `KEY_*` bits by key: the code of its character, or `B3G_*`. Empty in `DIRECT`.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> keys = p.getKeyboardEvents()
        >>> bool(keys.get(ord("q"), 0) & p.KEY_WAS_TRIGGERED)
        False
    """
    return client_of(physicsClientId).window.key_events()


@exported
def getMouseEvents(physicsClientId: int = 0) -> tuple[tuple[int, float, float, int, int], ...]:
    """Motions and clicks of the mouse since the last call.

    Args:
        physicsClientId: The connection.

    Returns:
        (type, x, y, button, state) for each: type 1 for a motion and 2 for a button; position in pixels;
        button 0, 1 or 2; `KEY_*` bits. Empty in `DIRECT`.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.getMouseEvents()
        ()
    """
    return tuple(client_of(physicsClientId).window.mouse_events())


@exported
def configureDebugVisualizer(
    flag: int = -1,
    enable: int = -1,
    lightPosition: Vector | None = None,
    shadowMapResolution: int = -1,
    shadowMapWorldSize: int = -1,
    remoteSyncTransformInterval: float = -1,
    shadowMapIntensity: float = -1,
    rgbBackground: Vector | None = None,
    physicsClientId: int = 0,
) -> None:
    """Sets options of the window. Negative numbers change nothing; in `DIRECT` it has no effect.

    Args:
        flag: `COV_*`. `COV_ENABLE_SINGLE_STEP_RENDERING` makes the call return when the pages in view have
            drawn the present state, or after a tenth of a second; videos get a picture of it.
        enable: 1 to switch the flag on, 0 to switch it off.
        lightPosition: Position of the light [m].
        shadowMapResolution: Width and height of the shadow map in pixels.
        shadowMapWorldSize: Width and height of the area with shadows [m].
        remoteSyncTransformInterval: Not used: pages get the newest state at display rate.
        shadowMapIntensity: Darkness of shadows from 0 to 1.
        rgbBackground: Red, green and blue from 0 to 1.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, an argument is not three finite numbers, or a number is not finite.

    Examples:
        >>> p.configureDebugVisualizer(p.COV_ENABLE_SHADOWS, 0)
    """
    from pybullet._window.options import VisualizerOptions

    client = client_of(physicsClientId)
    number, on = integer(flag, "flag"), integer(enable, "enable")
    options = VisualizerOptions(flags={number: on != 0} if number >= 0 else {})
    options.light_position = optional_vector3(
        lightPosition, "lightPosition needs 3 numbers.", "lightPosition"
    )
    options.background = optional_vector3(rgbBackground, "rgbBackground needs 3 numbers.", "rgbBackground")
    resolution = integer(shadowMapResolution, "shadowMapResolution")
    size = integer(shadowMapWorldSize, "shadowMapWorldSize")
    intensity = real(shadowMapIntensity, "shadowMapIntensity")
    interval = real(remoteSyncTransformInterval, "remoteSyncTransformInterval")
    options.shadow_map_resolution = resolution if resolution > 0 else None
    options.shadow_map_world_size = size if size > 0 else None
    options.shadow_map_intensity = intensity if intensity >= 0.0 else None
    options.remote_sync_transform_interval = interval if interval >= 0.0 else None
    client.window.configure(options)
    if options.flags.get(COV_ENABLE_SINGLE_STEP_RENDERING):
        client.window.draw_now()
        with client.call_lock:
            client.logs.shoot()


@exported
def resetDebugVisualizerCamera(
    cameraDistance: float,
    cameraYaw: float,
    cameraPitch: float,
    cameraTargetPosition: Vector,
    physicsClientId: int = 0,
) -> None:
    """Moves the camera of the window.

    It has no effect in `DIRECT`, with a negative distance, or if the target does not have three items.

    Args:
        cameraDistance: From the target to the camera [m].
        cameraYaw: About the upward axis [degrees].
        cameraPitch: Upwards; negative looks down from above [degrees].
        cameraTargetPosition: Point that the camera looks at [m].
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or a number is not finite.

    Examples:
        >>> p.resetDebugVisualizerCamera(1.5, 45, -30, [0, 0, 0.5])
    """
    client = client_of(physicsClientId)
    distance = real(cameraDistance, "cameraDistance")
    yaw, pitch = real(cameraYaw, "cameraYaw"), real(cameraPitch, "cameraPitch")
    problem = "cameraTargetPosition needs 3 numbers."
    target = optional_vector3(cameraTargetPosition, problem, "cameraTargetPosition")
    if distance >= 0.0 and target is not None:
        client.window.move_camera(distance, yaw, pitch, target)


@exported
def getDebugVisualizerCamera(physicsClientId: int = 0) -> tuple[Any, ...]:
    """Pose, matrices and image size of the window's camera.

    Args:
        physicsClientId: The connection.

    Returns:
        12 fields: 0 width and 1 height of the image in pixels; 2 view and 3 projection matrix, 16 numbers
        each, column after column; 4 upward direction of the world; 5 viewing direction; 6 and 7 the edges
        of the image to the right and upwards, at a distance of 10 km, for rays through pixels; 8 yaw and
        9 pitch [degrees]; 10 distance to the target and 11 the target [m]. All zeros in `DIRECT`.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> width, height, view = p.getDebugVisualizerCamera()[:3]
        >>> width, height, len(view)
        (0, 0, 16)
    """
    return client_of(physicsClientId).window.camera_info()


@exported
def getVREvents(
    deviceTypeFilter: int = 1, allAnalogAxes: int = 0, physicsClientId: int = 0
) -> tuple[tuple[Any, ...], ...]:
    """Events of virtual reality devices. Carom does not support such devices, so there are none.

    Args:
        deviceTypeFilter: `VR_DEVICE_*`, added up.
        allAnalogAxes: 1 for all axes of the devices.
        physicsClientId: The connection.

    Returns:
        An empty tuple.

    Raises:
        pybullet.error: Not connected.

    Examples:
        >>> p.getVREvents()
        ()
    """
    client_of(physicsClientId)
    integer(deviceTypeFilter, "deviceTypeFilter")
    integer(allAnalogAxes, "allAnalogAxes")
    return ()


@exported
def setVRCameraState(
    rootPosition: Vector | None = None,
    rootOrientation: Vector | None = None,
    trackObject: int = -2,
    trackObjectFlag: int = -1,
    physicsClientId: int = 0,
) -> None:
    """Moves the camera of a virtual reality headset. Carom does not support such devices: it has no effect.

    Args:
        rootPosition: Position of the room [m].
        rootOrientation: Its quaternion (x, y, z, w).
        trackObject: Body that the camera follows.
        trackObjectFlag: `VR_CAMERA_TRACK_OBJECT_ORIENTATION` to turn with it.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or an argument is not three, or four, finite numbers.

    Examples:
        >>> p.setVRCameraState(rootPosition=[0, 0, 1])
    """
    client_of(physicsClientId)
    optional_vector3(rootPosition, "rootPosition needs 3 numbers.", "rootPosition")
    optional_rotation(rootOrientation, "rootOrientation needs 4 numbers.", "rootOrientation")
    integer(trackObject, "trackObject")
    integer(trackObjectFlag, "trackObjectFlag")
