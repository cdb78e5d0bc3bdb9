"""Runs: the folder that the program writes."""

from __future__ import annotations

import os
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np

from . import files, header, sheets
from .errors import Error, damaged, missing
from .series import Series
from .snapshot import Snapshot
from .table import Table, joined

# Tables in the folder of a run.
_TABLES = (
    "history",
    "bodies",
    "measures",
    "distributions",
    "gauges",
    "witness",
    "crossings",
    "contacts",
    "loads",
    "removed",
    "departed",
    "fragments",
    "performance",
    "ranks",
)
_STATUS = "status.json"
_SNAPSHOTS = "snapshots"
_SNAPSHOT = ".vtkhdf"


def open(path: str | os.PathLike[str]) -> Run:
    """Opens the folder of a run.

    >>> whipple.open("runs/quarter-impact").title
    'Aluminium sphere at 7 km/s on an aluminium plate'
    >>> whipple.open("runs")
    Traceback (most recent call last):
    whipple.errors.Error: 'runs' is no run: it has no status.json
    """
    return Run(path)


class _Named:
    """A table of a run as an attribute."""

    def __set_name__(self, owner: type, name: str) -> None:
        self._name = name

    def __get__(self, run: Run | None, owner: type) -> Table:
        if run is None:
            return self  # type: ignore[return-value]
        return run.table(self._name)


class Run:
    """The folder of a run, finished or not.

    What has been read is kept: of a run that goes on, open the folder again to see what is new.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path)
        self._held: dict[str, Table] = {}
        if not self.path.is_dir():
            raise Error(f"{str(self.path)!r} is no run: there is no such folder")
        if not (self.path / _STATUS).is_file():
            raise Error(f"{str(self.path)!r} is no run: it has no {_STATUS}")

    # What was run, and how it ended.

    @cached_property
    def case(self) -> dict[str, Any]:
        """`case.toml`: the input with all changes applied, lengths and the like as texts with units."""
        return files.toml_table(self._file("case.toml"))

    @cached_property
    def status(self) -> dict[str, Any]:
        """`status.json`: `state` ("running", "finished", "stopped", "failed"), `step`, `time`, `reason`."""
        return files.json_table(self._file(_STATUS))

    @cached_property
    def summary(self) -> dict[str, Any]:
        """`summary.json`: the figures of the whole run; there once it has ended."""
        return files.json_table(self._file("summary.json"))

    @cached_property
    def log(self) -> str:
        """`log.txt`: what happened when."""
        return files.text(self._file("log.txt"), most=None)

    @property
    def title(self) -> str:
        """Title of the case."""
        return str(self.case.get("title", ""))

    def _file(self, name: str) -> Path:
        path = self.path / name
        if not path.exists():
            there = sorted(entry.name for entry in self.path.iterdir() if entry.is_file())
            raise missing(f"the run {str(self.path)!r}", "file", name, there)
        return path

    # Snapshots.

    @cached_property
    def snapshots(self) -> Series[Snapshot]:
        """The usual snapshots, of all particles, each opened when it is asked for."""
        return self._snapshots_in(self.path / _SNAPSHOTS, "snapshots")

    @cached_property
    def schedules(self) -> Mapping[str, Series[Snapshot]]:
        """Snapshots of schedules of their own, by name."""
        folder = self.path / _SNAPSHOTS
        entries = folder.iterdir() if folder.is_dir() else []
        names = sorted(entry.name for entry in entries if entry.is_dir())
        return {name: self._snapshots_in(folder / name, name) for name in names}

    def _snapshots_in(self, folder: Path, name: str) -> Series[Snapshot]:
        index = folder / f"{name}{_SNAPSHOT}.series"
        times = _times(index) if index.exists() else {}

        def time_of(step: int, path: Path) -> float:
            known = times.get(path.name)
            return header.time_of(path) if known is None else known

        paths = files.steps(folder, _SNAPSHOT)
        what = "snapshots" if name == "snapshots" else f"snapshots of {name!r}"
        return Series(what, paths, Snapshot.open, time_of)

    # Tables.

    history = _Named()
    """Sums over what is computed, at many times; of a quarter that is a quarter."""
    bodies = _Named()
    """What there is of each body, in the whole model."""
    measures = _Named()
    """Figures of plates, targets, bars, debris, regions and fronts, a row for each."""
    distributions = _Named()
    """Profiles, and mass by speed and by angle."""
    gauges = _Named()
    """Readings of gauges."""
    witness = _Named()
    """What has passed witness planes."""
    crossings = _Named()
    """Which particles have passed witness planes, where and when."""
    contacts = _Named()
    """Force, impulse and energy of each pair of bodies."""
    loads = _Named()
    """What loads, rigid bodies, absorbing zones and rigid surfaces have given."""
    removed = _Named()
    """What particles taken out took with them, by body."""
    departed = _Named()
    """What particles that left the box of interest took with them, by body."""
    fragments = _Named()
    """How many fragments there are, and how much matter in them, at one time after the other."""
    performance = _Named()
    """How fast and how evenly the last process ran."""
    ranks = _Named()
    """Particles of each rank or group of ranks, and its work over the mean of all."""

    @property
    def tables(self) -> tuple[str, ...]:
        """Names of the tables that this run has."""
        there = [name for name in _TABLES if (self.path / f"{name}.csv").exists()]
        if self._gauge_files() and "gauges" not in there:
            there.append("gauges")
        return tuple(there)

    def table(self, name: str) -> Table:
        """A table by name.

        >>> whipple.open("runs/quarter-impact").table("histroy")
        Traceback (most recent call last):
        whipple.errors.MissingError: the run 'runs/quarter-impact' has no table 'histroy' (did you \
mean 'history'?); it has: history, ...
        """
        if name not in self.tables:
            raise missing(f"the run {str(self.path)!r}", "table", name, self.tables)
        if name not in self._held:
            path = self.path / f"{name}.csv"
            if path.exists():
                self._held[name] = sheets.from_csv(path)
            else:
                records = self._gauge_files().values()
                self._held[name] = joined(name, [sheets.from_hdf5(record) for record in records])
        return self._held[name]

    def _gauge_files(self) -> dict[int, Path]:
        return files.steps(self.path / "gauges", ".h5")

    @cached_property
    def figures(self) -> Table:
        """The figures of `measures.csv`, a column `MEASURE.FIGURE` for each and a row for each time.

        Where an uncertainty is told it stands in `MEASURE.FIGURE.uncertainty`.

        >>> figures = whipple.open("runs/quarter-impact").figures
        >>> str(figures["plate.verdict"][0]), figures.unit("plate.hole_diameter")
        ('not_loaded', 'm')
        """
        return sheets.figures(self.measures)

    @cached_property
    def fragment_tables(self) -> Series[Table]:
        """A table of all fragments, the heaviest first, for each time at which they were told."""
        counts = self.fragments
        times = dict(zip(counts["step"].tolist(), counts["time"].tolist()))

        def time_of(step: int, path: Path) -> float:
            if step not in times:
                raise damaged(path, "fragments.csv does not know its step")
            return float(times[step])

        # A file may be there before its row is.
        paths = files.steps(self.path / "fragments", ".h5")
        told = {step: path for step, path in paths.items() if step in times}
        return Series("tables of fragments", told, sheets.from_hdf5, time_of)

    # Pictures.

    def scene(
        self, time: float | None = None, by: str = "body", *, mirrored: bool = True, **options: Any
    ) -> Any:
        """A `pyvista.Plotter` that shows a snapshot, with a ball for each particle; needs pyvista.

        The snapshot is the nearest to `time` (s), or the last. Balls are as large as the cells that
        particles fill, coloured by body or by a field: `"pressure"`, `"velocity"` (its magnitude),
        `"velocity.z"`, `"deviatoric_stress.xy"`. A model with symmetry planes is shown whole unless `mirrored`
        is false. `cmap` and `clim` choose the colours of a field; other options go to the plotter.
        """
        if len(self.snapshots) == 0:
            raise Error(f"the run {str(self.path)!r} has no snapshots")
        shown = self.snapshots[-1] if time is None else self.snapshots.at(time)
        return (shown.mirrored() if mirrored else shown).scene(by, **options)

    def __repr__(self) -> str:
        count = len(self.snapshots)
        state = self.status.get("state")
        return f"<run {str(self.path)!r}, {state}: {count} snapshots, {', '.join(self.tables)}>"


def _times(index: Path) -> dict[str, float]:
    """Time (s) of each snapshot that an index for ParaView names."""
    times: dict[str, float] = {}
    entries = files.json_table(index).get("files")
    for entry in entries if isinstance(entries, list) else [None]:
        match entry:
            case {"name": str() as name, "time": int() | float() as time}:
                times[name] = float(np.float64(time))
            case _:
                raise damaged(index, "it is no index of snapshots")
    return times
