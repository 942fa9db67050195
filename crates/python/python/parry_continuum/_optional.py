"""Imports of packages that only some functions need."""

from __future__ import annotations

import importlib
from typing import Any


def optional(module: str, *, function: str, extra: str) -> Any:
    """Imports a module of an optional package. Its absence is an error that names the extra."""
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        text = f"{function} needs {package}: pip install 'parry-continuum[{extra}]'"
        raise ImportError(text, name=error.name, path=error.path) from error
