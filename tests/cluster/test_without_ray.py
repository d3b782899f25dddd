"""What is said where a package is missing."""

import subprocess
import sys

import pytest


@pytest.mark.parametrize(
    ("module", "missing", "cure"),
    [
        ("carom.cluster", "ray", "pip install 'carom[ray]'"),
        ("carom.cluster", "gymnasium", "pip install 'carom[ray]'"),
        ("carom.cluster.rllib", "ray.rllib", "pip install 'ray[rllib]' torch"),
    ],
)
def test_what_is_missing_is_named_with_the_cure(module, missing, cure):
    if missing == "ray.rllib":
        pytest.importorskip("ray", reason="needs Ray: make cluster")
    script = f"import sys; sys.modules[{missing!r}] = None; import {module}"
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    last = result.stderr.strip().splitlines()[-1]
    assert last.startswith("ImportError: ")
    assert module in last
    assert last.endswith(f"install it with: {cure}")
