"""What stands behind symmetry planes.

A component of a field changes its sign for each of its indices that is normal to a plane: none of a
scalar, one of a vector, two of a tensor. So an image behind x = c has the opposite velocity x and
the opposite stresses xy and xz, and the same stress xx. All vectors of snapshots are true vectors,
such as velocities and forces, none turns as a spin does.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

AXES = "xyz"

# Indices of the components of a row, by their number, in the order of the files.
COMPONENTS: dict[int, tuple[str, ...]] = {
    1: ("",),
    3: ("x", "y", "z"),
    6: ("xx", "yy", "zz", "xy", "yz", "xz"),
    9: ("xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"),
}

# Fields that are places: as far behind a plane as the particle is before it.
PLACES = frozenset({"position", "reference_position"})

# A plane: the number of the axis that is normal to it, and its place (m).
Plane = tuple[int, float]


def images(planes: tuple[Plane, ...]) -> list[int]:
    """What stands of a particle: itself (0) and its images, as sets of bits of the axes of the
    planes that they are behind.

    >>> images(((0, 0.0), (1, 0.0)))
    [0, 1, 2, 3]
    >>> images(((1, 0.5),))
    [0, 2]
    """
    codes = [0]
    for axis, _ in planes:
        codes += [code | 1 << axis for code in codes]
    return codes


def signs(components: int, image: int) -> NDArray[np.float64]:
    """What an image has of each component (components,): 1, or −1 where it is reversed.

    >>> signs(6, 0b001)
    array([ 1.,  1.,  1., -1.,  1., -1.])
    """
    turned = [-1.0 if image >> axis & 1 else 1.0 for axis in range(3)]
    names = COMPONENTS[components]
    signed = [math.prod(turned[AXES.index(axis)] for axis in name) for name in names]
    return np.array(signed, dtype=np.float64)


def reflected(
    name: str, values: NDArray[Any], planes: tuple[Plane, ...], image: int
) -> NDArray[Any]:
    """The values (n,) or (n, components) of a field as an image has them."""
    if values.ndim == 1 or image == 0:
        return values
    turned: NDArray[Any] = values * signs(values.shape[1], image).astype(values.dtype)
    if name in PLACES:
        for axis, place in planes:
            if image >> axis & 1:
                turned[:, axis] += np.asarray(2.0 * place, dtype=values.dtype)
    return turned
