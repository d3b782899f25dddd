"""Placeholder for PyBullet's EGL plugin: `p.loadPlugin(<this file>, "_eglRendererPlugin")`.

The module is empty, because Carom's `getCameraImage` needs neither a display nor a plugin. PyBullet has a
library of this name, which scripts look up with `pkgutil.get_loader("eglRenderer")`.
"""
