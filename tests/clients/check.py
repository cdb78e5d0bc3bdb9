"""Opens a snapshot with h5py, the vtk wheel and PyVista; fails unless all see the same bits.

    python check.py SNAPSHOT [DUMP.npz …]

A DUMP is what another Python's VTK saw (dump.py). Two processes of a parallel reader must share the
partitions of the file, if it has several. Prints one line of what was seen.
"""

import sys

import numpy as np

import readers

VERTEX = 1  # VTK_VERTEX


def same(a, b, what):
    """Fails unless two arrays have the same shape and values (NaN equals NaN)."""
    a, b = np.asarray(a), np.asarray(b)
    assert a.shape == b.shape, f"{what}: shape {a.shape} against {b.shape}"
    equal = (a == b) | ((a != a) & (b != b))
    assert equal.all(), f"{what}: differs first at {np.argwhere(~equal)[0]}"


def compare(reference, other, client):
    """Fails unless `other`, seen by `client`, is `reference`."""
    for name in ("points", "cell_types", "connectivity", "offsets", "time"):
        same(reference[name], other[name], f"{client}: {name}")
    missing = set(reference["fields"]) ^ set(other["fields"])
    assert not missing, f"{client}: fields seen by one alone: {sorted(missing)}"
    for name, array in reference["fields"].items():
        same(array, other["fields"][name], f"{client}: field {name}")


def sane(seen):
    """What holds for each of our snapshots, beyond agreement."""
    n = len(seen["points"])
    ids = seen["fields"]["id"]
    same(seen["cell_types"], np.full(n, VERTEX), "cell types")
    same(seen["connectivity"], np.arange(n), "connectivity")
    same(seen["offsets"], np.arange(n + 1), "offsets")
    assert np.issubdtype(ids.dtype, np.integer), f"ids are {ids.dtype}"
    assert (np.diff(ids.astype(np.int64)) > 0).all(), "ids do not ascend"
    assert np.isfinite(seen["points"]).all(), "points are not finite"


def shared(snapshot, ids):
    """Each particle is read by one of two processes, and neither reads all if it need not."""
    pieces = readers.pieces_with_vtk(snapshot, 2)
    same(np.sort(np.concatenate(pieces)), ids, "ids of two processes")
    if readers.partitions(snapshot) > 1:
        assert all(len(piece) > 0 for piece in pieces), [len(piece) for piece in pieces]


def main(snapshot, *dumps):
    seen = readers.with_h5py(snapshot)
    sane(seen)
    shared(snapshot, seen["fields"]["id"])
    clients = ["h5py"]
    for client in ("vtk", "pyvista"):
        compare(seen, getattr(readers, f"with_{client}")(snapshot), client)
        clients.append(client)
    for dump in dumps:
        with np.load(dump) as file:
            other = {name: file[name] for name in file if not name.startswith("fields/")}
            other["fields"] = {
                name.removeprefix("fields/"): file[name]
                for name in file
                if name.startswith("fields/")
            }
        client = f"VTK {other.pop('version')}"
        compare(seen, other, client)
        clients.append(client)
    print(
        f"{len(seen['points'])} points, {len(seen['fields'])} fields, t = {seen['time']:g} s,"
        f" the same for {', '.join(clients)}"
    )


if __name__ == "__main__":
    main(*sys.argv[1:])
