"""The folder of a run, and its tables."""

import numpy as np
import pytest

import whipple


@pytest.fixture(scope="module")
def run(quarter):
    return whipple.open(quarter)


def test_a_run_tells_what_was_run_and_how_it_ended(run):
    assert run.case["spacing"] == "0.08mm" and run.title == run.case["title"]
    assert run.status["state"] == "finished"
    assert run.summary["energy_error_max"] < 0.1
    assert "finished" in run.log
    assert "finished" in repr(run) and "history" in repr(run)


def test_tables_have_columns_with_units(run):
    history = run.history
    assert history.unit("time") == "s" and history.unit("dt_reason") == ""
    assert history.step.dtype == np.int64 and history.time.dtype == np.float64
    assert set(history.dt_reason) <= {"sound", "force", "contact", "maximum", "flight", "end"}
    assert history.momentum.shape == (len(history), 3) and history.unit("momentum") == "kg m/s"
    assert np.array_equal(history.momentum[:, 2], history.momentum_z)
    assert {"history", "bodies", "measures", "fragments", "contacts"} <= set(run.tables)
    for name in run.tables:
        table = run.table(name)
        assert all(len(table[column]) == len(table) for column in table.columns)
    pair = run.contacts.where(body_a="plate", body_b="sphere")
    assert np.isinf(pair.contact_dt[0]) and np.isnan(pair.closest_a[-1]) | (pair.closest_a[-1] >= 0)


def test_figures_stand_in_columns(run):
    figures = run.figures
    assert figures["plate.verdict"][0] == "not_loaded" and figures.unit("plate.verdict") == ""
    hole = figures["plate.hole_diameter"]
    assert hole.dtype == np.float64 and figures.unit("plate.hole_diameter") == "m"
    assert (figures["plate.hole_diameter.uncertainty"] > 0.0).all()
    rows = run.measures.where(measure="plate", figure="hole_diameter")
    assert np.array_equal(rows.value.astype(float), hole)
    assert np.array_equal(rows.time, figures.time)
    assert "plate.verdict.uncertainty" not in figures


def test_fragments_have_a_table_for_each_time(run):
    tables = run.fragment_tables
    assert tables.steps.tolist() == run.fragments.step.tolist()
    assert tables.times.tolist() == run.fragments.time.tolist()
    last = tables[-1]
    assert len(last) > 0 and last.unit("spin") == "rad/s"
    assert (last.mass * last.copies).sum() == pytest.approx(run.fragments.fragment_mass[-1])
    label = run.snapshots[-1].fragment
    labels, particles = np.unique(label[label >= 0], return_counts=True)
    # Dust has labels, but no rows.
    assert set(labels[particles >= 8].tolist()) <= set(last.label.tolist()) <= set(labels.tolist())


def test_gauges_and_witnesses(more, run):
    other = whipple.open(more)
    assert other.gauges.unit("pressure") == "Pa" and set(other.gauges.gauge) == {"front"}
    assert other.gauges.velocity.shape == (len(other.gauges), 3)
    passed = other.witness.where(witness="behind", body="sphere", direction="forwards")
    assert passed.mass[0] == 0.0 and (np.diff(passed.mass) >= 0.0).all()
    assert set(other.crossings.direction) <= {"forwards", "backwards"}
    with pytest.raises(whipple.MissingError, match="no table 'gauges'.*it has: history"):
        run.gauges


def test_many_gauges_stand_in_hdf5(simulate):
    run = whipple.open(
        simulate(
            "gauges",
            "wave-step",
            "gauge=[" + ",".join(f'{{at=["{k}um"],name="g{k}"}}' for k in range(1, 103)) + "]",
            options=("--until", "0.05us"),
        )
    )
    assert not (run.path / "gauges.csv").exists() and "gauges" in run.tables
    assert set(run.gauges.gauge) == {f"g{k}" for k in range(1, 103)}
    assert run.gauges.unit("pressure") == "Pa"
    one = run.gauges.where(gauge="g7")
    assert np.allclose(one.place_x, 7e-6) and (np.diff(one.time) > 0.0).all()


def test_a_run_that_stopped(pair):
    assert whipple.open(pair[0]).status["state"] == "stopped"


def test_rows_that_are_being_written_do_not_count(run, tmp_path):
    (tmp_path / "status.json").write_text('{"state": "running"}')
    text = (run.path / "history.csv").read_text()
    for cut in (text[:-1], text[:-20], text + "5,1e-"):
        (tmp_path / "history.csv").write_text(cut)
        history = whipple.open(tmp_path).history
        assert 0 <= len(run.history) - len(history) <= 1
        assert history.time.tolist() == run.history.time[: len(history)].tolist()
    assert len(whipple.open(tmp_path).snapshots) == 0
    with pytest.raises(whipple.Error, match="no file 'summary.json'.*status.json"):
        whipple.open(tmp_path).summary
    with pytest.raises(whipple.Error, match="no snapshots"):
        whipple.open(tmp_path).scene()


def test_bodies_may_be_called_as_numbers(tmp_path):
    (tmp_path / "status.json").write_text("{}")
    (tmp_path / "bodies.csv").write_text('# units: s,-,kg\ntime,body,mass\n0.0,1,2\n0.0,"a,b",3\n')
    bodies = whipple.open(tmp_path).bodies
    assert bodies.where(body="1").mass.tolist() == [2]
    assert bodies.where(body="a,b").mass.tolist() == [3]
    with pytest.raises(whipple.MissingError, match="no body 'c'"):
        bodies.where(body="c")


def test_pandas(run):
    pytest.importorskip("pandas")
    frame = run.history.to_pandas()
    assert list(frame.columns) == list(run.history.columns)
    assert frame.attrs["units"]["kinetic_energy"] == "J"
    frame["time"] *= 1e6
    assert run.history.time[-1] < 1e-6


def test_all_units_are_known_to_pint(run, more):
    pytest.importorskip("pint")
    for one in (run, whipple.open(more)):
        for name in one.tables:
            for column in one.table(name).columns:
                if one.table(name)[column].dtype.kind in "if":
                    one.table(name).quantity(column)
        last = one.snapshots[-1]
        for field in last.fields:
            if field != "body":
                last.quantity(field)
    speed = run.snapshots[0].of("sphere").quantity("velocity.z")
    assert speed.to("km/s").magnitude[0] == pytest.approx(-7.0)
    momentum = run.history.quantity("momentum")
    assert momentum.check("[mass] * [length] / [time]")
