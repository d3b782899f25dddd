"""Differences that docs/differences states: they are counted, and not reported.

Each is recognised by what differs and by what the program has done before (`calls.py`). A new one belongs
here only with the words that docs/differences has about it, or with a reason why it is no difference.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from tools.differ.assets import GEAR
from tools.differ.causes.calls import (
    MASSES,
    NO_SUCH_LINK,
    NOT_A_GEAR,
    NOT_THE_SAME_BODY,
    SEEN_TO_BE_NEARER,
    Seen,
    aims_a_ball_joint_by_a_number,
    aims_half_a_turn_away,
    balls,
    comes_near_bare_links,
    error,
    forgets_forces,
    frames_are_rotations,
    goes_on_with_masses,
    holds_a_ball_joint_by_no_rotation,
    holds_half_a_turn,
    is_near_what_no_rotation_turned,
    is_the_same_rotation,
    limits_what_has_none,
    names_its_links,
    numbers_a_child_first,
    pybullet_raises,
    reaches_with_a_ball_joint,
    restores_after_a_removal,
    spells_a_path_shorter,
    starts_at_a_limit,
    starts_with_a_ball_joint,
    turns_by_no_rotation,
)
from tools.differ.causes.flat import is_nearer_by_flat_hulls
from tools.differ.causes.images import draws_given_vertices, shades_along_the_link
from tools.differ.causes.nearest import (
    crosses_capsules,
    exchanges_points,
    has_the_margin_of_a_body,
    is_a_little_nearer,
    is_as_thick_as_a_margin,
    is_farther_from_a_fine_hull,
    is_the_shorter_way_out,
    is_thinner_than_its_margins,
    names_another_face,
    names_others,
)
from tools.differ.causes.poses import (
    breaks_contacts_by_rounding,
    is_deep_at_a_cylinder,
    looks_nowhere,
    starts_half_a_turn_away,
)
from tools.differ.causes.rays import (
    counts_hits,
    hits_another_at_the_same_place,
    hits_the_same_face,
    is_a_little_before,
)
from tools.differ.causes.rows import (
    asks_for_the_other_link,
    changes_mass_of_what_sleeps,
    drives_before_restoring,
    drives_from_a_limit,
    fixes_what_touches_itself,
    leaves_inertia_to_mjcf,
    lies_in_one_island,
    lists_in_another_order,
    renumbers_islands,
    reports_torques_as_friction,
    shares_with_a_limit,
    ties_a_link_taken_for_still,
    touches_its_parents_rigidly,
    touches_itself_rigidly,
    turns_next_to_nothing_about_one_line,
)
from tools.differ.compare import Difference
from tools.differ.programs import Call


@dataclass(frozen=True)
class Known:
    """A known difference.

    Attributes:
        says: Words of docs/differences.
        recognises: Whether a difference is one of this kind.
    """

    says: str
    recognises: Callable[[Seen], bool]


KNOWN: tuple[Known, ...] = (
    Known(
        "Every entry of `getCollisionShapeData` has the ids of its body and link",
        names_its_links,
    ),
    Known(
        "`getVisualShapeData` reports the texture that `changeVisualShape` has put on",
        lambda seen: (
            seen.call["f"] == "getVisualShapeData"
            and seen.difference.place.field.endswith(".8")
            and seen.has("changeVisualShape", "textureUniqueId")
        ),
    ),
    Known(
        "So texture ids leave out the textures of bodies that were",
        lambda seen: (
            seen.call["f"] == "getVisualShapeData"
            and seen.difference.place.field.endswith(".8")
            and seen.difference.place.theirs > seen.difference.place.ours >= 0
            and seen.has("removeBody")
        ),
    ),
    Known(
        "`getVisualShapeData` says where a geom given by `fromto` is",
        lambda seen: (
            seen.call["f"] == "getVisualShapeData"
            and seen.difference.place.field.endswith((".5", ".6"))
            and seen.difference.place.theirs in ([0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 1.0])
            and seen.has("loadMJCF")
        ),
    ),
    Known(
        "`createConstraint` refuses a child body or link that does not exist, and gears",
        lambda seen: (
            seen.call["f"] == "createConstraint"
            and ((NOT_A_GEAR in error(seen) and seen.call["a"][4] == GEAR) or NO_SUCH_LINK in error(seen))
        ),
    ),
    Known(
        "PyBullet numbers the fixed joints it makes of MJCF bodies",
        lambda seen: seen.differs("getJointInfo .1 ") and "jointfix" in str(seen.difference.place.theirs),
    ),
    Known(
        "`calculateJacobian` refuses links that do not exist",
        lambda seen: seen.call["f"] == "calculateJacobian" and NO_SUCH_LINK in error(seen),
    ),
    Known(
        "PyBullet exchanges the points of some pairs of links of one body",
        lambda seen: names_others(seen) and exchanges_points(seen),
    ),
    Known(
        "or name another face that is about as near",
        lambda seen: names_others(seen) and names_another_face(seen),
    ),
    Known(
        "PyBullet's search for the nearest points ends up to 0.2 mm too far away",
        lambda seen: (
            (seen.differs("getClosestPoints distance") and is_a_little_nearer(seen))
            or (seen.differs("getClosestPoints normal") and is_a_little_nearer(seen, SEEN_TO_BE_NEARER))
        ),
    ),
    Known(
        "Hulls of points that span no volume",
        lambda seen: (
            seen.differs("getClosestPoints distance", "getClosestPoints depth")
            and is_nearer_by_flat_hulls(seen)
        ),
    ),
    Known(
        "Hulls of very fine meshes are simplified",
        lambda seen: (
            seen.differs("getClosestPoints distance", "getClosestPoints depth")
            and is_farther_from_a_fine_hull(seen)
        ),
    ),
    Known(
        "Capsules that MJCF files give by two points",
        lambda seen: seen.differs("getClosestPoints depth") and crosses_capsules(seen),
    ),
    Known(
        "or what PyBullet's search takes for that, up to 2 cm more",
        lambda seen: seen.differs("getClosestPoints depth") and is_the_shorter_way_out(seen),
    ),
    Known(
        "Boxes thinner than twice their margin",
        lambda seen: (
            seen.differs("getClosestPoints distance", "getClosestPoints depth")
            and is_thinner_than_its_margins(seen)
        ),
    ),
    Known(
        "so it has the margin that `collisionMargin` gave",
        lambda seen: (
            seen.differs("getClosestPoints distance", "getClosestPoints depth")
            and has_the_margin_of_a_body(seen)
        ),
    ),
    Known(
        "PyBullet's end up",
        lambda seen: seen.differs("rayTest fraction", "rayTestBatch fraction") and is_a_little_before(seen),
    ),
    Known(
        "are off those of the faces they hit",
        lambda seen: seen.differs("rayTest normal", "rayTestBatch normal") and hits_the_same_face(seen),
    ),
    Known(
        "Those thinner than 4 cm are nearer in PyBullet",
        lambda seen: seen.differs("getClosestPoints distance") and is_as_thick_as_a_margin(seen),
    ),
    Known(
        "name files without doubled slashes",
        lambda seen: (
            seen.call["f"] in ("getCollisionShapeData", "getVisualShapeData")
            and seen.difference.place.field.endswith(".4")
            and spells_a_path_shorter(seen)
        ),
    ),
    Known(
        "Where a ray meets two bodies at the same place",
        lambda seen: seen.differs("rayTest hit", "rayTestBatch hit") and hits_another_at_the_same_place(seen),
    ),
    Known(
        "At a `distance` of 0",
        lambda seen: (
            seen.differs("getClosestPoints pairs", "getClosestPoints depth") and seen.call["a"][2:3] == [0]
        ),
    ),
    Known(
        "An index that is equal to the number of texts",
        lambda seen: seen.call["f"] == "getUserDataInfo" and "texts, so there is no" in error(seen),
    ),
    Known("or goes on with NaN", looks_nowhere),
    Known(
        "Which way a link turns that is exactly half a turn from its target",
        lambda seen: seen.differs("@reach worse") and starts_half_a_turn_away(seen),
    ),
    Known(
        "joints that turn no inertia",
        lambda seen: seen.differs("@probe") and leaves_inertia_to_mjcf(seen),
    ),
    Known(
        "Collision shapes made of vertices are drawn",
        lambda seen: seen.differs("getCameraImage segments") and draws_given_vertices(seen),
    ),
    Known(
        "their textures and shading lie otherwise",
        lambda seen: seen.differs("getCameraImage colour") and shades_along_the_link(seen),
    ),
    Known(
        "Limits that `changeDynamics` gives to fixed and spherical joints",
        lambda seen: seen.differs("@probe") and limits_what_has_none(seen),
    ),
    Known(
        "Whether a joint that stands exactly at its limit is beyond it",
        lambda seen: seen.differs("@probe") and (starts_at_a_limit(seen) or drives_from_a_limit(seen)),
    ),
    Known(
        "places links as if the base were larger by the square of that length",
        # What is reported of the start of a step is so after it, too.
        lambda seen: (
            (seen.differs("getLinkState", "getAABB") and turns_by_no_rotation(seen, 1))
            or (seen.differs("getClosestPoints") and is_near_what_no_rotation_turned(seen))
        ),
    ),
    Known(
        "the same rotation with the other sign",
        lambda seen: seen.differs("getLinkState", "getJointInfo .15") and is_the_same_rotation(seen),
    ),
    Known(
        "constraints, and the motors of spherical joints, to hold them there",
        lambda seen: (
            seen.differs("@probe")
            and (
                ((seen.has("createConstraint") or bool(balls(seen))) and turns_by_no_rotation(seen, 1))
                or holds_a_ball_joint_by_no_rotation(seen)
            )
        ),
    ),
    Known(
        "Rounding shows where links turn next to nothing",
        lambda seen: seen.differs("@probe") and turns_next_to_nothing_about_one_line(seen),
    ),
    Known(
        "the limit takes a part of what the motor holds",
        lambda seen: seen.differs("@probe") and shares_with_a_limit(seen),
    ),
    Known(
        "PyBullet also unites links of one robot that may not touch each other",
        lambda seen: seen.differs("@probe") and renumbers_islands(seen),
    ),
    Known(
        "relaxes such a constraint to the end, and then the motors",
        lambda seen: seen.differs("@probe") and ties_a_link_taken_for_still(seen),
    ),
    Known(
        "and whose base `changeDynamics` has fixed",
        lambda seen: seen.differs("@probe") and fixes_what_touches_itself(seen),
    ),
    Known(
        "with a fixed base and their parents",
        lambda seen: seen.differs("@probe") and touches_its_parents_rigidly(seen),
    ),
    Known(
        "keeps the weight it had",
        lambda seen: (
            seen.difference.phase == "free"
            and seen.differs("@probe", "getLinkState")
            and changes_mass_of_what_sleeps(seen)
        ),
    ),
    Known(
        "In PyBullet motors keep the targets they have",
        lambda seen: (
            (
                seen.has("restoreState")
                and seen.differs(
                    "getJointState .3", "getJointState .2", "getJointStates .", "@probe reactions"
                )
            )
            or (seen.differs("@probe") and drives_before_restoring(seen))
        ),
    ),
    Known(
        "forces applied before it are still applied",
        lambda seen: seen.differs("@probe") and forgets_forces(seen),
    ),
    Known(
        "`URDF_MAINTAIN_LINK_ORDER` numbers links as the file has them, but a link after its parent",
        numbers_a_child_first,
    ),
    Known(
        "PyBullet matches bodies by their order",
        lambda seen: (
            seen.call["f"] == "restoreState"
            and (
                (pybullet_raises(seen) and seen.has("removeBody"))
                or (NOT_THE_SAME_BODY.search(error(seen)) is not None and restores_after_a_removal(seen))
            )
        ),
    ),
    Known(
        "after a body was removed and",
        lambda seen: seen.differs("@probe", "get") and restores_after_a_removal(seen),
    ),
    Known(
        "PyBullet counts in the order in which it",
        lambda seen: seen.differs("rayTest") and counts_hits(seen),
    ),
    Known(
        "links without shapes have bounds as well",
        lambda seen: seen.differs("@probe") and comes_near_bare_links(seen),
    ),
    Known(
        "Which way a constraint, or the motor of a spherical joint, turns back",
        lambda seen: seen.differs("@probe") and (holds_half_a_turn(seen) or aims_half_a_turn_away(seen)),
    ),
    Known(
        "`applyExternalForce` and `applyExternalTorque` refuse links that do not exist.",
        lambda seen: seen.call["f"].startswith("applyExternal") and NO_SUCH_LINK in error(seen),
    ),
    Known(
        "`getConstraintInfo` reports frames as rotations, of length 1",
        lambda seen: seen.call["f"] == "getConstraintInfo" and frames_are_rotations(seen),
    ),
    Known(
        "PyBullet **remembers masses and inertias** from the first call",
        goes_on_with_masses,
    ),
    Known(
        "Bodies with spherical or planar joints always have Carom's search",
        reaches_with_a_ball_joint,
    ),
    Known(
        "PyBullet refuses `currentPositions` of robots with spherical joints",
        starts_with_a_ball_joint,
    ),
    Known(
        "Where PyBullet finds no answer at all for a body, it raises; here there is one.",
        lambda seen: seen.call["f"] in (*MASSES, "calculateInverseKinematics2") and pybullet_raises(seen),
    ),
    Known(
        "**A number as `targetPosition` of a spherical joint**",
        lambda seen: seen.differs("@probe", "getJointState") and aims_a_ball_joint_by_a_number(seen),
    ),
    Known(
        "Links that fixed joints tie to each other do not touch each other",
        lambda seen: (
            seen.differs("getContactPoints links", "getContactPoints .len") and touches_itself_rigidly(seen)
        ),
    ),
    Known("PyBullet leaves out those where the other link does.", asks_for_the_other_link),
    Known(
        "The arm and the target of `reacher.xml`",
        lambda seen: seen.differs("@probe") and lies_in_one_island(seen),
    ),
    Known(
        "normals differ by up to 3e-4 at",
        lambda seen: seen.differs("@probe") and is_deep_at_a_cylinder(seen),
    ),
    Known(
        "what turns against rolling as friction",
        lambda seen: seen.call["f"] == "getContactPoints" and reports_torques_as_friction(seen),
    ),
    Known(
        "sorts the pairs that meet in a step",
        lambda seen: seen.call["f"] == "getContactPoints" and lists_in_another_order(seen),
    ),
    Known(
        "PyBullet drops contacts whose two points rounding puts beside each other",
        lambda seen: seen.differs("@probe", "getContactPoints") and breaks_contacts_by_rounding(seen),
    ),
)


def statement(calls: Sequence[Call], difference: Difference) -> str | None:
    """The words of docs/differences about a difference; None if there are none."""
    seen = Seen(difference, calls[: difference.call + 1])
    return next((known.says for known in KNOWN if known.recognises(seen)), None)
