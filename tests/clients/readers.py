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
        n = {name: root[name][()] for name in COUNTS}
        for name, value in n.items():
            assert value.shape == (1,) and value.dtype == np.int64, (name, value)
        assert root["Points"].shape == (n["NumberOfPoints"][0], 3)
        assert root["Points"].dtype == np.float64
        assert root["Connectivity"].shape == n["NumberOfConnectivityIds"]
        assert root["Types"].shape == n["NumberOfCells"]
        return {
            "points": root["Points"][()],
            "cell_types": root["Types"][()].astype(np.int64),
            "connectivity": root["Connectivity"][()],
            "offsets": root["Offsets"][()],
            "time": float(root["FieldData/TimeValue"][()].ravel()[0]),
            "fields": {name: array[()] for name, array in root["PointData"].items()},
        }


COUNTS = ("NumberOfPoints", "NumberOfCells", "NumberOfConnectivityIds")


def with_vtk(path):
    """What ParaView sees: VTK's own vtkHDFReader."""
    from vtkmodules.vtkIOHDF import vtkHDFReader

    reader = vtkHDFReader()
    assert reader.CanReadFile(str(path)), "vtkHDFReader refuses the file"
    reader.SetFileName(str(path))
    reader.Update()
    return from_vtk(reader.GetOutput())


def with_pyvista(path):
    """What a Python user sees."""
    import pyvista

    mesh = pyvista.get_reader(str(path), force_ext=".vtkhdf").read()
    assert isinstance(mesh, pyvista.UnstructuredGrid), type(mesh)
    seen = from_vtk(mesh)
    # PyVista's own view of the same grid.
    assert mesh.n_points == mesh.n_cells == len(seen["points"])
    assert np.array_equal(mesh.celltypes, seen["cell_types"])
    seen["points"] = np.asarray(mesh.points)
    seen["fields"] = {name: np.asarray(mesh.point_data[name]) for name in mesh.point_data}
    return seen


def from_vtk(grid):
    """The dictionary of a vtkUnstructuredGrid."""
    from vtkmodules.util.numpy_support import vtk_to_numpy

    cells = grid.GetCells()
    data = grid.GetPointData()
    time = grid.GetFieldData().GetArray("TimeValue")
    assert time is not None, "no TimeValue in the field data"
    return {
        "points": vtk_to_numpy(grid.GetPoints().GetData()),
        "cell_types": np.array([grid.GetCellType(i) for i in range(grid.GetNumberOfCells())]),
        "connectivity": vtk_to_numpy(cells.GetConnectivityArray()),
        "offsets": vtk_to_numpy(cells.GetOffsetsArray()),
        "time": time.GetTuple1(0),
        "fields": {
            data.GetArrayName(i): vtk_to_numpy(data.GetArray(i))
            for i in range(data.GetNumberOfArrays())
        },
    }
