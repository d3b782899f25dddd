"""How a function is called: arguments, errors, builtins, constants."""
