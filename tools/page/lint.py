"""Lint the JavaScript of the viewer's page and check its types; skipped without Node.js or its packages.

`make lint` runs it. ESLint and TypeScript are installed into `node_modules` beside it, in the versions of
`package-lock.json`, at the first run and after a change of that file.
"""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

HERE = Path(__file__).parent
WANTED = HERE / "package-lock.json"
INSTALLED = HERE / "node_modules" / ".package-lock.json"


def main() -> int:
    """Return the exit status of the checks; 0 if they cannot be made, which is said."""
    npm = shutil.which("npm")
    if npm is None:
        print("The page's JavaScript is not checked: that needs Node.js.")
        return 0
    if not INSTALLED.exists() or INSTALLED.stat().st_mtime < WANTED.stat().st_mtime:
        installing = subprocess.run([npm, "ci", "--silent", "--no-audit", "--no-fund"], cwd=HERE, check=False)
        if installing.returncode:
            print("The page's JavaScript is not checked: npm could not install ESLint and TypeScript.")
            return 0
    return subprocess.run([npm, "run", "--silent", "lint"], cwd=HERE, check=False).returncode


if __name__ == "__main__":
    raise SystemExit(main())
