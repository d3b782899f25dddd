"""Recordings, and the page that replays one without a server."""

from carom.viewer.replay.recorder import ReplayRecorder

__all__ = ["ReplayRecorder"]
