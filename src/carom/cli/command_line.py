"""The command line `python -m carom`: commands that need few words, and the table of all."""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Iterable, Sequence
from pathlib import Path

import pybullet_data
from carom.cli.arguments import named_value, positive
from carom.cli.docs_command import add_docs
from carom.cli.examples_command import add_examples
from carom.cli.export import add_export
from carom.cli.record_command import add_record
from carom.cli.view_command import add_view
from carom.description import Pose
from carom.description.pose import IDENTITY
from carom.description.transform import compose
from carom.errors import CaromError
from carom.formats.search import AssetSearch
from carom.layouts.flags import LoadFlags
from carom.model.body_spec import BASE, BodySpec
from carom.native.library import library
from carom.soft.from_urdf import urdf_body
from carom.version import __version__
from carom.world.robot_files import Choices, read_robot_file

OK, FAILED = 0, 1


def main(arguments: Sequence[str] | None = None) -> int:
    """Run one command.

    Args:
        arguments: Words of the command line; None for those of the process.

    Returns:
        Exit status: 0 for success, 1 if the command failed, for example because a file cannot be used. For a
        wrong command line argparse ends the process with status 2.
    """
    options = _parser().parse_args(arguments)
    failed = False
    try:
        failed = options.command(options)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader has closed the pipe, as `head` does; keep Python from writing the rest at exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    except (CaromError, OSError, ValueError) as problem:
        print(f"carom: {problem}", file=sys.stderr)
        return FAILED
    return FAILED if failed else OK


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="carom", description="A robot simulator that runs PyBullet scripts."
    )
    parser.add_argument("--version", action="version", version=f"carom {__version__}")
    commands = parser.add_subparsers(title="commands", required=True, metavar="COMMAND")

    info = commands.add_parser("info", help="print the joint and link tables of a robot file")
    info.add_argument(
        "file", type=Path, help="URDF, SDF or MJCF file; files of pybullet_data are found by name"
    )
    info.add_argument("--scale", type=positive, default=1.0, help="factor on all lengths (default 1)")
    info.add_argument("--fixed-base", action="store_true", help="fix the base in the world")
    info.add_argument(
        "--as-pybullet", action="store_true", help="read URDF as PyBullet does, not as its author meant it"
    )
    info.add_argument(
        "--inertia-from-file",
        action="store_true",
        help="with --as-pybullet: use <inertia>, not the collision shapes",
    )
    info.add_argument("--merge-fixed-links", action="store_true", help="merge links that cannot move")
    info.set_defaults(command=_info)

    check = commands.add_parser("check", help="list what in robot files is not simulated")
    check.add_argument(
        "files",
        type=Path,
        nargs="+",
        metavar="FILE",
        help="URDF, SDF or MJCF file; files of pybullet_data are found by name",
    )
    check.add_argument("--strict", action="store_true", help="exit status 1 if anything is not simulated")
    check.add_argument(
        "--package-path",
        action="append",
        default=[],
        metavar="FOLDER",
        help="folder of ROS packages, or that is one; can be given several times",
    )
    check.add_argument(
        "--without-meshes", action="store_true", help="leave out shapes whose mesh is missing, and list them"
    )
    check.add_argument(
        "--xacro-arg",
        action="append",
        type=named_value,
        default=[],
        metavar="NAME=VALUE",
        help="argument of a xacro file; can be given several times",
    )
    check.set_defaults(command=_check)

    add_view(commands)
    add_record(commands)
    add_export(commands)

    convert = commands.add_parser("convert", help="write an SDF, MJCF, URDF or USD file as URDF, MJCF or USD")
    convert.add_argument("input", type=Path, help="SDF, MJCF, URDF or USD file")
    convert.add_argument(
        "output", type=Path, help="file to write: .urdf, .xml (MJCF) or .usd, .usda, .usdc, .usdz"
    )
    convert.add_argument(
        "--model", help="robot to convert to URDF or USD if the file has several: name or number from 0"
    )
    convert.set_defaults(command=_convert)

    serve = commands.add_parser("serve", help="serve a world that scripts in other processes can join")
    serve.add_argument(
        "--key", type=int, default=12347, help="shared-memory key, as in connect (default 12347)"
    )
    for transport, port in (("tcp", 6667), ("udp", 1234)):
        serve.add_argument(
            f"--{transport}",
            type=int,
            nargs="?",
            const=port,
            metavar="PORT",
            help=f"also accept clients of connect(p.{transport.upper()}) (default port {port})",
        )
    serve.add_argument("--bind", default="127.0.0.1", help="address of these ports (default 127.0.0.1)")
    serve.add_argument(
        "--key-file", type=Path, help="file with the key that clients need; created if it does not exist"
    )
    serve.add_argument("--gui", action="store_true", help="show the world in the browser")
    serve.add_argument("--gui-port", type=int, help="port to serve the page at")
    serve.set_defaults(command=_serve)

    data = commands.add_parser(
        "data", help="say which files pybullet_data serves, and serve your own copy of PyBullet's"
    )
    choice = data.add_mutually_exclusive_group()
    choice.add_argument(
        "--from-pybullet",
        type=Path,
        metavar="PATH",
        help="copy PyBullet's files and serve them: a wheel of PyBullet, its folder pybullet_data, or the "
        "site-packages with it",
    )
    choice.add_argument("--own", action="store_true", help="serve Carom's own files again")
    data.set_defaults(command=_data)

    stand_in = commands.add_parser(
        "stand-in", help="install an empty distribution named pybullet, for packages that require PyBullet"
    )
    stand_in.add_argument(
        "--wheel", type=Path, metavar="FOLDER", help="only write its wheel there, for other environments"
    )
    stand_in.set_defaults(command=_stand_in)

    add_docs(commands)
    add_examples(commands)

    warmup = commands.add_parser("warmup", help="compile the physics kernels now, once for this machine")
    warmup.set_defaults(command=_warmup)
    return parser


def _info(options: argparse.Namespace) -> None:
    flags = LoadFlags.NONE
    if options.inertia_from_file:
        flags |= LoadFlags.USE_INERTIA_FROM_FILE
    if options.merge_fixed_links:
        flags |= LoadFlags.MERGE_FIXED_LINKS
    if options.as_pybullet:
        search = AssetSearch(Path(pybullet_data.getDataPath()))
        specs = [
            urdf_body(options.file, search, scale=options.scale, flags=flags, fixed_base=options.fixed_base)
        ]
    else:
        choices = Choices(options.fixed_base, options.scale, int(flags))
        specs = [spec for spec, _ in read_robot_file(options.file, choices).bodies]
    print("\n\n\n".join(map(describe, specs)))


def _check(options: argparse.Namespace) -> bool:
    from carom.cli.check import check

    choices = Choices(
        strict=options.strict,
        package_paths=options.package_path,
        missing_meshes="warn" if options.without_meshes else "error",
        xacro_args=dict(options.xacro_arg),
    )
    return not check(options.files, choices)


def _convert(options: argparse.Namespace) -> None:
    from carom.cli.convert import convert

    lost = convert(options.input, options.output, options.model)
    if lost:
        print(f"{options.output} does not say all that {options.input} says:\n{lost}")


def _serve(options: argparse.Namespace) -> None:
    from carom.cli.serve import Service, serve

    stated = {"tcp": options.tcp, "udp": options.udp, "port": options.gui_port, "key-file": options.key_file}
    words = [f'--{name}="{value}"' for name, value in stated.items() if value is not None]
    serve(Service(options.key, options.gui, [f"--bind={options.bind}", *words]))


def _data(options: argparse.Namespace) -> None:
    from carom.cli import pybullet_files
    from pybullet_data._copies import VARIABLE, served_copy

    if options.from_pybullet is not None:
        pybullet_files.take_over(options.from_pybullet)
    elif options.own:
        pybullet_files.serve_own()
    if named := os.environ.get(VARIABLE):
        print(f"{VARIABLE} is {named}: here pybullet_data serves {pybullet_data.getDataPath()}")
    if served_copy() is None:
        print("pybullet_data serves Carom's own files.")
    else:
        copy = pybullet_files.check()
        print(f"pybullet_data serves the {copy.count} files of PyBullet {copy.version}, in {copy.folder}")


def _stand_in(options: argparse.Namespace) -> None:
    from carom.cli import stand_in

    if options.wheel is not None:
        print(f"Wrote {stand_in.write(options.wheel)}")
    else:
        stand_in.install()
        print(f"Packages that require PyBullet now find pybullet {stand_in.VERSION}, which stands for Carom.")


def _warmup(_options: argparse.Namespace) -> None:
    began = time.perf_counter()
    library()
    print(f"The physics kernels are ready, after {time.perf_counter() - began:.1f} s.")


def describe(spec: BodySpec) -> str:
    """The joint table and the link table of a body, as text."""
    movable = sum(link.joint_type.value != "fixed" for link in spec.links)
    base = "fixed" if spec.fixed_base else "floating"
    joints = "joint" if movable == 1 else "joints"
    heading = f"{spec.name}: {len(spec.links) + 1} links, {movable} movable {joints}, {base} base"
    return "\n\n".join([heading, _joint_table(spec), _link_table(spec)])


def _joint_table(spec: BodySpec) -> str:
    header = ["#", "joint", "type", "axis", "limits", "effort", "velocity", "damping", "friction", "parent"]
    rows = []
    for index, link in enumerate(spec.links):
        movable = link.joint_type.value != "fixed"
        drive = (link.effort, link.velocity, link.damping, link.friction)
        rows.append(
            [
                str(index),
                link.joint_name,
                link.joint_type.value,
                _numbers(link.joint_axis) if movable else "",
                f"{link.lower:g} .. {link.upper:g}" if link.limited else "",
                *(f"{value:g}" if movable else "" for value in drive),
                spec.link(link.parent).name,
            ]
        )
    return (
        _table(header, rows)
        + "\nAxes are in the joint frame. Units: rad, N m, s, and for prismatic joints m, N, s."
    )


def _link_table(spec: BodySpec) -> str:
    header = ["#", "link", "mass", "inertia", "centre of mass", "position", "orientation", "shapes"]
    poses = link_poses(spec)
    rows = [
        [
            str(index),
            link.name,
            f"{link.mass:g}",
            _numbers(link.inertia),
            _numbers(link.inertial_frame.position),
            _numbers(poses[index].position),
            _numbers(poses[index].orientation),
            str(len(link.collisions)),
        ]
        for index, link in [(BASE, spec.base), *enumerate(spec.links)]
    ]
    return _table(header, rows) + (
        "\nPrincipal inertia; centre of mass in the link frame; link frame in the base's, all joints at 0,"
        "\norientation x y z w; number of collision shapes. Units: kg, m."
    )


def link_poses(spec: BodySpec) -> dict[int, Pose]:
    """Poses of the link frames in the base's link frame, with all joints at 0, by link index."""
    poses = {BASE: IDENTITY}
    for index, link in enumerate(spec.links):
        poses[index] = compose(poses[link.parent], link.joint_frame)
    return poses


def _numbers(values: Iterable[float]) -> str:
    # Adding 0 converts -0 to 0.
    return " ".join(f"{value + 0.0:.4g}" for value in values)


def _table(header: list[str], rows: list[list[str]]) -> str:
    widths = [max(map(len, column)) for column in zip(header, *rows, strict=True)]
    lines = [header, ["-" * width for width in widths], *rows]
    return "\n".join(
        "  ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True)).rstrip()
        for line in lines
    )
