"""Calls of public functions: arguments, errors, builtins, constants."""
