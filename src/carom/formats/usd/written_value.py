"""Writing attributes of prims: of the schema in single precision, and as doubles beside them."""

from __future__ import annotations

from typing import Any

from carom.description import Pose
from carom.formats.usd.exact import PREFIX, is_exact
from carom.formats.usd.library import Library

# The types of doubles beside those of single precision.
_EXACT = {
    "Float": "Double",
    "Float3": "Double3",
    "Point3f": "Double3",
    "Vector3f": "Double3",
    "Quatf": "Quatd",
}


class Values:
    """Writes attributes into a stage."""

    def __init__(self, pxr: Library, stage: Any) -> None:
        self._pxr = pxr
        self._stage = stage

    def put(self, prim: Any, name: str, kind: str, value: Any) -> None:
        """Write an attribute; of numbers that are no floats the double as well."""
        self._create(prim, name, kind, value)
        if kind in _EXACT and not is_exact(value):
            self._create(prim, PREFIX + name, _EXACT[kind], value)

    def place(self, prim: Any, pose: Pose) -> None:
        """Write the pose of a prim in that around it."""
        shown = self._pxr.UsdGeom.Xformable(prim)
        double = self._pxr.UsdGeom.XformOp.PrecisionDouble
        shown.AddTranslateOp(double).Set(self._pxr.Gf.Vec3d(*pose.position))
        x, y, z, w = pose.orientation
        shown.AddOrientOp(double).Set(self._pxr.Gf.Quatd(w, x, y, z))

    def _create(self, prim: Any, name: str, kind: str, value: Any) -> None:
        gf, of = self._pxr.Gf, self._pxr.Sdf.ValueTypeNames
        if kind in ("Quatf", "Quatd"):
            x, y, z, w = value
            value = getattr(gf, kind)(w, x, y, z)
        elif kind in ("Float3", "Point3f", "Vector3f"):
            value = gf.Vec3f(*value)
        elif kind == "Double3":
            value = gf.Vec3d(*value)
        custom = not name.startswith(("physics:", "drive:", "limit:"))
        prim.CreateAttribute(name, getattr(of, kind), custom).Set(value)
