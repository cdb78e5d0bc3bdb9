"""Writes a small snapshot of the form that the developer guide states, to test the other scripts.

    python sample.py SNAPSHOT [POINTS]
"""

import sys

import h5py
import numpy as np


def main(snapshot, points="27"):
    n = int(points)
    random = np.random.default_rng(1)
    with h5py.File(snapshot, "w") as file:
        root = file.create_group("VTKHDF")
        root.attrs["Version"] = np.array([1, 0], dtype=np.int64)
        root.attrs.create("Type", np.bytes_("UnstructuredGrid"))
        for name in ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds"):
            root[name] = np.array([n], dtype=np.int64)
        root["Points"] = random.random((n, 3))
        root["Connectivity"] = np.arange(n, dtype=np.int64)
        root["Offsets"] = np.arange(n + 1, dtype=np.int64)
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
