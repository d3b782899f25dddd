"""Tendons of MJCF files, and actuators of tendons and sites, for the bodies made from the files."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from carom.description.pose import Pose
from carom.description.tendon import WORLD, PathPart, TendonSpec
from carom.description.transform import compose
from carom.layouts.codes import PathKind
from carom.model.body_spec import BASE
from carom.scene.actuators.actuated_joint import needs_transmission
from carom.scene.named_constraints.named_constraint import yield_as
from carom.scene.tendons.coupling import TendonCoupling
from carom.scene.tendons.making import new_tendon, new_tendon_coupling, new_transmission

if TYPE_CHECKING:
    from carom.formats.mjcf.compiled.model import CompiledModel, FilePart, FileTendon
    from carom.scene.core.body_core import BodyCore
    from carom.scene.user_constraints import UserConstraint

_WORLD = "world"


def add_tendons(bodies: Sequence[BodyCore], model: CompiledModel, place: Pose) -> list[TendonCoupling]:
    """Make the tendons of a file, whose frame is at `place`; called while bodies are added.

    Returns:
        Their couplings.
    """
    own = {body.name: body for body in bodies}
    tendons: dict[str, UserConstraint] = {}
    for it in model.tendons.values():
        if it.robot:
            body = own[it.robot]
            tendons[it.name] = new_tendon_at_rest(body, _spec(body, it, place))
            body.world.add_constraint(tendons[it.name])
    made = []
    for it in model.tendon_couplings:
        leader = None if it.leader is None else tendons[it.leader]
        constraint = new_tendon_coupling(tendons[it.follower], leader, it.coefficients, it.name)
        constraint.enabled = it.enabled
        yield_as(constraint, it.compliance)
        constraint.parent.world.add_constraint(constraint)
        made.append(TendonCoupling(constraint))
    for body in bodies:
        for number, actuator in enumerate(body.spec.actuators):
            if needs_transmission(actuator):
                transmission = new_transmission(body, number, actuator, _sites(body, model, place))
                body.world.add_constraint(transmission)
    return made


def new_tendon_at_rest(body: BodyCore, spec: TendonSpec) -> UserConstraint:
    """The constraint of a tendon; where its spring is at rest follows from where those of joints are."""
    world = body.world
    positions = world.arrays.state.numpy["position"][0]
    before = positions.copy()
    if spec.spring_range is None:
        for index, link in enumerate(body.spec.links):
            first, count = body.position_index[index], body.position_count[index]
            positions[first : first + count] = link.spring_rest
    body.update_link_poses()
    made = new_tendon(body, spec)
    positions[:] = before
    body.update_link_poses()
    return made


def _links(body: BodyCore) -> dict[str, int]:
    return {body.spec.link(i).name: i for i in reversed(range(BASE, len(body.spec.links)))}


def _spec(body: BodyCore, tendon: FileTendon, place: Pose) -> TendonSpec:
    links = _links(body)
    joints = {link.joint_name: index for index, link in enumerate(body.spec.links)}

    def at(name: str) -> int:
        return WORLD if name in (_WORLD, "") else links[name]

    def part(it: FilePart) -> PathPart:
        if it.kind in (PathKind.JOINT, PathKind.BALL):
            return PathPart(it.kind, joints[it.on], size=it.size)
        pose, side = it.frame, it.side if it.side_on else None
        if it.on == _WORLD:
            pose = compose(place, pose)
        if it.side_on == _WORLD:
            side = compose(place, Pose(it.side)).position
        return PathPart(it.kind, at(it.on), pose, it.size, at(it.side_on), side)

    return TendonSpec(
        tendon.name,
        tuple(map(part, tendon.parts)),
        tendon.stiffness,
        tendon.damping,
        tendon.spring_range,
        tendon.range,
        tendon.friction,
        tendon.limit_compliance,
        tendon.limit_margin,
        tendon.armature,
        tendon.look,
        tendon.stiffness_terms,
    )


def _sites(body: BodyCore, model: CompiledModel, place: Pose) -> Callable[[str], tuple[int, Pose]]:
    """Where the sites of a file are, by name: a link of a body, or the world."""
    links = _links(body)

    def find(name: str) -> tuple[int, Pose]:
        site = model.sites[name]
        if site.body in links and site.body != _WORLD:
            return links[site.body], site.frame
        return WORLD, compose(place, compose(model.still[site.body], site.frame))

    return find
