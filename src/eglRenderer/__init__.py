"""What scripts look up to render without a display: `p.loadPlugin(<its file>, "_eglRendererPlugin")`.

Carom's `getCameraImage` needs neither a display nor a plugin, so there is nothing in it. It is here because
PyBullet has a library of this name, and scripts find it by `pkgutil.get_loader("eglRenderer")`.
"""
