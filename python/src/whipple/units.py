"""Numbers with units, where pint is installed."""

from __future__ import annotations

from typing import Any

from . import extras

# What tables say of columns without a unit, and of lengths counted in particle spacings.
_NONE = frozenset({"", "-", "spacings"})


def quantity(values: Any, unit: str) -> Any:
    """Values with a unit as the files write it, as a quantity of pint's application registry.

    >>> speed = quantity([1500.0, 7000.0], "m/s")
    >>> speed.to("km/s").magnitude
    array([1.5, 7. ])
    """
    registry = extras.load("pint").get_application_registry()
    return registry.Quantity(values, "" if unit in _NONE else unit)
