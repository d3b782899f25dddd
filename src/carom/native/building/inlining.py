"""Which functions of generated code are inlined, and how the others take structs.

Inlined functions are quicker: what they read of structs stays in registers. But where all are inlined at
each call, with all that they call, compilers take minutes for the largest kernels. So a function is called if
it is long with what is inlined into it; a call costs little beside what it does.

Warp passes structs by value. Those of arrays have thousands of bytes, so functions that are called take
references. What they read of a struct they copy first, as kernels do: compilers cannot know that the numbers
that a function stores are not those of the struct, and would read it again after each.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Set

# The length from which on functions are called, in characters of generated code.
_LONG = 160_000
_INLINED, _CALLED = "static WP_FORCEINLINE ", "static __attribute__((noinline)) "
_FUNCTION = re.compile(
    rf"^{_INLINED}(?P<head>[^\n(]*?(?P<name>\w+)\(\n[^{{}}]*?\)\n{{\n)(?P<body>.*?^}}\n)", re.M | re.S
)
_CALL = re.compile(r"(?<![\w:])(\w+)\(")
_STRUCT = r"\w+_[0-9a-f]{8}"
_PARAMETER = re.compile(rf"^ +(?P<type>{_STRUCT}) var_(?P<name>\w+)(?=[,)])", re.M)
_KERNEL = re.compile(
    r"^(?P<head>static void \w+_cpu_kernel_forward\(\n[^{}]*\)\n{\n)(?P<body>.*?^}\n)", re.M | re.S
)
_ARGUMENT = re.compile(rf"^ +(?P<type>{_STRUCT}) var_(?P<name>\w+) = (?P<value>_wp_args->\w+);\n", re.M)


def inlined(source: str) -> str:
    """The generated code of a module, in which only short functions are inlined."""
    called, by_reference = _called_functions(source)

    def changed(function: re.Match[str]) -> str:
        name, head, body = function["name"], function["head"], function["body"]
        if name in by_reference:
            structs = [(one["type"], one["name"]) for one in _PARAMETER.finditer(head)]
            copies = "".join(f"    {kind} var_{struct} = whole_{struct};\n" for kind, struct in structs)
            head = _PARAMETER.sub(r"    \g<type> & whole_\g<name>", head)
            body = copies + _with_whole(body, [struct for _, struct in structs], by_reference)
        return (_CALLED if name in called else _INLINED) + head + body

    def changed_kernel(kernel: re.Match[str]) -> str:
        body = kernel["body"]
        structs = [one["name"] for one in _ARGUMENT.finditer(body)]
        passed = _with_whole(body, structs, by_reference)
        if passed != body:
            wholes = (
                r"    \g<type> & whole_\g<name> = \g<value>;\n    \g<type> var_\g<name> = whole_\g<name>;\n"
            )
            body = _ARGUMENT.sub(wholes, passed)
        return kernel["head"] + body

    return _KERNEL.sub(changed_kernel, _FUNCTION.sub(changed, source))


def _called_functions(source: str) -> tuple[set[str], set[str]]:
    """Names of the long functions, and of those that take structs by reference: these, and who calls them.

    Functions come after those that they call.
    """
    lengths: dict[str, int] = {}
    called: set[str] = set()
    by_reference: set[str] = set()
    for function in _FUNCTION.finditer(source):
        name, body = function["name"], function["body"]
        calls = _CALL.findall(body)
        length = len(body) + sum(lengths.get(other, 0) for other in calls)
        if length > _LONG:
            called.add(name)
            length = 0
        if name in called or not by_reference.isdisjoint(calls):
            by_reference.add(name)
        # Functions for several types share a name.
        lengths[name] = max(length, lengths.get(name, 0))
    return called, by_reference


def _with_whole(body: str, structs: Collection[str], by_reference: Set[str]) -> str:
    """A body that passes on the structs that it has got, not its copies, unless it changes them."""
    same = [name for name in structs if not re.search(rf"^ +var_{name}(?:\.\w+)* = (?!_wp_args)", body, re.M)]
    if not same:
        return body
    names = re.compile(rf"\bvar_({'|'.join(same)})\b")
    return "".join(
        line if by_reference.isdisjoint(_CALL.findall(line)) else names.sub(r"whole_\1", line)
        for line in body.splitlines(keepends=True)
    )
