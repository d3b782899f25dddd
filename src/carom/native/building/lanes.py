"""Code of kernels for several worlds at once: the same functions over numbers of several lanes.

Warp's `float64` becomes `lanes::Lane` (`lanes.h`): one number of each world, in a vector register.
Comparisons of such numbers give a `lanes::Mask`, with which `wp.where` chooses in each lane for itself.

A branch on a mask is taken if it is true in some lane. Warp gives each variable that a branch changes a new
name in it, and chooses between both with `wp.where` after it; so branches that only change variables are
right in each lane. Others, which store something, return or loop, would take all worlds the same way, and are
refused; `kernels.maths.lanes.in_some_world` allows them.
"""

from __future__ import annotations

import re

_HEADERS = '#include "arrays.h"\n'
# Structs of topology, which all worlds share, have numbers that no kernel in lanes reads; their layout stays.
_ADJOINT = re.compile(
    r"^static (?:WP_FORCEINLINE )?CUDA_CALLABLE [^\n(]*\b(?:adj_\w+|add)\(.*?^}\n", re.M | re.S
)
_TOPOLOGY = re.compile(r"^struct TreeModel_.*?^};\n", re.M | re.S)
_FUNCTION = re.compile(r"^(?:static|CAROM_EXPORT) [^\n]*\(.*?^}\n", re.M | re.S)
_NUMBER = re.compile(r"^ +(?:const )?lanes::Lane (\w+)\b", re.M)
_COMPARISON = re.compile(r"^ +(\w+) = \((\w+) (?:[<>]=?|[=!]=) (\w+)\);", re.M)
_NEGATION = re.compile(r"^ +(\w+) = wp::unot\((\w+)\);", re.M)
_ASKED = re.compile(r"in_some_world_0\(\s*bool ")
_NAME = re.compile(r"(\w+)\(")
_BODY = re.compile(r"^{\n(.*?)^}\n", re.M | re.S)
# Lines that change nothing but variables.
_ASSIGNMENT = re.compile(r" +var_\w+ = (?!.*\batomic_).*;|$")
_CHANGE = re.compile(rf"{_ASSIGNMENT.pattern}| +if \(!?\w+\) \{{| +\}}")
_DECLARATION = re.compile(r" +(?:const )?[\w:]+(?:<[^;()]*>)?\*? var_\w+(?: = [^;]*)?;| +return\b.*;")
_CALL = re.compile(r"(?<![\w:])(\w+)\(")


class BranchOnNumbers(Exception):
    """By more than values, a kernel for lanes depends on a comparison of numbers, which worlds differ in."""


def in_lanes(source: str) -> str:
    """The generated code of a module with numbers of several lanes.

    Raises:
        BranchOnNumbers: A function uses a comparison of numbers for more than to choose between values.
    """
    source = _ADJOINT.sub("", source)
    kept = _TOPOLOGY.search(source)
    source = source.replace("wp::float64", "lanes::Lane")
    if kept:
        source = _TOPOLOGY.sub(lambda _: kept[0], source)
    source = _ASKED.sub("in_some_world_0(lanes::Mask ", source)
    pure = _pure_functions(source)
    source = _FUNCTION.sub(lambda function: _with_masks(function[0], pure), source)
    return source.replace(_HEADERS, _HEADERS + '#include "lanes.h"\n')


def _pure_functions(source: str) -> set[str]:
    """Names of the functions that only compute a value; those that are called come first in the source."""
    pure: set[str] = set()
    for function in _FUNCTION.finditer(source):
        name, body = _NAME.search(function[0]), _BODY.search(function[0])
        if name and body and _only_computes(body[1], pure, and_declares=True):
            pure.add(name[1])
    return pure


def _only_computes(code: str, pure: set[str], *, and_declares: bool = False) -> bool:
    """Whether lines of code do nothing but to change variables."""
    return all(
        (_CHANGE.fullmatch(line) or (and_declares and _DECLARATION.fullmatch(line)))
        and all(name in pure for name in _CALL.findall(line))
        for line in code.splitlines()
    )


def _with_masks(function: str, pure: set[str]) -> str:
    numbers = set(_NUMBER.findall(function))
    masks = {name for name, *sides in _COMPARISON.findall(function) if numbers.intersection(sides)}
    masks |= {name for name, negated in _NEGATION.findall(function) if negated in masks}
    for name in masks:
        branches = re.findall(rf"^( +)if \(!?{name}\) {{\n(.*?)^\1}}\n", function, re.M | re.S)
        chooses = rf"bool {name};|{name} = .*;|\w+ = (?:wp::(?:where|unot)|in_some_world_0)\({name}[,)]"
        others = re.findall(rf"^ +(?! |{chooses}).*\b{name}\b", function, re.M)
        if len(others) > len(branches) or not all(_only_computes(body, pure) for _, body in branches):
            raise BranchOnNumbers(
                "a kernel for lanes depends on a comparison of numbers, which may differ between worlds, by "
                f"more than values; choose these with wp.where:\n{function}"
            )
        function = re.sub(rf"^( +)bool {name};", rf"\1lanes::Mask {name};", function, flags=re.M)
    return function
