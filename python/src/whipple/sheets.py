"""Tables as the files hold them: text with commas, or HDF5."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import files
from .errors import damaged
from .gate import Gate
from .table import Table

_UNITS = "# units:"
_SHARE = "# computed_share:"

# Columns of words, also where all words look like numbers, as names of bodies may.
_WORDS = frozenset(
    {
        "body",
        "body_a",
        "body_b",
        "direction",
        "distribution",
        "dt_reason",
        "figure",
        "gauge",
        "kind",
        "load",
        "measure",
        "unit",
        "unit_along",
        "witness",
    }
)


def from_csv(path: Path) -> Table:
    """A table of text. A last row that is cut off, since it is being written, does not count."""
    lines = io.StringIO(files.text(path, most=None)).readlines()
    try:
        records = csv.reader((line for line in lines if line[0] not in "#\r\n"), strict=False)
        rows = list(records)
        head = next((line for line in lines if line.startswith(_UNITS)), _UNITS)
        own_units = next(csv.reader([head.removeprefix(_UNITS).strip()]), [])
    except csv.Error as error:
        raise damaged(path, error) from error
    if not rows:
        raise damaged(path, "it is empty")
    names, *rows = rows
    names = [name.strip() for name in names]
    if len(set(names)) != len(names):
        raise damaged(path, "two of its columns have the same name")
    if rows and (len(rows[-1]) != len(names) or not lines[-1].endswith("\n")):
        rows.pop()
    for number, row in enumerate(rows, start=1):
        if len(row) != len(names):
            raise damaged(path, f"row {number} has {len(row)} values for {len(names)} columns")
    cells = list(zip(*rows)) if rows else [()] * len(names)
    columns = {name: _column(name, values) for name, values in zip(names, cells)}
    stated = {name: "" if unit == "-" else unit for name, unit in zip(names, own_units)}
    return Table(path.name, columns, stated, _share(path, lines))


def _share(path: Path, lines: Sequence[str]) -> float | None:
    """The share of the model that was computed, where a comment states it."""
    stated = next((line for line in lines if line.startswith(_SHARE)), None)
    if stated is None:
        return None
    try:
        share = float(stated.removeprefix(_SHARE))
    except ValueError as error:
        raise damaged(path, "its computed_share is no number") from error
    if not 0.0 < share <= 1.0:
        raise damaged(path, "its computed_share is no share")
    return share


def _column(name: str, cells: Sequence[str]) -> NDArray[Any]:
    """Whole numbers, else numbers, where an empty cell is none, else words."""
    words = np.array(cells, dtype=str)
    return words if name in _WORDS else numbers_or_words(words)


def numbers_or_words(words: NDArray[Any]) -> NDArray[Any]:
    """Words (n,) as numbers if all are; empty ones are NaN.

    >>> numbers_or_words(np.array(["1", "2"])), numbers_or_words(np.array(["1", ""]))
    (array([1, 2]), array([ 1., nan]))
    >>> numbers_or_words(np.array(["held", "perforated"]))
    array(['held', 'perforated'], dtype='<U10')
    """
    if len(words) == 0:
        return np.zeros(0)
    for kind in (np.int64, np.float64):
        try:
            filled = words if kind is np.int64 else np.where(words == "", "nan", words)
            return filled.astype(kind)
        except (ValueError, OverflowError):
            continue
    return words


def from_hdf5(path: Path) -> Table:
    """A table of HDF5."""
    with Gate(path) as file:
        names = file.text("columns").split("\n")
        words = np.array(file.text("words").split("\n"), dtype=str)
        columns: dict[str, NDArray[Any]] = {}
        stated: dict[str, str] = {}
        for name in names:
            place = f"table/{name}"
            values = file.array(place)
            if values.ndim != 1 or len(values) != len(columns.get(names[0], values)):
                raise damaged(path, f"column {name!r} has another length than the first")
            if values.dtype == np.uint32:
                if values.max(initial=0) >= len(words):
                    raise damaged(path, f"column {name!r} has words that are not there")
                values = words[values]
            columns[name] = values
            stated[name] = file.note(place, "unit") or ""
    return Table(path.name, columns, stated)


def figures(measures: Table) -> Table:
    """Of a table with a row for each figure that with a row for each time.

    A column `MEASURE.FIGURE` for each figure, and `MEASURE.FIGURE.uncertainty` where one is told.
    What is not told at a time is NaN, or an empty word.
    """
    times, row_of = np.unique(measures["time"], return_inverse=True)
    columns: dict[str, NDArray[Any]] = {"time": times}
    stated = {"time": measures.unit("time")}
    names = np.char.add(np.char.add(measures["measure"], "."), measures["figure"])
    for name in dict.fromkeys(names.tolist()):
        own = names == name
        unit = str(measures["unit"][own][0])
        for column, end in (("value", ""), ("uncertainty", ".uncertainty")):
            cells = np.zeros(len(times), dtype=object)
            cells[:] = ""
            cells[row_of[own]] = measures[column][own].astype(str)
            values = numbers_or_words(cells.astype(str))
            is_number = values.dtype.kind in "if"
            values = values.astype(float) if is_number else values
            if column == "uncertainty" and not (is_number and bool(np.isfinite(values).any())):
                continue
            columns[name + end] = values
            stated[name + end] = unit if is_number else ""
    return Table("the figures of measures.csv", columns, stated)
