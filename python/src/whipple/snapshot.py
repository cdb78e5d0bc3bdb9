"""Snapshots: the particles at one time."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import extras, header, mirror, units
from .errors import Error, damaged, missing
from .gate import Gate
from .header import Field, Header
from .mirror import AXES, COMPONENTS

Array = NDArray[Any]

# Far above the round-off of positions, far below what the eye sees; in particle spacings.
_NUDGE = 1e-6


class Snapshot:
    """Particles at one time, those of a file or some of them, with their images or without.

    Each field is an array (n,) of scalars, (n, 3) of vectors x, y, z, (n, 6) of symmetric tensors xx,
    yy, zz, xy, yz, xz, or (n, 9) of tensors by rows; `snapshot.velocity`, or `snapshot["velocity"]`. It
    is read when it is first asked for, and kept. Components have names: `snapshot["velocity.z"]`.

    >>> last = whipple.open("runs/quarter-impact").snapshots[-1]
    >>> last.velocity.shape == (len(last), 3), last.unit("velocity")
    (True, 'm/s')
    """

    def __init__(self, about: Header, count: int, read: Callable[[str], Array]) -> None:
        """Of so many particles, whose fields `read` gives by name."""
        self._about = about
        self._count = count
        self._read = read
        self._held: dict[str, Array] = {}

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> Snapshot:
        """Opens a file `.vtkhdf`."""
        about = header.read(Path(path))

        def read(name: str) -> Array:
            with Gate(about.path) as file:
                values = file.array(header.place(name))
            if len(values) != about.particles:
                raise damaged(about.path, "it has changed since it was opened")
            return values

        return cls(about, about.particles, read)

    # What it is.

    @property
    def path(self) -> Path:
        """Its file."""
        return self._about.path

    @property
    def title(self) -> str:
        """Title of the case."""
        return self._about.title

    @property
    def time(self) -> float:
        """Time (s)."""
        return self._about.time

    @property
    def step(self) -> int:
        """Number of the step."""
        return self._about.step

    @property
    def dimension(self) -> int:
        """Dimensions of space: 1, 2 or 3. In 1 and 2 masses are by area and by length."""
        return self._about.dimension

    @property
    def symmetry(self) -> dict[str, float]:
        """Place (m) of the symmetry plane normal to each axis that has one; none once mirrored."""
        return {AXES[axis]: place for axis, place in self._about.symmetry}

    @property
    def schedule(self) -> str | None:
        """Name of the schedule that it belongs to; none for the usual snapshots."""
        return self._about.schedule

    @property
    def part(self) -> str | None:
        """Which particles the file holds, in words; none for all."""
        return self._about.part

    @property
    def body_names(self) -> tuple[str, ...]:
        """Names of the bodies, in the order of the input."""
        return self._about.body_names

    @property
    def rigid_bodies(self) -> tuple[str, ...]:
        """Names of the rigid bodies, which are not in the sums of `history.csv`."""
        about = self._about
        return tuple(name for name, rigid in zip(about.body_names, about.rigid) if rigid)

    # Fields.

    @property
    def fields(self) -> tuple[str, ...]:
        """Names of all fields."""
        return tuple(self._about.fields)

    def unit(self, name: str) -> str:
        """SI unit of a field as the file writes it; empty for none."""
        return self._field(name).unit

    def description(self, name: str) -> str:
        """What a field is, in a sentence."""
        return self._field(name).description

    def quantity(self, name: str) -> Any:
        """A field with its unit; needs pint."""
        return units.quantity(self[name], self.unit(name))

    def __len__(self) -> int:
        """Number of particles n."""
        return self._count

    def __contains__(self, name: object) -> bool:
        return name in self._about.fields

    __iter__ = None  # Neither particles nor fields: say `snapshot.fields`.

    def __getitem__(self, key: Any) -> Any:
        """A field or a component by name, or some of the particles.

        Particles are chosen by a mask (n,), their numbers, or a slice.

        >>> last = whipple.open("runs/quarter-impact").snapshots[-1]
        >>> fast = last[last["velocity.z"] < -1000.0]
        >>> 0 < len(fast) < len(last)
        True
        """
        if isinstance(key, str):
            return self._values(key)
        if isinstance(key, (int, np.integer)):
            key = [key]
        rows = np.arange(self._count)[key]
        return Snapshot(self._about, len(rows), lambda name: self._stored(name)[rows])

    def __getattr__(self, name: str) -> Array:
        # Names with underscores in front are asked for by copy, pickle and notebooks.
        if name.startswith("_"):
            raise AttributeError(name)
        return self._values(name)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.fields]

    def _field(self, name: str) -> Field:
        field = self._about.fields.get(name) or self._about.fields.get(name.partition(".")[0])
        if field is None:
            raise missing("the snapshot", "field", name, self.fields)
        return field

    def _values(self, name: str) -> Array:
        """A field, a component of one, or the names of bodies."""
        if name == "body":
            return self.body
        if name in self._about.fields:
            return self._stored(name)
        of, _, component = name.partition(".")
        names = COMPONENTS[self._field(of).components]
        if component not in names:
            raise missing(f"the field {of!r}", "component", component, filter(None, names))
        values: Array = self._stored(of)[:, names.index(component)]
        return values

    def _stored(self, name: str) -> Array:
        """A field as the file has it."""
        if name not in self._held:
            values = self._read(name)
            values.setflags(write=False)
            self._held[name] = values
        return self._held[name]

    # Bodies.

    @property
    def body_index(self) -> Array:
        """Which of `body_names` each particle belongs to (n,)."""
        index = self._stored("body") if "body" in self else np.zeros(len(self), np.uint32)
        if index.max(initial=0) >= max(len(self.body_names), 1):
            raise damaged(self.path, "it has particles of bodies that are not there")
        return index

    @property
    def body(self) -> Array:
        """Name of the body of each particle (n,)."""
        return np.array(self.body_names, dtype=str)[self.body_index]

    def of(self, *bodies: str) -> Snapshot:
        """The particles of some bodies.

        >>> last = whipple.open("runs/quarter-impact").snapshots[-1]
        >>> len(last.of("plate")) + len(last.of("sphere")) == len(last)
        True
        """
        wanted = []
        for body in bodies:
            if body not in self.body_names:
                raise missing("the snapshot", "body", body, self.body_names)
            wanted.append(self.body_names.index(body))
        chosen: Snapshot = self[np.isin(self.body_index, wanted)]
        return chosen

    # Parts and the whole.

    def mirrored(self) -> Snapshot:
        """The whole of a model with symmetry planes: these particles and all their images.

        Places, vectors and tensors are reflected. The images follow the particles, those behind one
        plane after the other; the new field `image` tells the planes that each is behind, as a sum of 1
        (x), 2 (y) and 4 (z), zero of the particles themselves. An image has the `id`, the `fragment`
        and the `part` of its particle.

        >>> last = whipple.open("runs/quarter-impact").snapshots[-1]
        >>> whole = last.mirrored()
        >>> len(whole) == 4 * len(last), bool(abs(whole.momentum()[0]) < 1e-15)
        (True, True)
        """
        about = self._about
        codes = mirror.images(about.symmetry)
        meaning = "Symmetry planes that it is behind: the sum of 1 (x), 2 (y), 4 (z)."
        image = {"image": Field("", meaning, np.dtype(np.uint8))}

        def read(name: str) -> Array:
            if name == "image" and name not in self:
                return np.repeat(np.array(codes, dtype=np.uint8), len(self))
            values = self._stored(name)
            planes = about.symmetry
            return np.concatenate([mirror.reflected(name, values, planes, c) for c in codes])

        whole = replace(about, symmetry=(), fields={**about.fields, **image})
        return Snapshot(whole, len(codes) * len(self), read)

    def cut(
        self, normal: str | ArrayLike = "y", at: float = 0.0, *, thickness: float | None = None
    ) -> Snapshot:
        """The particles that a plane cuts.

        The plane is normal to an axis `"x"`, `"y"`, `"z"` or to a vector (3,), at the distance `at` (m) from
        the origin. Without a `thickness` (m) it cuts what is nearer than half its size: one layer.

        >>> whole = whipple.open("runs/quarter-impact").snapshots[0].mirrored()
        >>> section = whole.cut("y")
        >>> bool((abs(section["position.y"]) <= 0.51 * section.size).all())
        True
        """
        if isinstance(normal, str):
            if normal not in AXES or len(normal) != 1:
                raise missing("space", "axis", normal, AXES)
            direction = np.eye(3)[AXES.index(normal)]
        else:
            direction = np.asarray(normal, dtype=float)
            if direction.shape != (3,) or not 0.0 < np.linalg.norm(direction) < np.inf:
                raise Error(f"a plane is normal to x, y, z or to a vector of three, not {normal!r}")
            direction = direction / np.linalg.norm(direction)
        distance = self._stored("position") @ direction - at
        half = 0.5 * (self.size if thickness is None else thickness)
        # Not the lower face, for a lattice with a plane of symmetry has layers on both.
        nudge = _NUDGE * self._of_body(self._about.spacings)
        chosen: Snapshot = self[(distance > nudge - half) & (distance <= half + nudge)]
        return chosen

    @property
    def size(self) -> Array:
        """Edge of the cell that each particle fills now (n,), m: as `whipple plot` draws it.

        The spacing at the start times `(ρ₀/ρ)^(1/d)`, from a quarter to four times; the spacing itself
        where the snapshot holds no density.
        """
        spacing = self._first_size()
        if "density" not in self:
            return spacing
        with np.errstate(all="ignore"):
            growth = self._of_body(self._about.densities) / self._stored("density")
            growth = growth ** (1.0 / self.dimension)
        return spacing * np.where(np.isfinite(growth), np.clip(growth, 0.25, 4.0), 1.0)

    def _first_size(self) -> Array:
        """Spacing of each particle at the start (n,), m: `(m/ρ₀)^(1/d)` where it varies in a body."""
        about = self._about
        spacing = self._of_body(about.spacings)
        if about.coarsest_spacings == about.spacings or "mass" not in self:
            return spacing
        with np.errstate(all="ignore"):
            volume = self._stored("mass") / self._of_body(about.densities)
            size = np.nan_to_num(volume ** (1.0 / self.dimension))
        return np.clip(size, 0.5 * spacing, 2.0 * self._of_body(about.coarsest_spacings))

    def _of_body(self, values: tuple[float, ...]) -> Array:
        """A number of each body for each of its particles (n,)."""
        return np.array(values, dtype=float)[self.body_index]

    # Sums. In one dimension all are by area, in two by length.

    def total_mass(self) -> float:
        """Σ m, kg."""
        return float(self.mass.sum(dtype=float))

    def momentum(self) -> NDArray[np.float64]:
        """Σ m v (3,), kg m/s."""
        return np.asarray(np.einsum("i,ij->j", self.mass, self.velocity, dtype=float))

    def angular_momentum(self) -> NDArray[np.float64]:
        """Σ x × m v about the origin (3,), kg m²/s."""
        turn = np.cross(self.position, self.velocity)
        return np.asarray(np.einsum("i,ij->j", self.mass, turn, dtype=float))

    def kinetic_energy(self) -> float:
        """Σ ½ m v², J."""
        return float(
            0.5 * np.einsum("i,ij,ij", self.mass, self.velocity, self.velocity, dtype=float)
        )

    def internal_energy(self) -> float:
        """Σ m e, J."""
        return float(np.dot(self._thermal_mass(), self.specific_energy))

    def _thermal_mass(self) -> Array:
        """Mass that energy belongs to (n,), kg: that of a stress point too, which does not move it."""
        return self.mass + self.stress_mass if "stress_mass" in self else self.mass

    def stress(self) -> Array:
        """All that matter bears (n, 6), Pa: xx, yy, zz, xy, yz, xz, tension positive.

        Deviatoric stress less pressure, and the stress that contact forces carry.
        """
        stress = self.deviatoric_stress.copy()
        stress[:, :3] -= self.pressure[:, np.newaxis]
        return stress + self.contact_stress if "contact_stress" in self else stress

    # Pictures.

    def to_pyvista(self, *names: str) -> Any:
        """A `pyvista.PolyData` with a vertex for each particle and some fields, or all; needs pyvista.

        `body` is the number of the body; the names stand in the field data `bodies`.
        """
        pyvista = extras.load("pyvista")
        cloud = pyvista.PolyData(np.array(self._stored("position")))
        for name in names or self.fields:
            if name != "position":
                cloud.point_data[name] = self.body_index if name == "body" else self[name]
        cloud.field_data["bodies"] = list(self.body_names)
        cloud.field_data["TimeValue"] = [self.time]
        return cloud

    def scene(self, by: str = "body", **options: Any) -> Any:
        """A `pyvista.Plotter` with a ball for each particle; see `Run.scene`."""
        from . import scene

        return scene.scene(self, by, **options)

    def __repr__(self) -> str:
        bodies = ", ".join(self.body_names)
        return (
            f"<snapshot of step {self.step}, {self.time:g} s: {len(self)} particles of {bodies};"
            f" {', '.join(self.fields)}>"
        )
