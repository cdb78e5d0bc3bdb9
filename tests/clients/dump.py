"""Saves what this Python's VTK sees in a snapshot, for check.py to compare.

    /usr/bin/python3 dump.py SNAPSHOT DUMP.npz

For a VTK that has no h5py beside it, such as Debian's python3-vtk9.
"""

import sys

import numpy as np
from vtkmodules.vtkCommonCore import vtkVersion

import readers


def main(snapshot, dump):
    seen = readers.with_vtk(snapshot)
    fields = {f"fields/{name}": array for name, array in seen.pop("fields").items()}
    np.savez(dump, version=vtkVersion.GetVTKVersion(), **seen, **fields)


if __name__ == "__main__":
    main(*sys.argv[1:])
