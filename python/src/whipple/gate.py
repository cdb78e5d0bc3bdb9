"""The one gate through which bytes of HDF5 files come in, which anybody may have made.

HDF5 follows links into other files, unpacks what is compressed and fills as much memory as a file
declares. The gate passes what the program writes and nothing else: objects behind hard links, arrays
that lie in one piece inside the file, and types that the program uses. Type, shape and place are
compared with the length of the file before anything is read.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import TracebackType
from typing import Any, Self

import h5py
import numpy as np
from numpy.typing import NDArray

from . import files
from .errors import DamagedError, damaged

_NUMBERS = frozenset(np.dtype(name) for name in ("f8", "f4", "i8", "u8", "u4", "u1"))
_LONGEST_NOTE = 64 << 10
_LONGEST_TEXT = 64 << 20
_MOST_MEMBERS = 256
_MOST_COMPONENTS = 9


class Gate:
    """A file of HDF5 open for reading, in a `with` block."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self._bytes = files.length(path)
        with self._told("it cannot be opened"):
            self._file = h5py.File(path, "r")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._file.close()

    def members(self, group: str) -> list[str]:
        """Names in a group, in alphabetical order."""
        with self._told(group):
            found = self._object(group, h5py.Group)
            if len(found) > _MOST_MEMBERS:
                raise ValueError(f"it has more than {_MOST_MEMBERS} members")
            return sorted(found)

    def form(self, path: str) -> tuple[np.dtype[Any], tuple[int, ...]]:
        """Type and shape of an array of numbers with one or two indices."""
        with self._told(path):
            found = self._array(path)
            return found.dtype, found.shape

    def array(self, path: str) -> NDArray[Any]:
        """An array of numbers with one or two indices."""
        with self._told(path):
            values: NDArray[Any] = self._array(path)[()]
            return values

    def text(self, path: str) -> str:
        """A text that stands in an array of its own."""
        with self._told(path):
            found = self._piece(path)
            if found.dtype.kind != "S" or found.shape != (1,):
                raise ValueError(f"{found.dtype} of shape {found.shape} is no text")
            if found.dtype.itemsize > _LONGEST_TEXT:
                raise ValueError("it is too long")
            return bytes(found[0]).decode("utf-8")

    def note(self, path: str, name: str) -> str | None:
        """A text that stands beside an object; none if there is no such."""
        with self._told(f"{name} of {path}"):
            value = self._attribute(path, name, lambda kind: kind.kind == "S")
            return None if value is None else bytes(value).decode("utf-8")

    def count(self, path: str, name: str) -> int:
        """A whole number that stands beside an object."""
        with self._told(f"{name} of {path}"):
            value = self._attribute(path, name, lambda kind: kind == np.dtype("u8"))
            if value is None:
                raise ValueError("it is missing")
            return int(value)

    @contextmanager
    def _told(self, what: str) -> Iterator[None]:
        """Tells whatever HDF5 finds wrong as an error of this package."""
        try:
            yield
        except DamagedError:
            raise
        except (OSError, RuntimeError, ValueError, TypeError, LookupError, OverflowError) as error:
            raise damaged(self.path, f"{what}: {error}") from error

    def _object(self, path: str, kind: type) -> Any:
        found: Any = self._file
        for part in path.strip("/").split("/"):
            links = found.id.links
            name = part.encode()
            if not links.exists(name):
                raise LookupError("it is missing")
            if links.get_info(name).type != h5py.h5l.TYPE_HARD:
                raise ValueError("it is a link to elsewhere")
            found = found[part]
        if not isinstance(found, kind):
            raise TypeError("it is an object of another kind")
        return found

    def _piece(self, path: str) -> Any:
        """An array that lies in one piece inside the file. One that is put together from other
        files opens these when it is asked for its shape, so its layout comes first."""
        found = self._object(path, h5py.Dataset)
        made = found.id.get_create_plist()
        if made.get_layout() != h5py.h5d.CONTIGUOUS or made.get_nfilters() != 0:
            raise ValueError(
                "it is compressed or in pieces (h5repack -f NONE -l CONTI undoes that)"
            )
        if made.get_external_count() != 0:
            raise ValueError("it lies in another file")
        size = math.prod(found.shape) * found.dtype.itemsize
        begin = found.id.get_offset()
        if size > 0 and (begin is None or begin + size > self._bytes):
            raise ValueError(f"its {size} bytes are more than the file has")
        return found

    def _array(self, path: str) -> Any:
        found = self._piece(path)
        shape = found.shape
        if len(shape) not in (1, 2) or not all(1 <= n <= _MOST_COMPONENTS for n in shape[1:]):
            raise ValueError(f"unexpected shape {shape}")
        if found.dtype not in _NUMBERS:
            raise ValueError(f"unexpected type {found.dtype}")
        return found

    def _attribute(self, path: str, name: str, is_right: Any) -> Any:
        found = self._object(path, h5py.HLObject)
        if not h5py.h5a.exists(found.id, name.encode()):
            return None
        stored = h5py.h5a.open(found.id, name.encode())
        if stored.shape != () or not is_right(stored.dtype):
            raise ValueError(f"unexpected {stored.dtype} of shape {stored.shape}")
        if stored.dtype.itemsize > _LONGEST_NOTE:
            raise ValueError("it is too long")
        return found.attrs[name]
