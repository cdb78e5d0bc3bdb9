"""Read the runs of whipple, an SPH program for impacts of solids.

All numbers are in SI units, of 64 bits unless a snapshot was written with 32. Arrays are read when
they are asked for and cannot be changed in place; copy one to change it.

>>> import whipple
>>> run = whipple.open("runs/quarter-impact")
>>> run.snapshots[-1].of("sphere").unit("velocity")
'm/s'
"""

from .errors import DamagedError, Error, MissingError
from .run import Run, open
from .series import Series
from .snapshot import Snapshot
from .table import Table
from .units import quantity

__all__ = [
    "DamagedError",
    "Error",
    "MissingError",
    "Run",
    "Series",
    "Snapshot",
    "Table",
    "open",
    "quantity",
]
