"""Snapshots: what they hold, parts of them, and their sums."""

import copy

import numpy as np
import pytest

import whipple


@pytest.fixture(scope="module")
def run(quarter):
    return whipple.open(quarter)


def test_a_snapshot_has_its_fields_by_attribute_and_by_name(run):
    last = run.snapshots[-1]
    n = len(last)
    shapes = {"position": (n, 3), "velocity": (n, 3), "deviatoric_stress": (n, 6), "id": (n,)}
    for name, shape in shapes.items():
        assert last[name].shape == shape
        assert getattr(last, name) is last[name]
    assert last.position.dtype == np.float64
    assert {"position", "body", "pressure", "damage"} <= set(last.fields)
    assert last.unit("position") == "m" and last.unit("pressure") == "Pa"
    assert "compression" in last.description("pressure")
    assert np.array_equal(last["velocity.z"], last.velocity[:, 2])
    assert np.array_equal(last["deviatoric_stress.xz"], last.deviatoric_stress[:, 5])
    assert last.time == run.status["time"] and last.step == run.status["step"]
    assert last.body_names == ("plate", "sphere") and last.dimension == 3
    assert last.symmetry == {"x": 0.0, "y": 0.0} and last.rigid_bodies == ()


def test_arrays_cannot_be_changed_in_place(run):
    last = run.snapshots[-1]
    for values in (last.velocity, last.of("sphere").velocity, last.mirrored().velocity):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 0.0


def test_bodies_and_masks_choose_particles(run):
    last = run.snapshots[-1]
    sphere = last.of("sphere")
    assert set(sphere.body) == {"sphere"} and len(sphere) == (last.body == "sphere").sum()
    assert np.array_equal(sphere.id, last.id[last.body == "sphere"])
    assert len(last.of("plate", "sphere")) == len(last)
    fast = last[np.linalg.norm(last.velocity, axis=1) > 1000.0]
    assert 0 < len(fast) < len(last)
    assert np.array_equal(fast[::2].position, fast.position[::2])
    assert len(last[3]) == 1 and last[[3, 5]].id.tolist() == last.id[[3, 5]].tolist()
    assert len(last[last.mass < 0.0]) == 0


def test_snapshots_are_a_sequence_in_order_of_time(run):
    snapshots = run.snapshots
    assert [snapshot.step for snapshot in snapshots] == snapshots.steps.tolist()
    assert (np.diff(snapshots.times) > 0.0).all()
    assert [snapshot.time for snapshot in snapshots] == snapshots.times.tolist()
    assert [s.step for s in snapshots[1:3]] == snapshots.steps[1:3].tolist()
    assert snapshots.at(-1.0).step == 0 and snapshots.at(1.0).step == snapshots[-1].step
    with pytest.raises(IndexError):
        snapshots[len(snapshots)]


def test_times_are_those_of_the_files_without_an_index(run, tmp_path):
    known = run.snapshots.times.copy()
    (tmp_path / "snapshots").mkdir()
    (tmp_path / "status.json").write_text('{"state": "running"}')
    for path in run.snapshots.paths:
        (tmp_path / "snapshots" / path.name).write_bytes(path.read_bytes())
    assert np.array_equal(whipple.open(tmp_path).snapshots.times, known)


def test_a_name_that_is_not_there_lists_what_is(run):
    last = run.snapshots[-1]
    with pytest.raises(whipple.MissingError, match="did you mean 'velocity'.*pressure"):
        last["velocty"]
    with pytest.raises(whipple.Error, match="no component 'w'.*it has: x, y, z"):
        last["velocity.w"]
    with pytest.raises(KeyError, match="no body 'ball'.*plate, sphere"):
        last.of("ball")
    assert not hasattr(last, "sound_speed") and "sound_speed" not in last
    assert (last.temperature > 0.0).all()
    assert copy.copy(last).step == last.step


def test_a_cut_through_a_lattice_is_one_layer(run):
    first = run.snapshots[0].mirrored()
    for axis in "xy":
        layer = np.unique(first.cut(axis)[f"position.{axis}"].round(9))
        assert len(layer) == 1
    assert np.array_equal(first.cut((0, 3, 0)).id, first.cut("y").id)
    thick = first.cut("y", thickness=0.32e-3)
    assert len(np.unique(thick["position.y"].round(9))) == 4
    with pytest.raises(whipple.Error, match="no axis 'w'"):
        first.cut("w")
    with pytest.raises(whipple.Error, match="a vector of three"):
        first.cut((0, 0, 0))


def test_sizes_are_those_of_cells(run):
    first, last = run.snapshots[0], run.snapshots[-1]
    assert np.allclose(first.size, 0.08e-3, rtol=1e-12)
    growth = last.size / 0.08e-3
    squeezed = last.density > 2785.0
    assert squeezed.any() and (growth[squeezed] < 1.0).all() and (growth[~squeezed] >= 1.0).all()
    assert 0.25 <= growth.min() and growth.max() <= 4.0


def test_sums_are_those_of_the_history(run):
    part, row = run.snapshots[-1], run.history[-1]
    last = part.mirrored()
    assert run.history.computed_share == 0.25 and row.computed_share == 0.25
    assert row.time[0] == last.time
    assert last.kinetic_energy() == pytest.approx(row.kinetic_energy[0], rel=1e-12)
    assert last.internal_energy() == pytest.approx(row.internal_energy[0], rel=1e-12)
    assert np.allclose(last.momentum(), row.momentum[0], rtol=1e-12, atol=1e-18)
    scale = abs(part.angular_momentum()).max()
    assert np.allclose(last.angular_momentum(), row.angular_momentum[0], rtol=1e-9, atol=1e-12 * scale)


def test_stress_is_tension_less_pressure(run):
    last = run.snapshots[-1]
    trace = (last.stress() - last.contact_stress)[:, :3].sum(axis=1)
    assert np.allclose(trace, -3.0 * last.pressure, atol=1.0)


def test_parts_and_single_precision(more):
    run = whipple.open(more)
    assert set(run.schedules) == {"rear", "ball"}
    rear, ball = run.schedules["rear"][-1], run.schedules["ball"][-1]
    assert rear.schedule == "rear" and "below z = 0" in rear.part
    assert set(rear.fields) == {"position", "id", "body", "velocity", "pressure"}
    assert (rear["position.z"] < 0.0).all()
    assert np.allclose(rear.size, 0.08e-3)
    with pytest.raises(whipple.MissingError, match="no field 'mass'"):
        rear.total_mass()
    last = run.snapshots[-1].of("sphere")
    assert ball.velocity.dtype == np.float32 and ball.mirrored().velocity.dtype == np.float32
    assert np.array_equal(ball.id, last.id)
    assert ball.kinetic_energy() == pytest.approx(last.kinetic_energy(), rel=1e-6)
    assert run.snapshots[-1].schedule is None and run.snapshots[-1].part is None


def test_two_dimensions(simulate):
    run = whipple.open(simulate("rings", "rubber-rings", "spacing=8mm", "run.end_time=0.05ms"))
    last = run.snapshots[-1]
    assert last.dimension == 2 and last.unit("mass") == "kg/m"
    assert run.history.unit("kinetic_energy") == "J/m"
    assert last.kinetic_energy() == pytest.approx(run.history.kinetic_energy[-1], rel=1e-12)
    assert len(last.mirrored()) == len(last) and not last.mirrored().image.any()
    assert np.allclose(run.snapshots[0].size, 8e-3)
