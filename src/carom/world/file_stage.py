"""How the scene of an MJCF file is seen: its lights, sky, cameras and tendons, for windows on its world."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.description.pose import Pose
from carom.description.stage import Place, StageCamera
from carom.description.transform import compose, rotate
from carom.lazy_dataclasses import replace
from carom.render.appearance import appearance_of

if TYPE_CHECKING:
    from carom.formats.mjcf.compiled.model import CompiledModel
    from carom.world.scene import Scene

_AIMED = ("targetbody", "targetbodycom")
_STANDARD = (4.0, 3.0)


def put_on_stage(scene: Scene, model: CompiledModel, place: Pose) -> None:
    """Give the world of a scene, which has just been loaded at a place, the lights, sky and cameras of its file.

    If there are some already, those of the file are added.
    """
    links = {
        link.name: Place(body.id, link.index) for body in reversed(scene.bodies) for link in reversed(body.links)
    }

    def found(name: str, pose: Pose) -> tuple[Place, Pose]:
        """The link of a body of the file, and a pose in its frame; bodies that do not move are in the world."""
        if name in links and name != "world":
            return links[name], pose
        return Place(), compose(place, compose(model.still.get(name, Pose()), pose))

    lights = []
    for it in model.lights:
        at, pose = found(it.body, Pose(it.light.position))
        target = links.get(it.target) if it.mode in _AIMED else None
        direction = rotate(pose.orientation, it.light.direction)
        lights.append(replace(it.light, place=at, position=pose.position, direction=direction, target=target))
    cameras = []
    for camera in model.cameras.values():
        at, pose = found(camera.body, camera.frame)
        width, height = camera.resolution if min(camera.resolution) > 1 else _STANDARD
        target = links.get(camera.target) if camera.mode in _AIMED else None
        cameras.append(StageCamera(camera.name, at, pose, camera.field_of_view, width / height, target))
    stage = replace(
        model.stage,
        lights=tuple(lights),
        cameras=tuple(cameras),
        shows_tendons=any(it.robot and it.look is not None for it in model.tendons.values()),
    )
    appearance = appearance_of(scene.world)
    appearance.set_stage(stage if appearance.stage is None else appearance.stage + stage)
