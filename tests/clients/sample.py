"""Writes a small snapshot of the form that the developer guide states, to test the other scripts.

    python sample.py SNAPSHOT [POINTS [ROWS]]

ROWS is the number of rows in a partition; one partition if it is left out.
"""

import sys

import h5py
import numpy as np


def main(snapshot, points="27", rows=None):
    n = int(points)
    rows = int(rows or points)
    sizes = [min(rows, n - first) for first in range(0, n, rows)]
    random = np.random.default_rng(1)
    with h5py.File(snapshot, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([1, 0], dtype=np.int64)
        root.attrs.create("Type", np.bytes_("UnstructuredGrid"))
        for name in ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"):
            root[name] = np.array(sizes, dtype=np.int64)
        root["Points"] = random.random((n, 3))
        root["Connectivity"] = np.concatenate([np.arange(size) for size in sizes])
        root["Offsets"] = np.concatenate([np.arange(size + 1) for size in sizes])
        root["Types"] = np.ones(n, dtype=np.uint8)
        data = root.create_group("PointData")
        # Removed particles leave gaps in the ids.
        data["id"] = 3 * np.arange(n, dtype=np.int64)
        data["body"] = (np.arange(n) % 2).astype(np.uint32)
        data["density"] = 2785.0 + random.random(n)
        data["velocity"] = random.standard_normal((n, 3))
        data["deviatoric_stress"] = random.standard_normal((n, 6))
        root["FieldData/TimeValue"] = np.array([1.25e-8])
        file.create_group("run").attrs["ranks"] = 2


if __name__ == "__main__":
    main(*sys.argv[1:])
