"""Which functions of generated code are inlined, and how the others take structs.

Inlined functions are quicker: what they read of structs stays in registers. But where all are inlined at
each call, with all that they call, compilers take minutes for the largest kernels. So some long functions are
called, which `kernels.types.called_func` marks.

Warp passes structs by value. Those of arrays have thousands of bytes, so functions that are called take
references. They read a field where they use it: by `__restrict`, compilers know that what a function stores
is no part of the struct. Whoever calls them is given both, the value, whose fields stay in registers, and the
reference, to pass it on.
"""

from __future__ import annotations

import re
from collections.abc import Collection, Mapping, Sequence, Set

_INLINED, _CALLED = "static WP_FORCEINLINE ", "static __attribute__((noinline)) "
_FUNCTION = re.compile(
    rf"^{_INLINED}(?P<head>[^\n(]*?(?P<name>\w+)\(\n[^{{}}]*?\)\n{{\n)(?P<body>.*?^}}\n)", re.M | re.S
)
_CALL = re.compile(r"(?<![\w:])(\w+)\(")
_STATEMENT = re.compile(r"^(?P<start> +(?:\w+ = )?)(?P<name>\w+)\((?P<arguments>.*)\);$", re.M)
_STRUCT = r"\w+_[0-9a-f]{8}"
_PARAMETER = re.compile(rf"^ +(?P<type>{_STRUCT}) var_(?P<name>\w+)(?=[,)])", re.M)
_KERNEL = re.compile(
    r"^(?P<head>static void \w+_cpu_kernel_forward\(\n[^{}]*\)\n{\n)(?P<body>.*?^}\n)", re.M | re.S
)
_ARGUMENT = re.compile(rf"^ +(?P<type>{_STRUCT}) var_(?P<name>\w+) = (?P<value>_wp_args->\w+);\n", re.M)


def inlined(source: str, called: Set[str]) -> str:
    """The generated code of a module, in which the functions of these names are called, not inlined."""
    takers = _takers(source, called)

    def changed(function: re.Match[str]) -> str:
        name, head, body = function["name"], function["head"], function["body"]
        structs = [one["name"] for one in _PARAMETER.finditer(head)]
        if name in called:
            same = _unchanged(structs, body)

            def referring(parameter: re.Match[str]) -> str:
                kind, struct = parameter["type"], parameter["name"]
                return f"    {kind} & __restrict var_{struct}" if struct in same else parameter[0]

            return _CALLED + _PARAMETER.sub(referring, head) + _with_whole(body, (), takers, called)
        if name in takers:
            head = _PARAMETER.sub(r"\g<0>,\n    \g<type> & whole_\g<name>", head)
            body = _with_whole(body, structs, takers, called)
        return _INLINED + head + body

    def changed_kernel(kernel: re.Match[str]) -> str:
        body = kernel["body"]
        passed = _with_whole(body, [one["name"] for one in _ARGUMENT.finditer(body)], takers, called)
        if passed != body:
            wholes = (
                r"    \g<type> & whole_\g<name> = \g<value>;\n    \g<type> var_\g<name> = whole_\g<name>;\n"
            )
            body = _ARGUMENT.sub(wholes, passed)
        return kernel["head"] + body

    return _KERNEL.sub(changed_kernel, _FUNCTION.sub(changed, source))


def _takers(source: str, called: Set[str]) -> dict[str, list[bool]]:
    """Functions that take references to structs, with which of their parameters are structs.

    These are the functions that are called, and those that call them, directly or not; functions come after
    those that they call.
    """
    takers: dict[str, list[bool]] = {}
    for function in _FUNCTION.finditer(source):
        name = function["name"]
        if name in called or not takers.keys().isdisjoint(_CALL.findall(function["body"])):
            parameters = function["head"].split("\n")[1:-2]
            takers[name] = [bool(_PARAMETER.match(one)) for one in parameters]
    return takers


def _unchanged(structs: Collection[str], body: str) -> set[str]:
    """Those of the structs that this body does not change."""
    return {name for name in structs if not re.search(rf"^ +var_{name}(?:\.\w+)* = (?!_wp_args)", body, re.M)}


def _with_whole(
    body: str, structs: Collection[str], takers: Mapping[str, Sequence[bool]], called: Set[str]
) -> str:
    """A body that passes on references to structs: `whole_` those that it has got, unless it changes them."""
    wholes = {f"var_{name}": f"whole_{name}" for name in _unchanged(structs, body)}

    def changed(call: re.Match[str]) -> str:
        name = call["name"]
        if name not in takers:
            return call[0]
        arguments = call["arguments"].split(", ")
        for place, is_struct in enumerate(takers[name]):
            if is_struct:
                whole = wholes.get(arguments[place], arguments[place])
                arguments[place] = whole if name in called else f"{arguments[place]}, {whole}"
        return f"{call['start']}{name}({', '.join(arguments)});"

    return _STATEMENT.sub(changed, body)
