//! The pixels of a view of one snapshot.

use rayon::prelude::*;

use super::buffer::{Ball, Buffer, Outline, Seen};
use super::camera::Camera;
use super::cut::Cuts;
use super::occlusion::openness;
use super::shading::{Layer, through};
use super::window::Window;
use crate::PlotError;
use crate::canvas::Rgb;
use crate::picture::view::View;
use crate::snapshots::grains::{Grain, Selection, of_images};
use crate::snapshots::images::Image;
use crate::snapshots::snapshot::Snapshot;

/// Samples along either axis of a pixel, where memory allows.
const FINE: usize = 3;

/// Samples of all layers of a panel at most: some 24 bytes each.
const MOST_SAMPLES: usize = 40_000_000;

/// Pixels of a panel at most.
pub const MOST_PIXELS: usize = 100_000_000;

/// Radius of a ball over its size s: a little more than 1/√2, so that faces of a cubic lattice are closed
/// and nothing is seen between its columns.
pub const RADIUS: f64 = 0.72;

/// Radius of occlusion, over the diagonal of the panel.
const AROUND: f32 = 0.045;

/// The scene, without the snapshot.
pub struct Stage<'a> {
    pub selection: &'a Selection,
    pub camera: &'a Camera,
    pub cuts: &'a Cuts,
    /// Numbers of the transparent bodies.
    pub transparent: &'a [usize],
    pub view: &'a View,
    /// About how near to the viewer all is (m).
    pub depth: f64,
}

impl Stage<'_> {
    /// The pixels of a snapshot on a panel of columns and rows, row by row from the top; `numbers` are those of its bodies in the
    /// picture, `colour` gives that of a sample before light falls on it.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the snapshot cannot be read.
    pub fn draw(
        &self,
        snapshot: &Snapshot,
        numbers: &[usize],
        size: [usize; 2],
        colour: impl Fn(&Seen) -> Rgb + Sync,
    ) -> Result<Vec<Rgb>, PlotError> {
        let fine = fine(size, self.layers());
        let samples = size.map(|n| n * fine);
        let window = Window::new(
            samples,
            self.view,
            self.depth,
            &self.cuts.slopes(self.camera),
        );
        let buffers = self.buffers(snapshot, numbers, &window)?;
        let diagonal = (window.columns as f32).hypot(window.rows as f32);
        let open: Vec<Vec<f32>> = buffers
            .iter()
            .map(|buffer| openness(&buffer.seen, &window, fine, AROUND * diagonal))
            .collect();
        let layers: Vec<Layer> = buffers
            .iter()
            .zip(&open)
            .map(|(buffer, open)| Layer {
                seen: &buffer.seen,
                open,
            })
            .collect();
        Ok(pixels(&layers, size, fine, &colour))
    }

    /// Number of layers: the opaque bodies, and each transparent one.
    fn layers(&self) -> usize {
        1 + self.transparent.len()
    }

    /// The visible surface of the opaque bodies, then of each transparent one.
    fn buffers(
        &self,
        snapshot: &Snapshot,
        numbers: &[usize],
        window: &Window,
    ) -> Result<Vec<Buffer>, PlotError> {
        let layers = 0..self.layers();
        let mut buffers: Vec<Buffer> = layers.map(|_| Buffer::new(window)).collect();
        let mirrors = self.selection.mirrors(snapshot);
        for rows in snapshot.chunks() {
            let grains = self.selection.grains(snapshot, numbers, rows)?;
            for (layer, buffer) in buffers.iter_mut().enumerate() {
                let balls = of_images(&grains, &mirrors, |grain, image| {
                    (self.layer(grain.body) == layer).then(|| self.ball(grain, image, window))
                });
                buffer.draw(&balls, window);
            }
        }
        Ok(buffers)
    }

    /// The layer that a body is in.
    fn layer(&self, body: usize) -> usize {
        let index = self.transparent.iter().position(|&b| b == body);
        index.map_or(0, |index| index + 1)
    }

    /// An image of a particle on its way into the picture.
    fn ball(&self, grain: &Grain, image: &Image, window: &Window) -> Ball {
        let shape = self.camera.shape(&image.shape).ellipsoid;
        Ball {
            at: window.to_samples(self.camera.project(&image.point)),
            outline: Outline::new(&shape, window.length(RADIUS)),
            value: single(image.signed(grain.value)),
            body: u16::try_from(grain.body).unwrap_or(u16::MAX - 1),
        }
    }
}

#[expect(
    clippy::cast_possible_truncation,
    reason = "a colour needs no more digits"
)]
fn single(value: f64) -> f32 {
    value as f32
}

/// Samples along either axis of a pixel.
fn fine([columns, rows]: [usize; 2], layers: usize) -> usize {
    let fits = |fine: &usize| fine * fine * columns * rows * layers <= MOST_SAMPLES;
    (1..=FINE).rev().find(fits).unwrap_or(1)
}

/// The means of the samples of each pixel.
fn pixels(
    layers: &[Layer],
    [columns, rows]: [usize; 2],
    fine: usize,
    colour: &(impl Fn(&Seen) -> Rgb + Sync),
) -> Vec<Rgb> {
    let row = |y: usize| {
        let mut order = Vec::new();
        let mut pixels = Vec::with_capacity(columns);
        for x in 0..columns {
            let mut sum = [0.0; 3];
            for k in 0..fine * fine {
                let (column, row) = (fine * x + k % fine, fine * y + k / fine);
                let sample = through(layers, row * columns * fine + column, colour, &mut order);
                for (sum, sample) in sum.iter_mut().zip(sample) {
                    *sum += sample;
                }
            }
            pixels.push(sum.map(|sum| byte(sum / (fine * fine) as f32)));
        }
        pixels
    };
    (0..rows).into_par_iter().flat_map_iter(row).collect()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a float cast saturates"
)]
fn byte(value: f32) -> u8 {
    value.round() as u8
}
