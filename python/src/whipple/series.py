"""What a run has written again and again, opened when it is asked for."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import cached_property
from pathlib import Path
from typing import Generic, TypeVar, overload

import numpy as np
from numpy.typing import NDArray

from .errors import Error

T = TypeVar("T")


class Series(Sequence[T], Generic[T]):
    """Files in the order of their steps: by number, by slice, or by time.

    >>> snapshots = whipple.open("runs/quarter-impact").snapshots
    >>> snapshots[0].step, len(snapshots[1:]) == len(snapshots) - 1
    (0, True)
    """

    def __init__(
        self,
        what: str,
        paths: Mapping[int, Path],
        open_file: Callable[[Path], T],
        time_of: Callable[[int, Path], float],
    ) -> None:
        self._what = what
        self._paths = dict(paths)
        self._open = open_file
        self._time_of = time_of

    @property
    def steps(self) -> NDArray[np.int64]:
        """Step of each (n,)."""
        return np.array(list(self._paths), dtype=np.int64)

    @cached_property
    def times(self) -> NDArray[np.float64]:
        """Time of each (n,), s."""
        return np.array([self._time_of(*entry) for entry in self._paths.items()], dtype=np.float64)

    @property
    def paths(self) -> list[Path]:
        """File of each."""
        return list(self._paths.values())

    def __len__(self) -> int:
        return len(self._paths)

    def __iter__(self) -> Iterator[T]:
        return (self._open(path) for path in self._paths.values())

    @overload
    def __getitem__(self, key: int) -> T: ...
    @overload
    def __getitem__(self, key: slice) -> Series[T]: ...

    def __getitem__(self, key: int | slice) -> T | Series[T]:
        if isinstance(key, slice):
            chosen = dict(list(self._paths.items())[key])
            return Series(self._what, chosen, self._open, self._time_of)
        if not -len(self) <= key < len(self):
            raise IndexError(f"no number {key} of {len(self)} {self._what}")
        return self._open(self.paths[key])

    def at(self, time: float) -> T:
        """The one nearest in time (s); of two that are as near the earlier.

        >>> snapshots = whipple.open("runs/quarter-impact").snapshots
        >>> snapshots.at(0.02e-6).step == snapshots[1].step
        True
        """
        if len(self) == 0:
            raise Error(f"there are no {self._what}")
        return self[int(np.argmin(np.abs(self.times - time)))]

    def __repr__(self) -> str:
        return f"<{len(self)} {self._what}>"
