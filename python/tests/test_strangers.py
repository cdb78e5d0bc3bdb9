"""Files that are not what the program writes are refused, with an error that says why."""

import json
import os
import shutil
from functools import partial

import h5py
import numpy as np
import pytest

import whipple

GRID = "VTKHDF/PointData"


@pytest.fixture
def snapshot(quarter, tmp_path):
    path = tmp_path / "step-00000000.vtkhdf"
    shutil.copy(whipple.open(quarter).snapshots.paths[0], path)
    return path


def replaced(path, name, make):
    """Makes an object of a file anew."""
    with h5py.File(path, "r+") as file:
        place, _, last = name.rpartition("/")
        del file[name]
        make(file[place], last)


def written(data, at, name):
    at.create_dataset(name, data=data)


def refused(path, message):
    with pytest.raises(whipple.DamagedError, match=message):
        snapshot = whipple.Snapshot.open(path)
        for field in snapshot.fields:
            snapshot[field]


def test_folders_that_are_no_runs(tmp_path):
    with pytest.raises(whipple.Error, match="no such folder"):
        whipple.open(tmp_path / "nothing")
    with pytest.raises(whipple.Error, match="has no status.json"):
        whipple.open(tmp_path)
    with pytest.raises(whipple.Error, match="cannot read"):
        whipple.Snapshot.open(tmp_path / "nothing.vtkhdf")
    with pytest.raises(whipple.DamagedError, match="no regular file"):
        whipple.Snapshot.open(tmp_path)


def test_a_pipe_is_not_waited_for(tmp_path):
    (tmp_path / "status.json").write_text("{}")
    os.mkfifo(tmp_path / "history.csv")
    with pytest.raises(whipple.DamagedError, match="no regular file"):
        whipple.open(tmp_path).table("history")


@pytest.mark.parametrize("share", [0.0, 0.3, 0.9, 0.999])
def test_a_snapshot_that_is_cut_off(snapshot, share):
    whole = snapshot.read_bytes()
    snapshot.write_bytes(whole[: int(share * len(whole))])
    refused(snapshot, "is damaged")


def test_a_field_of_another_length(snapshot):
    replaced(snapshot, f"{GRID}/mass", lambda at, name: at.create_dataset(name, data=np.ones(3)))
    refused(snapshot, r"'mass' has the shape \(3,\)")


def test_arrays_that_are_compressed_or_larger_than_the_file(snapshot):
    n = len(whipple.Snapshot.open(snapshot))
    replaced(
        snapshot,
        f"{GRID}/mass",
        lambda at, name: at.create_dataset(name, data=np.ones(n), compression="gzip"),
    )
    refused(snapshot, "h5repack")
    # Declared and never written: nothing of it is in the file.
    replaced(
        snapshot, f"{GRID}/mass", lambda at, name: at.create_dataset(name, (1 << 50,), dtype="f8")
    )
    refused(snapshot, "more than the file has")


def test_links_and_other_files(snapshot, tmp_path):
    n = len(whipple.Snapshot.open(snapshot))

    def soft(at, name):
        at[name] = h5py.SoftLink("/VTKHDF/PointData/density")

    def external(at, name):
        at[name] = h5py.ExternalLink("/dev/zero", "/mass")

    def virtual(at, name):
        layout = h5py.VirtualLayout((n,), dtype="f8")
        layout[:] = h5py.VirtualSource(str(tmp_path / "other.h5"), "mass", shape=(n,))
        at.create_virtual_dataset(name, layout)

    def outside(at, name):
        at.create_dataset(name, (n,), dtype="f8", external=[("/dev/zero", 0, 8 * n)])

    for make, message in (
        (soft, "link to elsewhere"),
        (external, "link to elsewhere"),
        (virtual, "in pieces"),
        (outside, "in another file"),
    ):
        replaced(snapshot, f"{GRID}/mass", make)
        refused(snapshot, message)


def test_types_that_the_program_does_not_write(snapshot):
    n = len(whipple.Snapshot.open(snapshot))
    kinds = [np.ones(n, ">f8"), np.ones(n, "f2"), np.full(n, b"x")]
    shapes = [np.ones((n, 2)), np.ones((n, 1, 1)), np.float64(1.0)]
    for data in kinds + shapes:
        replaced(snapshot, f"{GRID}/mass", partial(written, data))
        refused(snapshot, "mass")


def test_bodies_that_are_not_there(snapshot):
    with h5py.File(snapshot, "r+") as file:
        file[f"{GRID}/body"][5] = 7
    refused(snapshot, "bodies that are not there")


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("bodies", '["plate"]'),
        ("bodies", '"plate"'),
        ("spacings", '[1, "a"]'),
        ("symmetry", '[["w", 0.0]]'),
        ("symmetry", '[["x", 0.0], ["x", 1.0]]'),
        ("symmetry", "{}"),
        ("rigid", "[" * 60000),
        ("bodies", "\udcff"),
        ("step", "one"),
        ("dimension", np.uint64(9)),
    ],
)
def test_headers_that_make_no_sense(snapshot, name, value):
    with h5py.File(snapshot, "r+") as file:
        del file["whipple"].attrs[name]
        if isinstance(value, str):
            value = np.bytes_(value.encode("utf-8", "surrogateescape"))
        file["whipple"].attrs[name] = value
    refused(snapshot, "is damaged")


def test_texts_that_are_no_tables(tmp_path):
    (tmp_path / "status.json").write_text("{}")
    cases = {
        "history.csv": [
            "",
            "# units: s\n",
            "a,a\n1,2\n",
            "a,b\n1\n1,2\n",
            "a\n\udcff\n",
            'a\n"' + "x" * 200000 + '"\n',
        ],
        "summary.json": ["", "[1]", "[" * 100000, '{"a": ' + "1" * 5000 + "}"],
        "case.toml": ["a = ", "a = " + "[" * 100000],
    }
    for name, texts in cases.items():
        for text in texts:
            (tmp_path / name).write_bytes(text.encode("utf-8", "surrogateescape"))
            run = whipple.open(tmp_path)
            with pytest.raises(whipple.DamagedError):
                getattr(run, name.partition(".")[0])


def test_a_small_file_that_is_long_is_not_read(tmp_path):
    (tmp_path / "status.json").write_text("{}")
    with (tmp_path / "summary.json").open("wb") as file:
        file.truncate(1 << 40)
    with pytest.raises(whipple.DamagedError, match="more than"):
        whipple.open(tmp_path).summary


def test_an_index_that_is_none(quarter, tmp_path):
    shutil.copytree(quarter, tmp_path / "run")
    index = tmp_path / "run/snapshots/snapshots.vtkhdf.series"
    for text in ("{}", json.dumps({"files": [{"name": 1, "time": 0}]})):
        index.write_text(text)
        with pytest.raises(whipple.DamagedError, match="no index of snapshots"):
            whipple.open(tmp_path / "run").snapshots


def test_tables_of_hdf5(quarter, tmp_path):
    shutil.copytree(quarter, tmp_path / "run")
    run = whipple.open(tmp_path / "run")
    path = run.fragment_tables.paths[-1]
    rows = len(run.fragment_tables[-1])
    replaced(
        path, "table/mass", lambda at, name: at.create_dataset(name, data=np.full(rows, 9, "u4"))
    )
    with pytest.raises(whipple.DamagedError, match="words that are not there"):
        run.fragment_tables[-1]
    replaced(path, "table/mass", lambda at, name: at.create_dataset(name, data=np.ones(rows + 1)))
    with pytest.raises(whipple.DamagedError, match="another length"):
        run.fragment_tables[-1]
