"""What pyvista draws, off screen."""

import numpy as np
import pytest

import whipple

pyvista = pytest.importorskip("pyvista")


@pytest.fixture(scope="module")
def run(quarter):
    return whipple.open(quarter)


def drawn(plotter):
    """Share of a picture's points that are not background, and how many colours it has."""
    picture = np.asarray(plotter.screenshot(return_img=True))
    plotter.close()
    background = picture[0, -1]
    colours = np.unique(picture.reshape(-1, 3), axis=0)
    return (picture != background).any(axis=-1).mean(), len(colours)


def test_a_cloud_has_all_fields(run):
    last = run.snapshots[-1].mirrored()
    cloud = last.to_pyvista()
    assert cloud.n_points == cloud.n_verts == len(last)
    assert np.array_equal(cloud.point_data["velocity"], last.velocity)
    assert np.array_equal(cloud.point_data["body"], last.body_index)
    assert list(cloud.field_data["bodies"]) == ["plate", "sphere"]
    assert last.to_pyvista("pressure").point_data.keys() == ["pressure"]
    # Its points are its own: the arrays of the snapshot cannot be changed.
    cloud.points *= 2.0
    assert not np.array_equal(cloud.points, last.position)


@pytest.mark.parametrize(
    "by", ["body", "pressure", "velocity", "velocity.z", "deviatoric_stress.xy"]
)
def test_scenes_show_something(run, by):
    share, colours = drawn(run.scene(by=by, off_screen=True, window_size=(400, 300)))
    assert share > 0.05 and colours > 20


def test_the_colour_bar_has_the_ends_of_the_field(run):
    last = run.snapshots[-1]
    plotter = run.scene(by="pressure", off_screen=True)
    ends = next(iter(plotter.scalar_bars.values())).GetLookupTable().GetTableRange()
    assert ends == (last.pressure.min(), last.pressure.max())
    plotter.close()


def test_a_scene_at_a_time_and_in_parts(run):
    plotter = run.scene(0.0, mirrored=False, off_screen=True, window_size=(400, 300))
    assert drawn(plotter)[0] > 0.05
    half = run.snapshots[-1].mirrored()
    half = half[half["position.y"] > 0.0].of("sphere")
    assert drawn(half.scene(off_screen=True, window_size=(400, 300)))[0] > 0.02
    with pytest.raises(whipple.Error, match="name a component"):
        run.scene(by="deviatoric_stress", off_screen=True)
