"""What hand-written C++ shares with Python is declared in `carom.layouts`, and is there what users see."""

import ctypes
from dataclasses import fields

import pytest

import pybullet as p
from carom.layouts import codes, motor_commands
from carom.layouts.contacts import Shapes
from carom.layouts.dynamics_parameters import BODY, CHANGE_DYNAMICS, OF_SHAPES, PARAMETERS, SHAPE, SURFACE
from carom.layouts.model import Model, State
from carom.layouts.quick import bodies as quick_bodies
from carom.layouts.quick.world import Scene
from carom.layouts.records import Int32, Read, c_record
from carom.model.link_dynamics import LinkDynamics, ShapeSurface
from carom.native.building.headers import _comment, _record, header
from carom.native.tables import ArrayTable, fields_of
from pybullet._bodies.dynamics import _IN_ORDER
from pybullet._calls.builtin import exports


def test_codes_are_those_of_pybullet() -> None:
    assert (codes.LINK_FRAME, codes.WORLD_FRAME) == (p.LINK_FRAME, p.WORLD_FRAME)
    of_motors = (motor_commands.VELOCITY, motor_commands.TORQUE, motor_commands.POSITION, motor_commands.PD)
    assert of_motors == (p.VELOCITY_CONTROL, p.TORQUE_CONTROL, p.POSITION_CONTROL, p.PD_CONTROL)


def test_parameters_of_change_dynamics_are_those_of_the_function() -> None:
    code = exports["changeDynamics"].code
    assert list(CHANGE_DYNAMICS) == list(code.co_varnames[: code.co_argcount])


def test_rows_of_bodies_are_as_long_as_those_of_the_state() -> None:
    rows = fields_of(State)
    assert rows["link_pose"].shape[0] == quick_bodies.POSE_NUMBERS
    for name in ("link_twist", "link_wrench", "link_reaction"):
        assert rows[name].shape[0] == quick_bodies.SPATIAL_NUMBERS
    for name in ("dof_motor", "dof_pd"):
        assert rows[name].shape[0] == quick_bodies.MOTOR_NUMBERS


def test_quick_calls_change_attributes_that_there_are() -> None:
    assert all(hasattr(LinkDynamics, name) for name in SURFACE)


@c_record()
class Inner:
    """An inner record."""

    count: Int32


@c_record(rows=(2, 3))
class Outer:
    """An outer record.

    Attributes:
        rows: Many.
    """

    inner: Inner
    rows: Inner
    next: Read[Int32]


def test_a_record_is_a_struct_in_both_languages() -> None:
    assert ctypes.sizeof(Outer) == 40
    text = _record(Outer)
    assert "// An outer record.\n//\n// Attributes:\n//     rows: Many.\nstruct Outer {\n" in text
    assert "    Inner inner;\n    Inner rows[2][3];\n    const int32_t* next;\n};\n" in text
    assert 'static_assert(sizeof(Outer) == 40, "size of Outer");' in text
    assert 'static_assert(__builtin_offsetof(Outer, next) == 32, "place of Outer.next");' in text


def test_the_header_has_each_name_once() -> None:
    lines = [line for line in header().splitlines() if line.startswith(("struct ", "enum ", "namespace "))]
    assert len(lines) == len({line.split()[1] for line in lines})
    assert f"constexpr int32_t SURFACE_COUNT = {len(SURFACE)};" in header()
    assert Scene.__name__ in {line.split()[1] for line in lines}


@pytest.mark.parametrize("docstring", ["One line.", "Two paragraphs.\n\n    The second is here.\n    "])
def test_docstrings_become_comments(docstring: str) -> None:
    assert all(line.startswith("//") for line in _comment(docstring).splitlines())


def test_parameters_are_attributes_of_links_and_fields_of_tables() -> None:
    of_worlds = {"activation_state", "joint_limit_force", "joint_friction"}
    of_bodies = {name for name, row in PARAMETERS.items() if row.owner == BODY}
    of_links = {field.name for field in fields(LinkDynamics)}
    assert PARAMETERS.keys() - of_links == of_worlds | of_bodies
    assert of_links - PARAMETERS.keys() == {"joint_limit_impulse", "surfaces"}
    assert {field.name for field in fields(ShapeSurface)} == set(OF_SHAPES)
    model, shapes = ArrayTable(Model).numpy, ArrayTable(Shapes).numpy
    for row in PARAMETERS.values():
        assert not row.field or row.field in (shapes if row.owner == SHAPE else model), row.name


def test_arguments_are_taken_in_an_order_with_all_of_them() -> None:
    first = {"localInertiaDiagonal", "anisotropicFriction"}
    first |= {"jointLowerLimit", "jointUpperLimit", "jointLimitForce", "sleepThreshold"}
    assert {*_IN_ORDER} | first == {row.argument for row in PARAMETERS.values() if row.argument}
