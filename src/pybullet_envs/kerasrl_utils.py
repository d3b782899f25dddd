"""Names of files with saved weights: `folder/Agent-v0-Environment-v1-20170701190920_actor.h5`."""

from __future__ import annotations

import glob
import re
from typing import Any

weight_save_re = re.compile(r"^(?:\w+/)+?(\w+-v\d+)-(\w+-v\d+)-(\d+)(?:_\w+)?\.(\w+)$")


def get_fields(weight_save_name: str) -> tuple[str, str, int]:
    """Agent, environment and number in a file name; raises `ValueError` if it does not have this form."""
    match = weight_save_re.search(weight_save_name)
    if match is None:
        raise ValueError(f"the file name {weight_save_name!r} does not match {weight_save_re.pattern}")
    return match[1], match[2], int(match[3])


def get_latest_save(file_folder: str, agent_name: str, env_name: str, version_number: Any) -> Any:
    """Agent, environment and number of the file with the greatest number; an empty list if there is none.

    Args:
        file_folder: Folder, with a slash at its end.
        agent_name: The agent.
        env_name: The environment.
        version_number: Not used.
    """
    saves = map(get_fields, glob.glob(f"{file_folder}*.h5"))
    asked = [save for save in saves if save[:2] == (agent_name, env_name)]
    return max(asked, key=lambda save: save[2], default=[])
