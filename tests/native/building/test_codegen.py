"""What is written for the modules of kernels together, without translating any."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import pytest

codegen = pytest.importorskip("carom.native.building.codegen")


class _Alone:
    """Stands for a pool of processes."""

    def __init__(self, *_: object) -> None:
        pass

    def __enter__(self) -> _Alone:
        return self

    def __exit__(self, *_: object) -> None:
        pass

    def map(self, call: Callable[[str], Any], names: Iterable[str]) -> list[Any]:
        return [call(name) for name in names]


@pytest.fixture
def generate(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[..., dict[str, Any]]:
    """Calls `generate` for modules with kernels of these names, and returns the manifest."""

    def generated(**kernels: list[str]) -> dict[str, Any]:
        def of(name: str) -> Any:
            entries = {key: {"module": name, "dimensions": 1} for key in kernels[name]}
            return codegen._Generated(f"// {name}\n", entries, {})

        monkeypatch.setattr(codegen, "ProcessPoolExecutor", _Alone)
        monkeypatch.setattr(codegen, "_generate_module", of)
        codegen.generate([*kernels], "digest", tmp_path)
        return json.loads((tmp_path / codegen.MANIFEST).read_text(encoding="utf-8"))

    return generated


def test_kernels_of_all_modules_are_in_the_manifest(
    generate: Callable[..., dict[str, Any]], tmp_path: Path
) -> None:
    manifest = generate(one=["b_kernel", "c_kernel"], two=["a_kernel"])
    assert [*manifest["kernels"]] == ["a_kernel", "b_kernel", "c_kernel"]
    assert manifest["kernels"]["a_kernel"]["module"] == "two"
    assert manifest["digest"] == "digest"
    assert {file.name for file in tmp_path.glob("*.cpp")} == {"one.cpp", "two.cpp"}


def test_two_modules_cannot_have_kernels_of_one_name(generate: Callable[..., dict[str, Any]]) -> None:
    with pytest.raises(codegen.KernelClash, match="one and two both have a kernel 'a_kernel'"):
        generate(one=["a_kernel"], two=["a_kernel"])
