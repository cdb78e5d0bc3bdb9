"""Pictures in three dimensions, with pyvista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from . import extras
from .errors import Error

if TYPE_CHECKING:
    from .snapshot import Array, Snapshot

# Colours of bodies: the set of Okabe & Ito (2008), as `whipple plot` has them.
_BODIES = ("#0072b2", "#e69f00", "#009e73", "#d55e00", "#56b4e9", "#cc79a7", "#f0e442")


def scene(
    snapshot: Snapshot,
    by: str = "body",
    *,
    cmap: str = "viridis",
    clim: tuple[float, float] | None = None,
    **plotter_options: Any,
) -> Any:
    """A plotter with a ball as large as each particle, coloured by body or by a field."""
    pyvista = extras.load("pyvista")
    plotter = pyvista.Plotter(**plotter_options)
    if by == "body":
        for index, name in enumerate(snapshot.body_names):
            _add(plotter, snapshot.of(name), color=_BODIES[index % len(_BODIES)], label=name)
        plotter.add_legend(bcolor=None, face="circle", size=(0.15, 0.12))
    else:
        title = f"{by} ({snapshot.unit(by)})" if snapshot.unit(by) else by
        bar = {
            "title": title + "\n",
            "fmt": "%.3g",
            "vertical": True,
            "position_x": 0.84,
            "position_y": 0.1,
        }
        bar |= {"title_font_size": 16, "label_font_size": 14}
        values = _scalars(snapshot, by)
        ends = clim or _ends(values)
        _add(plotter, snapshot, scalars=values, cmap=cmap, clim=ends, scalar_bar_args=bar)
    plotter.add_text(f"{snapshot.title}\nt = {_readable(snapshot.time)}", font_size=9)
    plotter.show_axes()
    if snapshot.dimension == 3:
        plotter.camera_position = "xz"
        plotter.camera.azimuth = 30.0
        plotter.camera.elevation = 20.0
    else:
        plotter.camera_position = "xy"
    plotter.reset_camera()
    return plotter


def _scalars(snapshot: Snapshot, name: str) -> Array:
    """A number for each particle (n,): of vectors the magnitude, of tensors a component."""
    values: Array = snapshot[name]
    if values.ndim == 1:
        return values
    if values.shape[1] == 3:
        return np.asarray(np.linalg.norm(values, axis=1))
    raise Error(f"{name!r} is a tensor: name a component, such as {name + '.xx'!r}")


def _ends(values: Array) -> tuple[float, float]:
    """Smallest and largest finite value, apart from each other."""
    finite = values[np.isfinite(values)]
    if len(finite) == 0:
        return 0.0, 1.0
    low, high = float(finite.min()), float(finite.max())
    return low, high if high > low else low + 1.0


def _readable(time: float) -> str:
    """A time (s) in a unit that suits it.

    >>> _readable(2e-7), _readable(1.5e-3), _readable(0.0)
    ('0.2 µs', '1.5 ms', '0 s')
    """
    for unit, name in ((1.0, "s"), (1e-3, "ms"), (1e-6, "µs"), (1e-9, "ns")):
        if abs(time) >= 0.1 * unit or time == 0.0:
            return f"{time / unit:.4g} {name}"
    return f"{time:.4g} s"


def _add(plotter: Any, snapshot: Snapshot, **options: Any) -> None:
    """Adds balls, if there are any."""
    if len(snapshot) == 0:
        return
    cloud = extras.load("pyvista").PolyData(np.array(snapshot.position, dtype=float))
    cloud.point_data["radius"] = 0.5 * snapshot.size
    balls = plotter.add_mesh(
        cloud, style="points_gaussian", emissive=False, render_points_as_spheres=True, **options
    )
    # As VTK calls it, since older versions of pyvista have no name of their own for it.
    balls.mapper.SetScaleArray("radius")
    balls.mapper.SetScaleFactor(1.0)
