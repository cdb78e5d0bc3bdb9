"""Small text files, which anybody may have made."""

from __future__ import annotations

import json
import os
import re
import stat
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

from .errors import DamagedError, Error, damaged

# Bytes that a file of text other than a table or a log may have.
_SMALL = 64 << 20


def length(path: Path) -> int:
    """Bytes of a regular file; devices, pipes and folders are refused unopened."""
    try:
        status = os.stat(path)
    except (OSError, ValueError) as error:
        raise Error(f"cannot read {str(path)!r}: {error}") from error
    if not stat.S_ISREG(status.st_mode):
        raise DamagedError(f"{str(path)!r} is no regular file")
    return status.st_size


def text(path: Path, most: int | None = _SMALL) -> str:
    """A file of UTF-8, with at most so many bytes."""
    size = length(path)
    if most is not None and size > most:
        raise damaged(path, f"its {size} bytes are more than the {most} that it may have")
    try:
        # No more than was there when it was measured.
        with path.open("rb") as file:
            return file.read(size).decode("utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise damaged(path, error) from error


def json_table(path: Path) -> dict[str, Any]:
    """A file with one JSON object."""
    return _parsed(path, json.loads)


def toml_table(path: Path) -> dict[str, Any]:
    """A file of TOML."""
    return _parsed(path, tomllib.loads)


def _parsed(path: Path, parse: Callable[[str], Any]) -> dict[str, Any]:
    content = text(path)
    try:
        value = parse(content)
    except (ValueError, RecursionError) as error:
        raise damaged(path, error) from error
    if not isinstance(value, dict):
        raise damaged(path, "it holds no table of keys and values")
    return value


def steps(folder: Path, ending: str) -> dict[int, Path]:
    """Files `step-NNNNNNNN` with this ending in a folder, by step; none if there is no folder."""
    name = re.compile(rf"step-(\d{{8,18}}){re.escape(ending)}")
    try:
        entries = [(name.fullmatch(entry), folder / entry) for entry in os.listdir(folder)]
    except FileNotFoundError:
        return {}
    except OSError as error:
        raise Error(f"cannot list {str(folder)!r}: {error}") from error
    return dict(sorted((int(match[1]), path) for match, path in entries if match))
