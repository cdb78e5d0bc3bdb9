"""The examples run as a user starts them."""

import os
import pathlib
import subprocess
import sys

import pytest

PYTHON = pathlib.Path(__file__).resolve().parents[1]


def started(name, *arguments):
    done = subprocess.run(
        [sys.executable, PYTHON / "examples" / name, *map(str, arguments)],
        env={**os.environ, "PYTHONPATH": str(PYTHON / "src"), "MPLBACKEND": "agg"},
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_hole_and_velocity(quarter):
    told = started("hole_and_velocity.py", quarter)
    assert "plate: perforated" in told and "hole" in told
    assert "sphere" in told and "m/s" in told


def test_energies(quarter, tmp_path):
    pytest.importorskip("matplotlib")
    picture = tmp_path / "energies.png"
    started("energies.py", quarter, picture)
    assert picture.read_bytes().startswith(b"\x89PNG")
