"""The whole of a quarter is the whole."""

import numpy as np
import pytest

import whipple
from whipple import mirror


def matched(ours, theirs):
    """For each particle of `ours` the nearest of `theirs`; fails unless all are at the same place."""
    distance = np.linalg.norm(ours.position[:, None] - theirs.position, axis=2)
    nearest = distance.argmin(axis=1)
    assert distance.min(axis=1).max() < 1e-12
    assert len(set(nearest.tolist())) == len(theirs) == len(ours)
    return theirs[nearest]


def test_each_field_of_a_mirrored_quarter_is_that_of_the_whole_model(pair):
    quarter, whole = (whipple.open(path).snapshots for path in pair)
    assert quarter.steps.tolist() == whole.steps.tolist()
    ours = quarter[-1].mirrored()
    theirs = matched(ours, whole[-1])
    assert ours.time == pytest.approx(theirs.time, rel=1e-12)
    assert np.array_equal(ours.body, theirs.body)
    for name in ("mass", "density", "velocity", "deviatoric_stress", "velocity_gradient"):
        scale = np.abs(theirs[name]).max()
        assert np.allclose(ours[name], theirs[name], rtol=0.0, atol=1e-9 * scale), name
    # Components off the diagonal would pass if they were nothing.
    for name in ("deviatoric_stress", "velocity_gradient"):
        for component in ("xy", "yz", "xz"):
            share = np.abs(ours[f"{name}.{component}"]).max() / np.abs(ours[name]).max()
            assert share > 1e-3, (name, component)


def test_sums_of_the_whole_are_those_of_the_bodies(quarter):
    run = whipple.open(quarter)
    for snapshot in (run.snapshots[0], run.snapshots[-1]):
        whole = snapshot.mirrored()
        for body in whole.body_names:
            row = run.bodies.where(body=body, time=snapshot.time)
            part = whole.of(body)
            scale = part.total_mass() * 7e3
            assert len(part) == row.particles[0]
            assert part.total_mass() == pytest.approx(row.mass[0], rel=1e-12)
            assert np.allclose(part.momentum(), row.momentum[0], rtol=0.0, atol=1e-12 * scale)
            turn = part.angular_momentum()
            assert np.allclose(turn, row.angular_momentum[0], rtol=0.0, atol=1e-15 * scale)
            assert part.kinetic_energy() == pytest.approx(row.kinetic_energy[0], rel=1e-12)
            assert part.internal_energy() == pytest.approx(row.internal_energy[0], rel=1e-12)


def test_images_are_told_apart_and_chosen(quarter):
    last = whipple.open(quarter).snapshots[-1]
    whole = last.mirrored()
    assert np.unique(whole.image, return_counts=True)[1].tolist() == [len(last)] * 4
    assert np.array_equal(whole[whole.image == 0].position, last.position)
    behind = whole[whole.image == 3]
    assert np.array_equal(behind.position, last.position * [-1, -1, 1])
    assert np.array_equal(behind.id, last.id)
    assert len(whole.mirrored()) == len(whole) and whole.symmetry == {}
    assert np.array_equal(whole.mirrored().image, whole.image)
    mixed = last.of("sphere").mirrored()
    assert len(mixed) == 4 * len(last.of("sphere"))
    assert np.array_equal(
        np.sort(mixed.position, axis=0), np.sort(whole.of("sphere").position, axis=0)
    )


def test_places_are_reflected_at_the_plane_and_vectors_are_not():
    planes = ((1, 0.25),)
    values = np.array([[1.0, 2.0, 3.0]])
    assert mirror.reflected("position", values, planes, 2).tolist() == [[1.0, -1.5, 3.0]]
    assert mirror.reflected("velocity", values, planes, 2).tolist() == [[1.0, -2.0, 3.0]]
    assert mirror.images(((0, 0.0), (1, 0.0), (2, 0.0))) == list(range(8))


@pytest.mark.parametrize("image", range(8))
def test_tensors_are_reflected_as_products(image):
    turn = np.diag(mirror.signs(3, image))
    tensor = np.arange(9.0).reshape(3, 3)
    turned = (turn @ tensor @ turn).reshape(9)
    assert np.array_equal(mirror.signs(9, image) * tensor.reshape(9), turned)
    pick = [0, 4, 8, 1, 5, 2]
    assert np.array_equal(mirror.signs(6, image), mirror.signs(9, image)[pick])
