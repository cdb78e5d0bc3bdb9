//! Particles of a model on their way into pictures: none is held, and of very many only some layers
//! are looked at.

use rayon::prelude::*;

use super::image::Image;
use super::panel::Panel;
use crate::picture::cells::{Cell, Tiles};
use crate::snapshots::field::Drawn;
use crate::snapshots::images::Mirrors;
use crate::snapshots::shape::Shape;
use model::{Body, Case, edge};
use populate::{self, Brick};

/// Particles that pictures are made of at most, about; of more every few layers are taken.
const MOST: f64 = 3e7;

/// Height of the particles of a case of one dimension (pixels).
const BAND: f64 = 12.0;

/// Layers that are taken at once of what is fitted, if all are looked at.
const THICK: f64 = 60.0;

/// Layers of one spacing across a body, or thicker ones.
struct Layers {
    body: usize,
    axis: usize,
    lower: f64,
    spacing: f64,
    /// Of so many layers one is taken.
    every: u64,
    count: u64,
}

impl Layers {
    /// Of a body, of all `particles` of the case.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "numbers of layers, which are positive"
    )]
    fn new(index: usize, body: &Body, case: &Case, particles: f64) -> Option<Self> {
        let (lower, upper) = populate::bounds_above(body, case.dimension, &case.symmetry)?;
        let length = |a: &usize| upper[*a] - lower[*a];
        // Rows run along x.
        let across = (case.dimension.min(2) - 1)..case.dimension;
        let axis = across.max_by(|a, b| length(a).total_cmp(&length(b)))?;
        let every = (particles / MOST).ceil().max(1.0) as u64;
        let mut spacing = body.lattice.spacing;
        if every == 1 && populate::moves_sites(body) {
            // A fitted slab costs as much for all particles beside a layer.
            spacing = THICK * body.lattice.coarsest();
        }
        Some(Self {
            body: index,
            axis,
            lower: lower[axis] - 0.5 * spacing,
            spacing,
            every,
            count: ((length(&axis) / spacing).ceil() + 2.0) as u64,
        })
    }

    /// Those that are looked at.
    fn slabs(&self) -> impl Iterator<Item = (usize, Brick)> {
        let first = (0..self.count).step_by(usize::try_from(self.every).unwrap_or(usize::MAX));
        first.map(|k| {
            let lower = self.lower + self.spacing * k as f64;
            let upper = self.lower + self.spacing * (k + 1) as f64;
            (self.body, Brick::slab(self.axis, lower, upper))
        })
    }
}

/// Draws some slabs of bodies on panels, with particles of a size (m) that `shows` chooses; if
/// layers are left out, particles are as much larger.
fn draw(
    case: &Case,
    panels: &[Panel],
    slabs: &[(usize, Brick)],
    larger: f64,
    shows: impl Fn(&Body, &[f64; 3], f64) -> bool + Sync,
) -> Vec<Image> {
    // A row of particles is a band.
    let height = if case.dimension == 1 { BAND } else { 0.0 };
    let blank = || -> Vec<Image> {
        panels
            .iter()
            .map(|panel| Image::new(*panel, height))
            .collect()
    };
    let add = |mut images: Vec<Image>, &(body, slab): &(usize, Brick)| {
        let of = &case.bodies[body];
        let spacing = larger * of.lattice.spacing;
        for site in populate::sites(of, case.dimension, &case.symmetry, Some(slab)) {
            let size = spacing * edge(site.share, case.dimension);
            if !shows(of, &site.position, size) {
                continue;
            }
            for image in &mut images {
                image.add(&site.position, size, body);
            }
        }
        images
    };
    let merge = |mut images: Vec<Image>, others: Vec<Image>| {
        for (image, other) in images.iter_mut().zip(&others) {
            image.merge(other);
        }
        images
    };
    let least = slabs
        .len()
        .div_ceil(4 * rayon::current_num_threads())
        .max(1);
    let parts = slabs.par_iter().with_min_len(least);
    // same bits in any order: the nearest
    let mut images = parts.fold(blank, add).reduce(blank, merge);
    images.iter_mut().for_each(Image::close);
    images
}

/// All particles as each panel shows them.
pub fn views(case: &Case, panels: &[Panel], particles: f64) -> Vec<Image> {
    views_of(case, panels, particles, |_, _| true)
}

/// Particles of bodies and sizes (m) that `shows` chooses as each panel shows them.
fn views_of(
    case: &Case,
    panels: &[Panel],
    particles: f64,
    shows: impl Fn(&Body, f64) -> bool + Sync,
) -> Vec<Image> {
    let bodies = case.bodies.iter().enumerate();
    let bodies = bodies.filter(|(_, body)| shows(body, 0.0));
    let layers = bodies.filter_map(|(index, body)| Layers::new(index, body, case, particles));
    let layers: Vec<Layers> = layers.collect();
    let slabs: Vec<_> = layers.iter().flat_map(Layers::slabs).collect();
    let every = layers.first().map_or(1, |layers| layers.every);
    draw(case, panels, &slabs, every as f64, |body, _, size| {
        shows(body, size)
    })
}

/// Half the thickness of a section (spacings): particles without order are not in layers, and a
/// stretched body has gaps.
fn half_thickness(body: &Body) -> f64 {
    if body.cloud().is_some() || populate::moves_sites(body) {
        0.75
    } else {
        0.5
    }
}

/// True if particles of a body, of a size (m), are so large that a section shows the matter which they fill.
fn is_filled(case: &Case, body: &Body, size: f64, panel: &Panel) -> bool {
    let size = size.clamp(body.lattice.spacing, body.lattice.coarsest());
    case.dimension > 1 && !Image::is_small(panel, size)
}

/// The matter at a panel's plane, or of a flat model of so many particles all of it.
pub fn section(case: &Case, panel: &Panel, particles: f64) -> Image {
    let mut image = if case.dimension == 3 {
        layer(case, panel)
    } else {
        let shows = |body: &Body, size: f64| !is_filled(case, body, size, panel);
        views_of(case, &[*panel], particles, shows).remove(0)
    };
    let cells = cells(case, panel);
    if !cells.is_empty() {
        let tiles = Tiles::new(&cells, panel.view, 1.0 / panel.scale());
        let axes = panel.axes();
        image.fill(|at| {
            let images_alone = case.symmetry.iter().any(|plane| {
                let across = axes.iter().position(|&axis| axis == plane.axis.index());
                across.is_some_and(|k| at[k] < plane.position)
            });
            let inside = |a: usize, span: [f64; 2]| at[a] >= span[0] && at[a] <= span[1];
            let seen = !images_alone && inside(0, panel.view.x) && inside(1, panel.view.y);
            seen.then(|| tiles.sample(at).map(|sample| sample.body))?
        });
    }
    image
}

/// The particles that are filled which reach a panel's plane, with their images, body by body.
fn cells(case: &Case, panel: &Panel) -> Vec<Cell> {
    let (axis, position) = (panel.plane.axis.index(), panel.plane.position);
    let mirrors = Mirrors::new(case.symmetry.clone(), &Drawn::Body);
    let [right, up] = panel.axes();
    let (mut cells, mut images) = (Vec::new(), Vec::new());
    for (index, body) in case.bodies.iter().enumerate() {
        if !is_filled(case, body, f64::INFINITY, panel) {
            continue;
        }
        let reach = Shape::dense(body.lattice.coarsest(), case.dimension).reach(axis);
        let slab = Brick::slab(axis, position - reach, position + reach);
        let slab = (case.dimension == 3).then_some(slab);
        for site in populate::sites(body, case.dimension, &case.symmetry, slab) {
            let size = body.lattice.spacing * edge(site.share, case.dimension);
            if !is_filled(case, body, size, panel) {
                continue;
            }
            let shape = Shape::dense(size, case.dimension);
            mirrors.reflect(&site.position, &shape, &mut images);
            cells.extend(images.iter().map(|image| Cell {
                at: [image.point[right], image.point[up]],
                depth: image.point[axis] - position,
                shape: image.shape,
                body: index,
                value: None,
            }));
        }
    }
    cells
}

/// The particles that are not filled within half a spacing of a panel's plane; at a symmetry plane those next
/// to it.
fn layer(case: &Case, panel: &Panel) -> Image {
    let axis = panel.plane.axis.index();
    let slab = |body: &Body| {
        let (position, spacing) = (panel.plane.position, body.lattice.coarsest());
        let mut mirrors = case.symmetry.iter();
        let on_mirror = mirrors.any(|mirror| {
            mirror.axis == panel.plane.axis && (mirror.position - position).abs() < 0.01 * spacing
        });
        let reach = spacing * half_thickness(body);
        let lower = position - if on_mirror { 0.0 } else { reach };
        // A layer at the very side is taken once whatever rounding does.
        let nudge = 1e-6 * spacing;
        Brick::slab(axis, lower - nudge, lower + 2.0 * reach - nudge)
    };
    let bodies = case.bodies.iter().enumerate();
    let bodies = bodies.filter(|(_, body)| !is_filled(case, body, 0.0, panel));
    let slabs: Vec<_> = bodies.map(|(index, body)| (index, slab(body))).collect();
    // Particles finer than the coarsest are in the section only if they are as near.
    let (plane, widest) = (panel.plane.position, 1.0 + 1e-6);
    let mirrors = || case.symmetry.iter().filter(|m| m.axis == panel.plane.axis);
    let is_in = |body: &Body, x: &[f64; 3], size: f64| {
        if is_filled(case, body, size, panel) {
            return false;
        }
        let on_mirror = mirrors().any(|m| (m.position - plane).abs() < 0.01 * size);
        let sides = if on_mirror { 2.0 } else { 1.0 };
        (x[axis] - plane).abs() <= widest * sides * half_thickness(body) * size
    };
    draw(case, &[*panel], &slabs, 1.0, is_in).remove(0)
}
