"""The software bill of materials of a wheel, in the format of CycloneDX: what its library is made of."""

from __future__ import annotations

import json
from importlib import metadata
from typing import Any

# Build requirements whose code is compiled in: distribution, component, its licence, and what of it is in.
_PARTS = (
    ("warp-lang", "warp", "Apache-2.0", "declarations and inline functions for kernels"),
    ("ziglang", "zig-compiler-rt", "MIT", "compiler runtime"),
    ("ziglang", "musl", "MIT", "mathematical functions, from the copy in Zig"),
)


def bill_of_materials(version: str) -> str:
    """JSON that names Carom's version and what is compiled in; the same for the same versions.

    Raises:
        PackageNotFoundError: A build requirement is not installed.
    """
    components: list[dict[str, Any]] = []
    for distribution, name, licence, what in _PARTS:
        found = metadata.version(distribution)
        components.append(
            {
                "type": "library",
                "bom-ref": name,
                "name": name,
                "version": found if name != "musl" else f"in ziglang {found}",
                "description": what,
                "licenses": [{"license": {"id": licence}}],
                "purl": f"pkg:pypi/{distribution}@{found}",
            }
        )
    bill = {
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "version": 1,
        "metadata": {
            "component": {
                "type": "library",
                "bom-ref": "carom",
                "name": "carom",
                "version": version,
                "licenses": [{"license": {"id": "MIT"}}],
                "purl": f"pkg:pypi/carom@{version}",
            }
        },
        "components": components,
        "dependencies": [{"ref": "carom", "dependsOn": [part["bom-ref"] for part in components]}],
    }
    return json.dumps(bill, indent=2) + "\n"
