"""The messages between a viewer and its pages, declared once for both sides.

`to_page` and `from_page` declare them. `python -m carom.viewer.protocol` writes their types as constants into
`page/protocol.js`, and their fields as types for `tsc` into `tools/page/messages.d.ts`.
"""
