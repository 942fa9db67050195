"""Examples run: those of docstrings, and those of the README."""

from __future__ import annotations

import doctest
import inspect
import re
from pathlib import Path

import pytest

import parry_continuum
from parry_continuum import Mesh, Motion, RigidMotion, RobotPair, Scene, SelfQuery

CLASSES = [Mesh, Scene, RobotPair, SelfQuery, Motion, RigidMotion]
METHODS = {
    f"{owner.__name__}.{name}": getattr(owner, name)
    for owner in CLASSES
    for name in vars(owner)
    if not name.startswith("_")
}
DOCUMENTED = {
    "parry_continuum": parry_continuum,
    **{name: getattr(parry_continuum, name) for name in parry_continuum.__all__ if name != "__version__"},
    **METHODS,
}
WITHOUT_PARAMETERS = {"Mesh.prepare", "Mesh.surface", "RobotPair.forget", "SelfQuery.forget"}
PAGE = Path(__file__).parent.parent / "README.md"
README = PAGE.read_text()


@pytest.mark.parametrize("name", DOCUMENTED)
def test_docstrings(name: str) -> None:
    text = DOCUMENTED[name].__doc__
    assert text and len(text) > 25, f"{name} is not documented"
    if callable(DOCUMENTED[name]) and name in METHODS and name not in WITHOUT_PARAMETERS:
        assert all(section in text for section in ("Parameters", "Raises")), f"{name} lacks a section"
    test = doctest.DocTestParser().get_doctest(text, {}, name, None, None)
    assert doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(test).failed == 0


BY_NAME = {"margin", "prominence", "reach", "resolution", "tolerance"}


@pytest.mark.parametrize("name", [name for name, value in DOCUMENTED.items() if inspect.isroutine(value)])
def test_lengths_of_a_query_are_given_by_name(name: str) -> None:
    for parameter in inspect.signature(DOCUMENTED[name]).parameters.values():
        assert (parameter.name not in BY_NAME) or parameter.kind is inspect.Parameter.KEYWORD_ONLY, parameter


def test_most_methods_have_examples() -> None:
    assert sum(">>>" in value.__doc__ for value in METHODS.values()) > 10


def test_readme(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    blocks = list(re.finditer(r"```python\n(.*?)```", README, re.DOTALL))
    assert len(blocks) > 4
    monkeypatch.chdir(tmp_path)
    names: dict[str, object] = {}
    for block in blocks:
        lines_before = README[: block.start(1)].count("\n") * "\n"
        exec(compile(lines_before + block[1], PAGE, "exec"), names)
