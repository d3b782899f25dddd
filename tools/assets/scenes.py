"""SDF files: the KUKA with a gripper, grippers, floors and a shelf."""

from __future__ import annotations

from tools.assets import kuka
from tools.assets.measured import Dress, dressed, place, recorded
from tools.assets.parts import Box, Cylinder, Mesh, Paint, Robot, Shape

from carom.description import Pose

Scene = list[tuple[Robot, Pose]]

STEEL = Paint("steel", (0.62, 0.64, 0.67, 1.0), (0.6, 0.6, 0.6))
DARK = Paint("dark", (0.16, 0.17, 0.19, 1.0), (0.3, 0.3, 0.3))
RUBBER = Paint("rubber", (0.1, 0.1, 0.1, 1.0))
BLUE = Paint("blue", (0.15, 0.3, 0.6, 1.0), (0.2, 0.2, 0.2))
GRASS = Paint("grass", (1.0, 1.0, 1.0, 1.0))

GRIPPER_PAINT = {"*_tip": RUBBER, "finger_*": RUBBER, "base_link": DARK, "*": STEEL}
JAWS = (
    Shape(Box((0.146, 0.05, 0.07)), (0.0, 0.0, 0.03), paint=DARK),
    Shape(Cylinder(0.031, 0.014), (0.0, 0.0, -0.01), paint=STEEL),
)


def _scene(file: str, about: str, dress: Dress) -> Scene:
    return [
        (dressed(file, about, dress, number), place(file, number)) for number in range(len(recorded(file)))
    ]


def kuka_arm(file: str) -> Scene:
    """The arm, in most files with a gripper of two fingers at its end."""
    lenders = {link.name: link for link in kuka.model().links}
    dress = Dress(
        GRIPPER_PAINT, borrowed=lenders, more={"base_link": JAWS if file.endswith("gripper.sdf") else ()}
    )
    return _scene(file, "The KUKA LBR iiwa.", dress)


def wsg50(file: str) -> Scene:
    """A gripper whose one motor moves two fingers apart."""
    slide = Shape(Box((0.018, 0.03, 0.11)), (-0.007, 0.0, 0.035), paint=STEEL)
    seen = {"base_link": JAWS, "gripper_*": (slide,)}
    return _scene(file, "A gripper with two parallel fingers.", Dress(GRIPPER_PAINT, more=seen))


def wsg50_finger(file: str) -> Robot:
    """One of its fingers, on its own."""
    return dressed(file, "A finger of a gripper.", Dress({"*": RUBBER}, inertia_scaling=3.0))


def stadium(file: str) -> Scene:
    """A floor of grass."""
    floor = Shape(Mesh("grass.obj"), paint=GRASS)
    return _scene(
        file, "A field to run on.", Dress({"*": GRASS}, seen={"floor": (floor,), "link_d1": (floor,)})
    )


def kiva_shelf() -> Scene:
    """A pod of a warehouse."""
    return _scene("kiva_shelf/model.sdf", "A shelf as robots carry it about.", Dress({"*": BLUE}))
