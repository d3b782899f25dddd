"""Stands for the file in which `carom.code_bundle` keeps compiled modules; nothing imports it.

The file is where Python would keep this module compiled, so that what removes a package, or its compiled
files, removes that file as well.
"""
