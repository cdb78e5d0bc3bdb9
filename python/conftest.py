"""Runs that the tests and the examples in docstrings read, made by the program."""

from __future__ import annotations

import os
import pathlib
import subprocess
from collections.abc import Callable

import pytest

import whipple

ROOT = pathlib.Path(__file__).resolve().parents[1]
SMALL = ("spacing=0.08mm", "fragments={}", 'output.snapshot_every="0.02us"')
TENSORS = 'output.fields=["mass","velocity","density","velocity_gradient","deviatoric_stress"]'

Simulate = Callable[..., pathlib.Path]


@pytest.fixture(scope="session")
def simulate(tmp_path_factory: pytest.TempPathFactory) -> Simulate:
    """Runs a case of `inputs/` with some settings and options; gives the folder of the run."""
    program = os.environ.get("WHIPPLE_PROGRAM")
    if not program:
        pytest.exit("WHIPPLE_PROGRAM must name the program", returncode=2)
    folder = tmp_path_factory.mktemp("whipple") / "runs"

    def run(
        name: str,
        case: str | pathlib.Path,
        *settings: str,
        options: tuple[str, ...] = (),
    ) -> pathlib.Path:
        sets = [word for setting in settings for word in ("--set", setting)]
        path = case if isinstance(case, pathlib.Path) else ROOT / "inputs" / case
        command = [program, "run", path, *sets, "--threads", "1", *options, "--out", folder / name]
        done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
        assert done.returncode == 0, done.stderr
        return folder / name

    return run


@pytest.fixture(scope="session")
def quarter(simulate: Simulate) -> pathlib.Path:
    """A quarter of an impact, from start to end."""
    return simulate("quarter-impact", "quarter-impact", *SMALL)


@pytest.fixture(scope="session")
def pair(simulate: Simulate) -> tuple[pathlib.Path, pathlib.Path]:
    """The begin of the same impact as a quarter and as a whole, with fields of each kind."""
    options = ("--until", "0.02us")
    sets = ("spacing=0.1mm", 'output.snapshot_every="0.01us"', TENSORS)
    return (
        simulate("pair-quarter", "quarter-impact", *sets, options=options),
        simulate("pair-whole", "quarter-impact", *sets, "symmetry=[]", options=options),
    )


MORE = """
[[output.snapshot]]
name = "rear"
every = "0.05 us"
fields = ["velocity", "pressure"]
region.below = { z = "0 mm" }

[[output.snapshot]]
name = "ball"
every = "0.1 us"
bodies = ["sphere"]
precision = "single"

[[gauge]]
name = "front"
at = ["0.1 mm", "0.1 mm", "0 mm"]

[[witness]]
name = "behind"
normal = [0, 0, -1]
point = [0, 0, "-0.15 mm"]
"""


@pytest.fixture(scope="session")
def more(simulate: Simulate, tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """A run with further snapshots, a gauge and a witness plane."""
    case = tmp_path_factory.mktemp("case") / "case.toml"
    sound = (ROOT / "inputs/quarter-impact/case.toml").read_text(encoding="utf-8")
    case.write_text(sound + MORE, encoding="utf-8")
    return simulate("more", case, "spacing=0.08mm", 'output.snapshot_every="0.1us"')


@pytest.fixture(autouse=True)
def _in_docstrings(
    request: pytest.FixtureRequest,
    monkeypatch: pytest.MonkeyPatch,
    doctest_namespace: dict[str, object],
) -> None:
    """Examples in docstrings name the package, and a run in the current folder."""
    doctest_namespace["whipple"] = whipple
    if isinstance(request.node, pytest.DoctestItem):
        if "units" in request.node.name:
            pytest.importorskip("pint")
        monkeypatch.chdir(request.getfixturevalue("quarter").parents[1])
