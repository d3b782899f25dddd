"""`python -m carom.viewer.protocol` writes what the page knows of the messages; for a clone."""

from __future__ import annotations

from carom.viewer.protocol.page_module import CONSTANTS, TYPES, constants, types

if __name__ == "__main__":
    CONSTANTS.write_text(constants(), encoding="utf-8", newline="\n")
    TYPES.write_text(types(), encoding="utf-8", newline="\n")
