"""Tables: columns with names and units."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import extras, units
from .errors import Error, missing

_AXES = ("_x", "_y", "_z")


class Table:
    """Columns of equal length, by name.

    A column is an array (n,) of numbers or words: `table.time`, or `table["time"]` where its name is
    that of a method. Three columns `force_x`, `force_y`, `force_z` are one of vectors (n, 3) too:
    `table.force`.

    >>> history = whipple.open("runs/quarter-impact").history
    >>> history.unit("kinetic_energy"), history.momentum.shape == (len(history), 3)
    ('J', True)
    """

    def __init__(
        self,
        title: str,
        columns: Mapping[str, NDArray[Any]],
        column_units: Mapping[str, str],
        computed_share: float | None = None,
    ) -> None:
        """Of columns (n,) and the units of those that have one."""
        self._title = title
        self._computed_share = computed_share
        self._columns = dict(columns)
        self._units = dict(column_units)
        for values in self._columns.values():
            values.setflags(write=False)

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of the columns, in order."""
        return tuple(self._columns)

    @property
    def computed_share(self) -> float | None:
        """Share of the model that was computed, of a table that tells the whole of one with symmetry planes.

        None where there are no planes. An earlier version states none in `history`, `contacts`, `loads`,
        `removed` and `departed`, which are then of what was computed.
        """
        return self._computed_share

    def __len__(self) -> int:
        """Number of rows."""
        return next((len(values) for values in self._columns.values()), 0)

    def __contains__(self, name: object) -> bool:
        return name in self._columns

    __iter__ = None  # Neither rows nor columns: say `table.columns`.

    def __getitem__(self, key: Any) -> Any:
        """A column by name, or a table of some rows: a mask (n,), numbers of rows or a slice.

        >>> run = whipple.open("runs/quarter-impact")
        >>> late = run.history[run.history.time > 0.0]
        >>> len(late) == len(run.history) - 1
        True
        """
        if isinstance(key, str):
            return self._column(key)
        if isinstance(key, (int, np.integer)):
            key = [key]
        chosen = {name: values[key] for name, values in self._columns.items()}
        return Table(self._title, chosen, self._units, self._computed_share)

    def __getattr__(self, name: str) -> NDArray[Any]:
        # Names with underscores in front are asked for by copy, pickle and notebooks.
        if name.startswith("_"):
            raise AttributeError(name)
        return self._column(name)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._columns]

    def _column(self, name: str) -> NDArray[Any]:
        if name in self._columns:
            return self._columns[name]
        parts = [name + axis for axis in _AXES]
        if all(part in self._columns for part in parts):
            return np.stack([self._columns[part] for part in parts], axis=1)
        raise missing(self._title, "column", name, self._columns)

    def unit(self, name: str) -> str:
        """Unit of a column as the file writes it; empty for none."""
        self._column(name)
        return self._units.get(name, self._units.get(name + _AXES[0], ""))

    def quantity(self, name: str) -> Any:
        """A column with its unit; needs pint."""
        return units.quantity(self._column(name), self.unit(name))

    def where(self, **values: object) -> Table:
        """The rows in which columns have these values.

        >>> bodies = whipple.open("runs/quarter-impact").bodies
        >>> sphere = bodies.where(body="sphere")
        >>> float(sphere.velocity_z[0])
        -7000.0
        """
        kept = np.ones(len(self), dtype=bool)
        for name, value in values.items():
            column = self._column(name)
            if isinstance(value, str) and value not in column:
                raise missing(self._title, name, value, sorted({str(cell) for cell in column}))
            kept &= column == value
        chosen = self[kept]
        assert isinstance(chosen, Table)
        return chosen

    def to_pandas(self) -> Any:
        """A DataFrame of the same columns, with the units in `attrs["units"]`; needs pandas."""
        frame = extras.load("pandas").DataFrame(
            {name: values.copy() for name, values in self._columns.items()}
        )
        frame.attrs["units"] = {name: self.unit(name) for name in self._columns}
        return frame

    def __repr__(self) -> str:
        named = [
            f"{name} ({self.unit(name)})" if self.unit(name) else name for name in self.columns
        ]
        return f"<{self._title}: {len(self)} rows of {', '.join(named)}>"


def joined(title: str, tables: list[Table]) -> Table:
    """The rows of tables with the same columns, one after the other."""
    if not tables:
        raise Error(f"{title} has no rows")
    first = tables[0]
    if any(table.columns != first.columns for table in tables):
        raise Error(f"{title} has files with different columns")
    columns = {name: np.concatenate([table[name] for table in tables]) for name in first.columns}
    return Table(title, columns, {name: first.unit(name) for name in first.columns})
