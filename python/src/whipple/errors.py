"""What can go wrong, and how it is told."""

from __future__ import annotations

import difflib
from collections.abc import Iterable
from pathlib import Path


class Error(Exception):
    """Something that the user can put right; the base of all errors of this package."""

    def __str__(self) -> str:
        # A KeyError, which some of these are, would quote its message.
        return str(self.args[0]) if self.args else ""


class DamagedError(Error):
    """A file that is not what the program writes."""


class MissingError(Error, AttributeError, KeyError):
    """A name that is not there; the message lists what is."""


def damaged(path: Path, reason: object) -> DamagedError:
    """That a file is not what it should be."""
    return DamagedError(f"{str(path)!r} is damaged, or no file of whipple: {reason}")


def missing(owner: str, what: str, name: object, there: Iterable[str]) -> MissingError:
    """That `owner` has no `what` of this name; names the nearest, and all that it has.

    >>> raise missing("the snapshot", "field", "presure", ["mass", "pressure"])
    Traceback (most recent call last):
    whipple.errors.MissingError: the snapshot has no field 'presure' (did you mean 'pressure'?); \
it has: mass, pressure
    """
    names = list(there)
    near = difflib.get_close_matches(str(name), names, n=1)
    hint = f" (did you mean {near[0]!r}?)" if near else ""
    listed = ", ".join(names) or "none"
    return MissingError(f"{owner} has no {what} {name!r}{hint}; it has: {listed}")
