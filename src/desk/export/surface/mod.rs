//! Surfaces of bodies: where pictures draw their outlines, in three dimensions.
//!
//! A place belongs to a body where the weights of the body's particles add up to one, and to no
//! less than those of any other body (`plot/picture/cells.rs`). So the level of a body b at a place is
//!
//! ```text
//! f_b = S_b^¼ − max(1, max_{c ≠ b} S_c^¼) ,   S_b = Σ_b w ,
//! ```
//!
//! inside where it is not negative; two bodies in touch share their interface. Space is cut into
//! cells of half the finest spacing, and each that a surface passes through is cut by
//! [`cubes`].

mod blocks;
mod cubes;
mod level;

use rayon::prelude::*;

use super::ExportError;
use super::frame::{Frame, Wish};
use blocks::Blocks;
pub use level::Ball;
use plot::{Bodies, Drawn, Selection};

/// Corners (m) of a triangle, which turn against the clock as seen from outside.
pub type Triangle = [[f64; 3]; 3];

/// The most particles of one snapshot: their numbers have 32 bits.
const MOST: u64 = u32::MAX as u64;

/// The surface of each body of the model.
pub fn surfaces(frame: &Frame, wish: &Wish) -> Result<Vec<Vec<Triangle>>, ExportError> {
    if frame.snapshot.dimension != 3 {
        let reason = format!(
            "surfaces are of models of three dimensions, and this has {}",
            frame.snapshot.dimension
        );
        return Err(frame.wrong(reason));
    }
    let pitch = wish.cell.unwrap_or(0.5 * frame.snapshot.finest());
    let balls = balls(frame, wish.mirror)?;
    let bodies = frame.snapshot.bodies.len();
    of_balls(&balls, bodies, pitch).map_err(|reason| frame.wrong(reason))
}

/// The surface of each of so many bodies, in cells of an edge (m).
///
/// # Errors
/// A message, if the cells are too small for the extent of the balls.
pub fn of_balls(balls: &[Ball], bodies: usize, pitch: f64) -> Result<Vec<Vec<Triangle>>, String> {
    let blocks = Blocks::new(balls, pitch)?;
    let of_blocks: Vec<Vec<(u32, Triangle)>> = (0..blocks.count())
        .into_par_iter()
        .map(|block| blocks.triangles(balls, block))
        .collect();
    let mut surfaces = vec![Vec::new(); bodies];
    for (body, triangle) in of_blocks.into_iter().flatten() {
        surfaces[body as usize].push(triangle);
    }
    Ok(surfaces)
}

/// The balls that fill space: all particles that are still part of the model, and their images.
fn balls(frame: &Frame, mirror: bool) -> Result<Vec<Ball>, ExportError> {
    let snapshot = &frame.snapshot;
    let selection = Selection {
        bodies: Bodies::default(),
        drawn: Drawn::Body,
        mirror,
    };
    let mirrors = selection.mirrors(snapshot);
    let copies = (0..mirrors.planes().count()).fold(1, |copies: u64, _| copies.saturating_mul(2));
    let rows = copies.saturating_mul(snapshot.file.particles() as u64);
    if rows > MOST {
        return Err(frame.wrong(format!("{rows} particles are too many for surfaces")));
    }
    // Two bodies of one name are two here.
    let numbers: Vec<usize> = (0..snapshot.bodies.len()).collect();
    let (mut balls, mut images) = (Vec::new(), Vec::new());
    for rows in snapshot.chunks() {
        let grains = selection.grains(snapshot, &numbers, rows)?;
        for grain in grains.iter().filter(|grain| grain.shape.size(0) > 0.0) {
            mirrors.reflect(&grain.point, &grain.shape, &mut images);
            balls.extend(images.iter().map(|image| Ball {
                centre: image.point,
                shape: image.shape,
                #[expect(
                    clippy::cast_possible_truncation,
                    reason = "bodies are as many as an attribute can name"
                )]
                body: grain.body as u32,
            }));
        }
    }
    Ok(balls)
}
