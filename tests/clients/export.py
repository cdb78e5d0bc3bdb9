"""Holds exported files against the snapshots that they are made from.

export.py formats RUN FOLDER | mirror RUN NPZ | surfaces RUN FOLDER | paraview RUN SCRIPT
"""

import json
import re
import sys
from pathlib import Path

import ase.io
import h5py
import numpy as np
import pandas as pd
import vtk
from vtk.util.numpy_support import vtk_to_numpy

import whipple

NAMES = {3: "x y z".split(), 6: "xx yy zz xy yz xz".split()}


def stored(path):
    """Positions, fields and attributes of a snapshot, bit for bit."""
    with h5py.File(path) as file:
        grid = file["VTKHDF"]
        fields = {name: values[:] for name, values in grid["PointData"].items()}
        units = {name: values.attrs["unit"].decode() for name, values in grid["PointData"].items()}
        bodies = json.loads(file["whipple"].attrs["bodies"])
        time = grid["FieldData/TimeValue"][0]
        return grid["Points"][:], fields, units, bodies, time


def columns(fields):
    """Each component by its name, as tables have it."""
    found = {}
    for name, values in fields.items():
        if values.ndim == 1:
            found[name] = values
        else:
            for k, part in enumerate(NAMES[values.shape[1]]):
                found[f"{name}_{part}"] = values[:, k]
    return found


def same(ours, theirs, what):
    """Same bits, whatever the type."""
    theirs = np.asarray(theirs)
    assert ours.shape == theirs.shape, (what, ours.shape, theirs.shape)
    assert ours.astype(theirs.dtype).tobytes() == theirs.tobytes(), what


def frames(path):
    """The frames of a LAMMPS dump: items, and columns by name."""
    lines = path.read_text().splitlines()
    found = []
    while lines:
        frame = {}
        while True:
            title = lines.pop(0).removeprefix("ITEM: ")
            if title.startswith("ATOMS"):
                break
            count = 3 if title.startswith("BOX BOUNDS") else 1
            frame[title], lines = lines[:count], lines[count:]
        count = int(frame["NUMBER OF ATOMS"][0])
        rows = np.array([line.split() for line in lines[:count]])
        frame["columns"] = {name: rows[:, k] for k, name in enumerate(title.split()[1:])}
        found.append(frame)
        lines = lines[count:]
    return found


def lammps(path, snapshots):
    found = frames(path)
    images = ase.io.read(path, index=":", format="lammps-dump-text", units="si")
    assert len(found) == len(images) == len(snapshots) > 2
    for frame, image, snapshot in zip(found, images, snapshots, strict=True):
        points, fields, _, _, time = stored(snapshot)
        assert frame["UNITS"] == ["si"]
        assert float(frame["TIME"][0]) == time
        assert frame["TIMESTEP"][0] == str(int(snapshot.stem.split("-")[1]))
        bounds = np.array([line.split() for line in frame["BOX BOUNDS ff ff ff"]], float)
        assert (points > bounds[:, 0]).all() and (points < bounds[:, 1]).all()
        told = frame["columns"]
        assert list(told)[:9] == "id type x y z vx vy vz radius".split()
        same(told["id"].astype(int), fields["id"], "id")
        same(told["type"].astype(int) - 1, fields["body"].astype(int), "type")
        for k, axis in enumerate("xyz"):
            same(told[axis].astype(float), points[:, k], axis)
            same(told[f"v{axis}"].astype(float), fields["velocity"][:, k], axis)
        rest = columns({k: v for k, v in fields.items() if k not in ("id", "body", "velocity")})
        assert set(rest) == set(list(told)[9:])
        for name, values in rest.items():
            same(told[name].astype(float), values.astype(float), name)
        # Its unit of length is an ångström.
        assert np.allclose(image.positions, points * 1e10, rtol=1e-12, atol=0.0)
        assert (image.arrays["type"] == fields["body"] + 1).all()


def xyz(path, snapshots):
    images = ase.io.read(path, index=":", format="extxyz")
    assert len(images) == len(snapshots)
    for image, snapshot in zip(images, snapshots, strict=True):
        points, fields, _, bodies, time = stored(snapshot)
        assert image.info["Time"] == time
        assert not image.pbc.any()
        same(image.positions, points, "pos")
        same(image.numbers - 1, fields["body"].astype(int), "Z")
        assert image.info["bodies"].split() == bodies
        same(image.arrays["id"], fields["id"], "id")
        same(image.arrays["velocity"], fields["velocity"], "velocity")
        assert "velocity: m/s" in image.info["units"]
        masses = image.arrays.get("mass", image.get_masses())
        same(masses, fields["mass"], "mass")
        for name, values in columns({"s": fields["deviatoric_stress"]}).items():
            same(image.arrays["deviatoric_stress" + name[1:]], values, name)
        assert (image.arrays["radius"] > 0.0).all()


def csv(path, snapshot):
    points, fields, units, bodies, time = stored(snapshot)
    lines = path.read_text().splitlines()
    names = [line for line in lines if not line.startswith("#")][0].split(",")
    told = dict(zip(names, lines[0].removeprefix("# units: ").split(","), strict=True))
    assert told["x"] == "m" and told["deviatoric_stress_xy"] == "Pa" and told["id"] == "-"
    assert told["mass"] == units["mass"]
    table = pd.read_csv(path, comment="#", float_precision="round_trip")
    assert float(lines[2].removeprefix("# time: ").removesuffix(" s")) == time
    for k, axis in enumerate("xyz"):
        same(table[axis].to_numpy(), points[:, k], axis)
    assert (table["body"] == np.array(bodies)[fields["body"]]).all()
    rest = columns({name: values for name, values in fields.items() if name != "body"})
    assert set(rest) == set(names) - set("xyz") - {"body"}
    for name, values in rest.items():
        same(table[name].to_numpy().astype(values.dtype), values, name)


def npz(path, snapshot):
    points, fields, units, bodies, time = stored(snapshot)
    with np.load(path) as told:
        assert set(told) == {*fields, "position", "time", "body_names", "about"}
        for name, values in {**fields, "position": points}.items():
            assert told[name].dtype == values.dtype, name
            same(told[name], values, name)
        assert told["time"] == time and told["body_names"].tolist() == bodies
        about = json.loads(str(told["about"]))
    assert {name: about["arrays"][name]["unit"] for name in fields} == units
    assert about["arrays"]["deviatoric_stress"]["components"] == NAMES[6]


def vtu(path, snapshot):
    points, fields, units, bodies, time = stored(snapshot)
    reader = vtk.vtkXMLUnstructuredGridReader()
    reader.SetFileName(str(path))
    reader.Update()
    grid = reader.GetOutput()
    same(vtk_to_numpy(grid.GetPoints().GetData()), points, "points")
    data = grid.GetPointData()
    assert data.GetNumberOfArrays() == len(fields)
    for name, values in fields.items():
        array = data.GetArray(name)
        told = vtk_to_numpy(array)
        assert told.dtype == values.dtype, name
        same(told, values, name)
        unit = array.GetInformation().Get(vtk.vtkDataArray.UNITS_LABEL())
        assert (unit or "") == units[name], (name, unit)
    assert data.GetArray("deviatoric_stress").GetComponentName(4) == "yz"
    assert grid.GetNumberOfCells() == len(points)
    assert {grid.GetCellType(k) for k in (0, len(points) - 1)} == {vtk.VTK_VERTEX}
    field = grid.GetFieldData()
    assert field.GetArray("TimeValue").GetValue(0) == time
    assert field.GetNumberOfArrays() == 1, "texts, which meshio does not read"
    head = path.read_bytes().split(b"-->")[0].decode()
    names = re.findall("^body [0-9]+: (.*)$", head, re.MULTILINE)
    assert names == bodies


def pvd(path, snapshots):
    import xml.etree.ElementTree

    found = xml.etree.ElementTree.parse(path).getroot().iter("DataSet")
    found = [(float(part.get("timestep")), part.get("file")) for part in found]
    assert found == [(stored(path)[4], path.stem + ".vtu") for path in snapshots]


def ply(path, snapshot):
    points, fields, _, bodies, _ = stored(snapshot)
    content = path.read_bytes()
    head, body = content.split(b"end_header\n", 1)
    lines = [line.split() for line in head.decode().splitlines()]
    kinds = {"double": "<f8", "float": "<f4", "uint": "<u4", "uchar": "u1"}
    kind = np.dtype([(line[2], kinds[line[1]]) for line in lines if line[0] == "property"])
    rows = np.frombuffer(body, kind)
    assert len(rows) == len(points)
    for k, axis in enumerate("xyz"):
        same(rows[axis], points[:, k], axis)
    for name, values in columns(fields).items():
        if values.dtype.kind in "iu" and values.itemsize == 8:
            # The layout has no whole numbers of 64 bits: those stand in two columns.
            lower, upper = (rows[f"{name}_{half}"].astype(np.uint64) for half in ("lower", "upper"))
            ours = (lower | upper << np.uint64(32)).view(values.dtype)
        else:
            ours = rows[name]
        same(ours, values, name)
    colours = np.stack([rows[name] for name in ("red", "green", "blue")], axis=1)
    assert len(np.unique(colours, axis=0)) == len(bodies)
    reader = vtk.vtkPLYReader()
    reader.SetFileName(str(path))
    reader.Update()
    seen = vtk_to_numpy(reader.GetOutput().GetPoints().GetData())
    assert np.allclose(seen, points, rtol=1e-6, atol=0.0)


def formats(run, folder):
    snapshots = sorted((run / "snapshots").glob("*.vtkhdf"))
    last = snapshots[-1]
    lammps(folder / "snapshots.lammpstrj", snapshots)
    xyz(folder / "snapshots.xyz", snapshots)
    csv(folder / f"{last.stem}.csv", last)
    npz(folder / f"{last.stem}.npz", last)
    ply(folder / f"{last.stem}.ply", last)
    for snapshot in snapshots:
        vtu(folder / f"{snapshot.stem}.vtu", snapshot)
    pvd(folder / "snapshots.pvd", snapshots)


def mirror(run, path):
    """The whole of a quarter, as our Python package makes it; and what is made of fields."""
    snapshots = whipple.open(run).snapshots
    whole = snapshots[-1].mirrored()
    order = np.lexsort((whole.id, whole.image))
    with np.load(path) as told:
        ours = np.lexsort((told["id"], told["image"]))
        same(told["id"][ours], whole.id[order], "id")
        same(told["image"][ours].astype(int), whole.image[order].astype(int), "image")
        assert set(told["image"].tolist()) == {0, 1, 2, 3}
        for name in ("position", "velocity", "deviatoric_stress", "pressure"):
            # Minus zero and zero are one number.
            assert (told[name][ours] == whole[name][order]).all(), name
        stress = np.asarray(whole.stress())[order]
        assert np.allclose(told["stress"][ours], stress, rtol=1e-12, atol=1e-4)
        s = whole["deviatoric_stress"][order]
        von_mises = np.sqrt(1.5 * ((s[:, :3] ** 2).sum(1) + 2.0 * (s[:, 3:] ** 2).sum(1)))
        assert np.allclose(told["von_mises"][ours], von_mises, rtol=1e-9)
        assert (told["velocity_z"][ours] == whole["velocity"][order][:, 2]).all()
        start = snapshots[0].mirrored()
        places = {k: p for k, p in zip(zip(start.image, start.id), start.position, strict=True)}
        moved = [p - places[k] for k, p in zip(zip(whole.image, whole.id), whole.position, strict=True)]
        moved = np.array(moved)[order]
        assert np.allclose(told["displacement"][ours], moved, rtol=0.0, atol=1e-18)
        assert np.allclose(told["radius"][ours], 0.5 * whole.size[order], rtol=1e-14)


def read_stl(path):
    reader = vtk.vtkSTLReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def surfaces(run, folder):
    """They are closed, look outwards, and stand where pictures draw the outline."""
    last = whipple.open(run).snapshots[-1]
    whole = last.mirrored()
    for body in whole.body_names:
        path = folder / f"step-{last.step:08}-{body}.stl"
        assert b"in metres" in path.read_bytes()[:80]
        mesh = read_stl(path)
        edges = vtk.vtkFeatureEdges()
        edges.SetInputData(mesh)
        edges.BoundaryEdgesOn()
        edges.NonManifoldEdgesOn()
        edges.FeatureEdgesOff()
        edges.Update()
        count = edges.GetOutput().GetNumberOfCells()
        assert count == 0, f"{count} open edges of {body}"
        points = vtk_to_numpy(mesh.GetPoints().GetData()).astype(float)
        corners = vtk_to_numpy(mesh.GetPolys().GetConnectivityArray()).reshape(-1, 3)
        a, b, c = (points[corners[:, k]] for k in range(3))
        volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
        part = whole.of(body)
        filled = (part.mass / part.density).sum()
        # The surface of a lattice is a little more than half a spacing outside its outermost layer.
        assert 0.97 < volume / filled < 1.25, (body, volume / filled)
        # All weights at corners of triangles: those of the body are the larger, or one.
        some = points[:: max(1, len(points) // 300)]
        sums = {}
        for other in whole.body_names:
            them = whole.of(other)
            square = ((some[:, None, :] - them.position[None, :, :]) ** 2).sum(2) / them.size**2
            sums[other] = ((np.maximum(2.0 - square, 0.0) / 1.75) ** 4).sum(1)
        rest = [sums[other] for other in sums if other != body] + [np.ones(len(some))]
        level = sums[body] ** 0.25 - np.max(rest, axis=0) ** 0.25
        assert np.abs(level).max() < 0.25 and np.abs(level).mean() < 0.04, (
            body, np.abs(level).max(), np.abs(level).mean())
        print(f"{body}: {len(corners)} triangles, volume {volume / filled:.3f}, "
              f"level {np.abs(level).mean():.4f}, at most {np.abs(level).max():.4f}")


def paraview(run, path):
    """The script compiles, names snapshots that VTK opens, and mirrors as we do."""
    text = path.read_text()
    known = {"__name__": "script", "__file__": str(path)}
    exec(compile(text, str(path), "exec"), known)
    place = Path(known["snapshots"]())
    assert place.samefile(run / "snapshots/snapshots.vtkhdf.series")
    last = json.loads(place.read_text())["files"][-1]["name"]
    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(place.parent / last))
    reader.Update()
    whole = whipple.open(run).snapshots[-1].mirrored()
    assert known["BODIES"] == list(whole.body_names)
    assert len(known["COLOURS"]) == len(known["BODIES"])

    class Image:
        """What ParaView's filter does with these properties."""

        def __init__(self, Input):
            self.data = Input.data

        def ListProperties(self):
            return ["Plane", "Center", "CopyInput", "FlipAllInputArrays"]

        def result(self):
            image = vtk.vtkReflectionFilter()
            image.SetInputData(self.data)
            image.SetCopyInput(self.CopyInput)
            image.SetFlipAllInputArrays(self.FlipAllInputArrays)
            getattr(image, f"SetPlaneTo{self.Plane}")()
            image.SetCenter(self.Center)
            image.Update()
            return image.GetOutput()

    class Newer:
        """The same of newer versions."""

        class Plane:
            Origin, Normal = None, None

        def __init__(self, Input):
            self.data, self.ReflectionPlane = Input.data, self.Plane()

        def ListProperties(self):
            return ["PlaneMode", "ReflectionPlane", "CopyInput", "ReflectAllInputArrays"]

        def result(self):
            plane = vtk.vtkPlane()
            plane.SetOrigin(self.ReflectionPlane.Origin)
            plane.SetNormal(self.ReflectionPlane.Normal)
            plane.SetAxisAligned(True)
            image = vtk.vtkAxisAlignedReflectionFilter()
            image.SetInputData(self.data)
            image.SetCopyInput(bool(self.CopyInput))
            image.SetReflectAllInputArrays(bool(self.ReflectAllInputArrays))
            image.SetReflectionPlane(plane)
            image.Update()
            parts = vtk.vtkAppendFilter()
            collection = image.GetOutput()
            for k in range(collection.GetNumberOfPartitionedDataSets()):
                for n in range(collection.GetNumberOfPartitions(k)):
                    parts.AddInputData(collection.GetPartition(k, n))
            parts.Update()
            return parts.GetOutput()

    class Simple:
        pass

    for kind, filter_ in (("Reflect", Image), ("AxisAlignedReflect", Newer)):
        simple = Simple()
        setattr(simple, kind, filter_)
        source = Simple()
        source.data = reader.GetOutput()
        for axis, position in known["PLANES"]:
            source.data = known["mirrored"](simple, source, axis, position).result()
        points = vtk_to_numpy(source.data.GetPoints().GetData())
        assert points.shape == whole.position.shape
        arrays = source.data.GetPointData()
        # Images of a particle differ by their side of each plane.
        orders = [
            np.lexsort((places[:, 1] > 0.0, places[:, 0] > 0.0, ids))
            for places, ids in (
                (points, vtk_to_numpy(arrays.GetArray("id"))),
                (whole.position, whole["id"]),
            )
        ]
        # VTK's filters make points of single precision; fields they leave as they are.
        ours, theirs = points[orders[0]], whole.position[orders[1]]
        assert np.allclose(ours, theirs, rtol=1e-6, atol=1e-12), kind
        for name in ("velocity", "deviatoric_stress"):
            ours, theirs = vtk_to_numpy(arrays.GetArray(name))[orders[0]], whole[name][orders[1]]
            assert np.allclose(ours, theirs, rtol=1e-12, atol=1e-15), (kind, name)


if __name__ == "__main__":
    globals()[sys.argv[1]](*map(Path, sys.argv[2:]))
