"""The command `python -m carom view`: simulates files in the browser, without a script."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from carom.cli.arguments import named_value, positive
from carom.engine.parameters import BULLET, CONVERGED


def add_view(commands: Any) -> None:
    """Add it to the commands of a parser."""
    view = commands.add_parser("view", help="simulate robots, scenes and saved worlds in the browser")
    view.add_argument(
        "files",
        type=Path,
        nargs="+",
        metavar="FILE",
        help="URDF, xacro, SDF, MJCF or USD file, saved world, or mesh (GLB, OBJ, STL, DAE, PLY); files of "
        "pybullet_data are found by name",
    )
    view.add_argument("--play", action="store_true", help="play at once; without it the simulation is paused")
    view.add_argument(
        "--gravity",
        type=float,
        nargs="+",
        metavar="G",
        help="gravity along z, or x, y and z [m/s²]; without it as the files say",
    )
    view.add_argument("--time-step", type=positive, metavar="S", help="time step [s]; without it as they say")
    view.add_argument("--contact", choices=(BULLET, *CONVERGED), help=f"law of contact (default {BULLET})")
    view.add_argument("--fixed-base", action="store_true", help="fix the bases of URDF files in the world")
    view.add_argument(
        "--package-path",
        action="append",
        default=[],
        metavar="FOLDER",
        help="folder of ROS packages, or that is one; can be given several times",
    )
    view.add_argument(
        "--xacro-arg",
        action="append",
        type=named_value,
        default=[],
        metavar="NAME=VALUE",
        help="argument of a xacro file; can be given several times",
    )
    view.add_argument("--host", default="127.0.0.1", help="address to serve the page at (default 127.0.0.1)")
    view.add_argument(
        "--port", type=int, help="port to serve the page at (default 8400, or any other that is free)"
    )
    view.set_defaults(command=_view)


def _view(options: argparse.Namespace) -> None:
    from carom.simulator.simulator import Simulator, Start
    from carom.viewer.display import tunnel_command
    from carom.world.robot_files import Choices

    choices = Choices(
        fixed_base=options.fixed_base,
        package_paths=options.package_path,
        missing_meshes="warn",
        xacro_args=dict(options.xacro_arg) or None,
    )
    start = Start(choices, _settings(options), options.play, options.host, options.port)
    simulator = Simulator(options.files, start)
    names = ", ".join(it.name for it in options.files)
    # The address ends the line, because terminals take text right after an address as part of it.
    print(f"Ctrl-C ends it. {names} is shown at {simulator.viewer.address}", flush=True)
    if tunnel := tunnel_command(simulator.viewer.address):
        print(f"Over SSH: run '{tunnel}' on your own machine, then open the address there.", flush=True)
    try:
        simulator.viewer.open_browser()
        simulator.run()
    except KeyboardInterrupt:
        pass
    finally:
        simulator.close()


def _settings(options: argparse.Namespace) -> dict[str, Any]:
    """The parameters that the command line states."""
    settings: dict[str, Any] = {}
    if options.gravity is not None:
        if len(options.gravity) not in (1, 3):
            raise ValueError(f"--gravity needs one number, along z, or three, not {len(options.gravity)}")
        settings["gravity"] = tuple([0.0, 0.0, *options.gravity][-3:])
    if options.time_step is not None:
        settings["time_step"] = options.time_step
    if options.contact is not None:
        settings["contact"] = options.contact
    return settings
