"""What a snapshot says beside its particles."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from .errors import damaged
from .gate import Gate
from .mirror import AXES, COMPONENTS, Plane

GRID = "VTKHDF"
_ABOUT = "whipple"


@dataclass(frozen=True)
class Field:
    """A field of a snapshot: SI unit, meaning, type, and the number of components of a row."""

    unit: str
    description: str
    dtype: np.dtype[Any]
    components: int = 1


@dataclass(frozen=True)
class Header:
    """What a snapshot says of the model, and which fields it has."""

    path: Path
    particles: int
    title: str
    time: float
    step: int
    dimension: int
    body_names: tuple[str, ...]
    spacings: tuple[float, ...]
    coarsest_spacings: tuple[float, ...]
    densities: tuple[float, ...]
    rigid: tuple[bool, ...]
    symmetry: tuple[Plane, ...]
    schedule: str | None
    part: str | None
    fields: dict[str, Field]


def place(name: str) -> str:
    """Where the array of a field stands in the file."""
    return f"{GRID}/Points" if name == "position" else f"{GRID}/PointData/{name}"


def read(path: Path) -> Header:
    """The header of a snapshot, with the types and shapes of all fields checked."""
    with Gate(path) as file:
        fields = _fields(file)
        particles = file.form(place("position"))[1][0]
        time = file.array(f"{GRID}/FieldData/TimeValue")
        if time.shape != (1,):
            raise damaged(path, f"it has a time of shape {time.shape}")
        names = _listed(file, "bodies", str, None)
        bodies = len(names)
        dimension = file.count(_ABOUT, "dimension")
        if dimension not in (1, 2, 3):
            raise damaged(path, f"it has {dimension} dimensions")
        return Header(
            path=path,
            particles=particles,
            title=file.note(_ABOUT, "title") or "",
            time=float(time[0]),
            step=file.count(_ABOUT, "step"),
            dimension=dimension,
            body_names=tuple(names),
            spacings=tuple(_listed(file, "spacings", float, bodies)),
            coarsest_spacings=tuple(_listed(file, "coarsest_spacings", float, bodies)),
            densities=tuple(_listed(file, "densities", float, bodies)),
            rigid=tuple(_listed(file, "rigid", bool, bodies)),
            symmetry=_planes(file),
            schedule=file.note(_ABOUT, "schedule"),
            part=file.note(_ABOUT, "part"),
            fields=fields,
        )


def time_of(path: Path) -> float:
    """Time of a snapshot (s)."""
    with Gate(path) as file:
        time = file.array(f"{GRID}/FieldData/TimeValue")
        if time.shape != (1,):
            raise damaged(path, f"it has a time of shape {time.shape}")
        return float(time[0])


def _fields(file: Gate) -> dict[str, Field]:
    names = ["position", *file.members(f"{GRID}/PointData")]
    found = {}
    rows = file.form(place("position"))[1][0]
    for name in names:
        dtype, shape = file.form(place(name))
        components = shape[1] if len(shape) == 2 else 1
        if shape[0] != rows or components not in COMPONENTS:
            raise damaged(file.path, f"field {name!r} has the shape {shape} of {rows} particles")
        unit = file.note(place(name), "unit") or ""
        description = file.note(place(name), "description") or ""
        found[name] = Field(unit, description, dtype, components)
    if found["position"].components != 3:
        raise damaged(file.path, "its points have not three coordinates")
    return found


def _json(file: Gate, name: str) -> Any:
    text = file.note(_ABOUT, name)
    try:
        return json.loads(text or "")
    except (ValueError, RecursionError) as error:
        raise damaged(file.path, f"{name}: {error}") from error


def _listed(file: Gate, name: str, kind: type, count: int | None) -> list[Any]:
    """A list of so many values of a kind."""
    values = _json(file, name)
    if kind is float and isinstance(values, list):
        values = [float(value) if type(value) is int else value for value in values]
    is_sound = isinstance(values, list) and all(type(value) is kind for value in values)
    if not is_sound or count not in (None, len(values)):
        raise damaged(file.path, f"{name}: not a list of {count or 'some'} {kind.__name__}")
    return list(values)


def _planes(file: Gate) -> tuple[Plane, ...]:
    planes = []
    values = _json(file, "symmetry")
    for value in values if isinstance(values, list) else [None]:
        match value:
            case ["x" | "y" | "z" as axis, int() | float() as at]:
                planes.append((AXES.index(axis), float(at)))
            case _:
                raise damaged(file.path, f"symmetry: {value!r} is no plane")
    if len({axis for axis, _ in planes}) != len(planes):
        raise damaged(file.path, "symmetry: two planes along one axis")
    return tuple(planes)
