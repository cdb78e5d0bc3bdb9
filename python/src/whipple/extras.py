"""Packages that only some uses need."""

from __future__ import annotations

import importlib
from typing import Any

from .errors import Error


def load(package: str) -> Any:
    """The package, or an error that says how to get it."""
    try:
        return importlib.import_module(package)
    except ImportError as error:
        raise Error(f"this needs the package {package}: pip install {package} ({error})") from error
