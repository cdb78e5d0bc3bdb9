"""One function for each client that opens a snapshot; all return the same plain dictionary.

`points` f64[n, 3], `cell_types` i64[n], `connectivity` i64[n], `offsets` i64[n + 1], `time` f64,
and `fields`, a dictionary of the point arrays. Each client is imported where it is used, so that
a Python with VTK alone (Debian's python3-vtk9) can use `with_vtk`.
"""

import numpy as np


def with_h5py(path):
    """The file's own content."""
    import h5py

    with h5py.File(path, "r") as file:
        root = file["VTKHDF"]
        assert list(root.attrs["Version"]) == [1, 0], root.attrs["Version"]
        kind = root.attrs["Type"]
        assert kind == b"UnstructuredGrid", kind
        # VTK reads a fixed-length ASCII string and no other.
        stored = root.attrs.get_id("Type").get_type()
        assert not stored.is_variable_str() and stored.get_cset() == h5py.h5t.CSET_ASCII
        counts = {name: root[name][()] for name in COUNTS}
        for name, value in counts.items():
            assert value.ndim == 1 and value.dtype == np.int64, (name, value)
            assert len(value) >= 1 and (value == counts[COUNTS[0]]).all(), (name, value)
        sizes = counts["NumberOfPoints"]
        n = sizes.sum()
        assert root["Points"].shape == (n, 3)
        assert root["Points"].dtype in (np.float64, np.float32)
        for name, more in (("Connectivity", 0), ("Types", 0), ("Offsets", len(sizes))):
            assert root[name].shape == (n + more,), (name, root[name].shape)
        connectivity, offsets = joined(sizes, root["Connectivity"][()], root["Offsets"][()])
        return {
            "points": root["Points"][()],
            "cell_types": root["Types"][()].astype(np.int64),
            "connectivity": connectivity,
            "offsets": offsets,
            "time": float(root["FieldData/TimeValue"][()].ravel()[0]),
            "fields": {name: array[()] for name, array in root["PointData"].items()},
        }


def partitions(path):
    """How many the file has."""
    import h5py

    with h5py.File(path, "r") as file:
        return len(file["VTKHDF/NumberOfPoints"])


def joined(sizes, connectivity, offsets):
    """Those of one grid, from those of partitions, each of which counts from zero."""
    ends = np.cumsum(sizes)
    firsts = ends - sizes
    connectivity = connectivity + np.repeat(firsts, sizes)
    whole = [np.zeros(1, np.int64)]
    for k, (first, size) in enumerate(zip(firsts, sizes)):
        own = offsets[first + k : first + k + size + 1]
        assert own[0] == 0, (k, own[0])
        whole.append(own[1:] + first)
    return connectivity, np.concatenate(whole)


COUNTS = ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds")


def with_vtk(path):
    """What ParaView sees: VTK's own vtkHDFReader."""
    from vtkmodules.vtkIOHDF import vtkHDFReader

    reader = vtkHDFReader()
    assert reader.CanReadFile(str(path)), "vtkHDFReader refuses the file"
    reader.SetFileName(str(path))
    reader.Update()
    return from_vtk(reader.GetOutputDataObject(0))


def pieces_with_vtk(path, pieces):
    """Ids that each of so many processes of a parallel ParaView would read."""
    from vtkmodules.util.numpy_support import vtk_to_numpy
    from vtkmodules.vtkIOHDF import vtkHDFReader

    seen = []
    for piece in range(pieces):
        reader = vtkHDFReader()
        reader.SetFileName(str(path))
        reader.UpdatePiece(piece, pieces, 0)
        ids = [np.zeros(0, np.int64)]
        for grid in grids(reader.GetOutputDataObject(0)):
            if grid.GetNumberOfPoints() > 0:
                ids.append(vtk_to_numpy(grid.GetPointData().GetArray("id")).copy())
        seen.append(np.concatenate(ids))
    return seen


def grids(data):
    """The grids of what a reader of VTK gives: newer ones leave partitions apart, older ones join them."""
    if data.IsA("vtkUnstructuredGrid"):
        return [data]
    assert data.IsA("vtkPartitionedDataSet"), data.GetClassName()
    found = [data.GetPartition(k) for k in range(data.GetNumberOfPartitions())]
    return [grid for grid in found if grid is not None]


def with_pyvista(path):
    """What a Python user sees."""
    import pyvista

    mesh = pyvista.get_reader(str(path), force_ext=".vtkhdf").read()
    time = mesh.GetFieldData().GetArray("TimeValue")
    if isinstance(mesh, pyvista.PartitionedDataSet):
        # As the book says.
        mesh = pyvista.merge(list(mesh), merge_points=False)
    assert isinstance(mesh, pyvista.UnstructuredGrid), type(mesh)
    seen = from_vtk(mesh, time)
    # PyVista's own view of the same grid.
    assert mesh.n_points == mesh.n_cells == len(seen["points"])
    assert np.array_equal(mesh.celltypes, seen["cell_types"])
    seen["points"] = np.asarray(mesh.points)
    seen["fields"] = {name: np.asarray(mesh.point_data[name]) for name in mesh.point_data}
    return seen


def from_vtk(data, time=None):
    """The dictionary of what a reader of VTK gives; its time, unless that is known."""
    time = time or data.GetFieldData().GetArray("TimeValue")
    assert time is not None, "no TimeValue in the field data"
    parts = [from_grid(grid) for grid in grids(data)]
    sizes = np.array([len(part["points"]) for part in parts])
    together = lambda name: np.concatenate([part[name] for part in parts])
    connectivity, offsets = joined(sizes, together("connectivity"), together("offsets"))
    names = parts[0]["fields"]
    assert all(part["fields"].keys() == names.keys() for part in parts)
    return {
        "points": together("points"),
        "cell_types": together("cell_types"),
        "connectivity": connectivity,
        "offsets": offsets,
        "time": time.GetTuple1(0),
        "fields": {name: np.concatenate([part["fields"][name] for part in parts]) for name in names},
    }


def from_grid(grid):
    """Points, cells and fields of a vtkUnstructuredGrid."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    cells = grid.GetCells()
    data = grid.GetPointData()
    return {
        "points": vtk_to_numpy(grid.GetPoints().GetData()),
        "cell_types": np.array([grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]),
        "connectivity": vtk_to_numpy(cells.GetConnectivityArray()),
        "offsets": vtk_to_numpy(cells.GetOffsetsArray()),
        "fields": {
            data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
            for i in range(data.GetNumberOfArrays())
        },
    }
