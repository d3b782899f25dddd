"""Code of kernels for several worlds at once: the same functions over numbers of several lanes.

Warp's `float64` becomes `lanes::Lane` (`lanes.h`): one number of each world, in a vector register.
Comparisons of such numbers give a `lanes::Mask`, with which `wp.where` chooses in each lane for itself. A
branch on a mask would take all worlds the same way, so only `kernels.maths.lanes.in_some_world` may turn one
into a condition.
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


class BranchOnNumbers(Exception):
    """A kernel for lanes branches on a comparison of numbers, in which worlds may differ."""


def in_lanes(source: str) -> str:
    """The generated code of a module with numbers of several lanes.

    Raises:
        BranchOnNumbers: A function branches on a comparison of numbers.
    """
    source = _ADJOINT.sub("", source)
    kept = _TOPOLOGY.search(source)
    source = source.replace("wp::float64", "lanes::Lane")
    if kept:
        source = _TOPOLOGY.sub(lambda _: kept[0], source)
    source = _ASKED.sub("in_some_world_0(lanes::Mask ", source)
    source = _FUNCTION.sub(lambda function: _with_masks(function[0]), source)
    return source.replace(_HEADERS, _HEADERS + '#include "lanes.h"\n')


def _with_masks(function: str) -> str:
    numbers = set(_NUMBER.findall(function))
    masks = {name for name, *sides in _COMPARISON.findall(function) if numbers.intersection(sides)}
    masks |= {name for name, negated in _NEGATION.findall(function) if negated in masks}
    for name in masks:
        if re.search(rf"\b(?:if|while) \(!?{name}\)", function):
            raise BranchOnNumbers(
                "a kernel for lanes branches on numbers, which may differ between worlds; "
                f"use wp.where:\n{function}"
            )
        function = re.sub(rf"^( +)bool {name};", rf"\1lanes::Mask {name};", function, flags=re.M)
    return function
