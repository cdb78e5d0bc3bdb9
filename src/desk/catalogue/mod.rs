//! A catalogue of pieces of matter: the closed surface of each, and what follows from it (theory page "Fragments").

pub mod breakup;
mod silhouette;
mod vtk;

use rayon::prelude::*;

use crate::export::surface::{Ball, Triangle, of_balls};
use numerics::principal::principal;
use plot::Shape;
pub use vtk::polydata;

/// A particle of a piece.
#[derive(Debug, Clone, Copy)]
pub struct Grain {
    /// Its place (m).
    pub centre: [f64; 3],
    /// Its size at the start (m).
    pub size: f64,
    /// Its deformation gradient, if it has one.
    pub deformation: Option<[f64; 9]>,
    /// The piece that it is of.
    pub piece: u32,
}

/// What the surface of a piece tells.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Solid {
    /// Its surface, closed; corners (m) turn against the clock as seen from outside.
    pub triangles: Vec<Triangle>,
    /// Volume of its particles at the start (m³), which the surface encloses.
    pub volume: f64,
    /// Area of the surface (m²).
    pub area: f64,
    /// Mean of the areas (m²) of its shadows, over all directions.
    pub cross_section: f64,
    /// Extents (m) along its principal axes, the longest first.
    pub lengths: [f64; 3],
}

impl Solid {
    /// The same with the areas of a mean without width, by those of a wider one.
    fn without_width(self, wider: &Self) -> Self {
        let [own, other] = WIDTHS;
        let area = |a: f64, b: f64| a + (a - b) * own / (other - own);
        Self {
            area: area(self.area, wider.area),
            cross_section: area(self.cross_section, wider.cross_section),
            ..self
        }
    }

    /// The characteristic length (m): the mean of the three extents.
    #[must_use]
    pub fn characteristic_length(&self) -> f64 {
        self.lengths.iter().sum::<f64>() / 3.0
    }
}

/// Least part of a piece's volume that its averaged surface may enclose.
const LEAST: f64 = 0.7;

/// Particles of a piece up to which its cells are half as large as the finest of them; those of what is left of a target are
/// between the finest and the mean.
const FINE: usize = 20_000;

/// The pieces that particles make, so many. A surface lies where matter ends to a small part of a spacing: it is scaled
/// about its centre, so that it encloses the volume that the particles had at the start.
///
/// # Errors
/// A message if the particles of a piece are too unequal, or too far apart, for cells of their size.
pub fn solids(grains: &[Grain], pieces: usize) -> Result<Vec<Solid>, String> {
    let mut members: Vec<Vec<&Grain>> = vec![Vec::new(); pieces];
    for grain in grains {
        members[grain.piece as usize].push(grain);
    }
    members.par_iter().map(|grains| of(grains)).collect()
}

/// Widths of two means about a place: the layers of a lattice leave .1 % of an area with the first one.
const WIDTHS: [f64; 2] = [1.25, 1.75];

/// A piece by its particles. Its surface is where half of a place's surroundings are filled, on which the layers of a lattice leave no
/// steps; that of particles that hang together loosely is where they are, as in pictures. A mean rounds edges by a part of
/// its width: areas are those of no width, by two of them (Richardson 1911). Edges of what has many particles are
/// little of it.
fn of(grains: &[&Grain]) -> Result<Solid, String> {
    let wide = |width: f64| -> Result<Option<Solid>, String> {
        let shape = |grain: &Grain| shape(grain).averaged(width);
        surrounded(grains, shape, LEAST)
    };
    if let Some(solid) = wide(WIDTHS[0])? {
        let wider = if grains.len() <= FINE {
            wide(WIDTHS[1])?
        } else {
            None
        };
        return Ok(wider.map_or(solid.clone(), |wider| solid.without_width(&wider)));
    }
    let solid = surrounded(grains, shape, 0.0)?;
    Ok(solid.unwrap_or_else(|| Solid {
        volume: grains.iter().map(|grain| grain.size.powi(3)).sum(),
        ..Solid::default()
    }))
}

/// What a particle fills by itself.
fn shape(grain: &Grain) -> Shape {
    let image = |gradient| Shape::image(grain.size, gradient, 3);
    let image = grain.deformation.as_ref().and_then(image);
    image.unwrap_or_else(|| Shape::ball(grain.size))
}

/// A piece by the surface of such shapes of its particles; none if that encloses no more than a part of their volume.
fn surrounded(
    grains: &[&Grain],
    shape: impl Fn(&Grain) -> Shape,
    least: f64,
) -> Result<Option<Solid>, String> {
    let ball = |grain: &&Grain| Ball {
        centre: grain.centre,
        shape: shape(grain),
        body: 0,
    };
    let balls: Vec<Ball> = grains.iter().map(ball).collect();
    let sizes = || grains.iter().map(|grain| grain.size);
    let finest = sizes().fold(f64::INFINITY, f64::min);
    let volume: f64 = sizes().map(|size| size.powi(3)).sum();
    #[expect(clippy::cast_precision_loss, reason = "fewer than 2^52")]
    let mean = libm::cbrt(volume / grains.len() as f64);
    let pitch = if grains.len() <= FINE {
        0.5 * finest
    } else {
        (finest * mean).sqrt()
    };
    let triangles = of_balls(&balls, 1, pitch)?.pop().unwrap_or_default();
    let (enclosed, centre) = enclosed(&triangles);
    let is_whole = enclosed > least * volume;
    Ok(is_whole.then(|| {
        let scale = libm::cbrt(volume / enclosed);
        solid(triangles, (&centre, scale), volume)
    }))
}

/// A piece of a volume (m³) by its surface, which is scaled about its centre.
fn solid(mut triangles: Vec<Triangle>, (centre, scale): (&[f64; 3], f64), volume: f64) -> Solid {
    for corner in triangles.iter_mut().flatten() {
        for a in 0..3 {
            corner[a] = centre[a] + scale * (corner[a] - centre[a]);
        }
    }
    Solid {
        volume,
        area: triangles.iter().map(|t| 0.5 * norm(&normal(t))).sum(),
        cross_section: silhouette::mean(&triangles, centre),
        lengths: lengths(&triangles, centre),
        triangles,
    }
}

/// The volume (m³) that a surface encloses, and its centre (m).
fn enclosed(triangles: &[Triangle]) -> (f64, [f64; 3]) {
    let Some([origin, ..]) = triangles.first() else {
        return (0.0, [0.0; 3]);
    };
    let (mut volume, mut moment) = (0.0, [0.0; 3]);
    for triangle in triangles {
        let [a, b, c] = triangle.map(|corner| difference(&corner, origin));
        // Of the tetrahedron on the origin.
        let part = dot(&a, &cross(&b, &c)) / 6.0;
        volume += part;
        for k in 0..3 {
            moment[k] += part * 0.25 * (a[k] + b[k] + c[k]);
        }
    }
    (
        volume,
        std::array::from_fn(|k| origin[k] + moment[k] / volume),
    )
}

/// Extents along the principal axes of a surface's second moments about a centre.
fn lengths(triangles: &[Triangle], centre: &[f64; 3]) -> [f64; 3] {
    let mut second = [0.0; 6];
    for triangle in triangles {
        let area = norm(&normal(triangle));
        let middle: [f64; 3] = std::array::from_fn(|a| {
            (triangle[0][a] + triangle[1][a] + triangle[2][a]) / 3.0 - centre[a]
        });
        for (c, (a, b)) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)]
            .into_iter()
            .enumerate()
        {
            second[c] += area * middle[a] * middle[b];
        }
    }
    let (_, columns) = principal(&second);
    let axes: [[f64; 3]; 3] = std::array::from_fn(|k| columns.map(|row| row[k]));
    let extent = |axis: &[f64; 3]| {
        let along = triangles.iter().flatten().map(|corner| dot(corner, axis));
        let (low, high) = along.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| {
            (low.min(x), high.max(x))
        });
        high - low
    };
    let mut lengths = axes.map(|axis| extent(&axis));
    lengths.sort_by(|a, b| b.total_cmp(a));
    lengths
}

/// Twice the area of a triangle (m²), along its normal.
fn normal([a, b, c]: &Triangle) -> [f64; 3] {
    cross(&difference(b, a), &difference(c, a))
}

fn difference(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn norm(a: &[f64; 3]) -> f64 {
    dot(a, a).sqrt()
}

fn cross(a: &[f64; 3], b: &[f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// The particles of a cubic lattice, turned, that are in a body.
    fn filled(inside: impl Fn([f64; 3]) -> bool, piece: u32) -> Vec<Grain> {
        let (cosine, sine) = (0.8, 0.6);
        let cells = (0..40_i32.pow(3)).map(|n| [n % 40, n / 40 % 40, n / 1600]);
        let places = cells.map(|cell| cell.map(|k| f64::from(k) - 19.5));
        let grain = |[x, y, z]: [f64; 3]| Grain {
            centre: [
                cosine * x - sine * y + 100.0 * f64::from(piece),
                sine * x + cosine * y,
                z,
            ],
            size: 1.0,
            deformation: None,
            piece,
        };
        places.filter(|place| inside(*place)).map(grain).collect()
    }

    /// Known round bodies of some twenty particles across have their figures to one per cent.
    #[test]
    fn known_bodies_are_exact() {
        let square = |[x, y, z]: [f64; 3], [a, b, c]: [f64; 3]| {
            (x / a).powi(2) + (y / b).powi(2) + (z / c).powi(2)
        };
        let mut grains = filled(|x| square(x, [12.0; 3]) < 1.0, 0);
        let box_ = [30.0, 20.0, 10.0];
        grains.extend(filled(|x| (0..3).all(|a| x[a].abs() < 0.5 * box_[a]), 1));
        let axes = [18.0, 12.0, 9.0];
        grains.extend(filled(|x| square(x, axes) < 1.0, 2));
        let [ball, cuboid, ellipsoid] = &solids(&grains, 3).unwrap()[..] else {
            panic!("three");
        };
        let within = |bound: f64, found: f64, exact: f64, what: &str| {
            let part = found / exact - 1.0;
            println!("{what}: {found:.4} of {exact:.4}, {:+.2} %", 100.0 * part);
            assert!(part.abs() < bound, "{what}: {found} of {exact}");
        };
        let near = |found, exact, what: &str| within(0.01, found, exact, what);
        near(
            ball.volume,
            4.0 / 3.0 * PI * 12.0_f64.powi(3),
            "volume of the ball",
        );
        near(ball.area, 4.0 * PI * 144.0, "area of the ball");
        near(ball.cross_section, PI * 144.0, "cross-section of the ball");
        near(ball.characteristic_length(), 24.0, "length of the ball");
        near(cuboid.volume, 6000.0, "volume of the cuboid");
        // Its edges are rounded.
        within(0.02, cuboid.area, 2200.0, "area of the cuboid");
        within(
            0.02,
            cuboid.cross_section,
            550.0,
            "cross-section of the cuboid",
        );
        within(
            0.015,
            cuboid.characteristic_length(),
            20.0,
            "length of the cuboid",
        );
        let [a, b, c] = axes.map(|a: f64| a.powf(1.6075));
        let area = 4.0 * PI * ((a * b + a * c + b * c) / 3.0).powf(1.0 / 1.6075);
        near(ellipsoid.area, area, "area of the ellipsoid");
        near(
            ellipsoid.cross_section,
            0.25 * area,
            "cross-section of the ellipsoid",
        );
        for (found, exact) in ellipsoid.lengths.into_iter().zip(axes) {
            near(found, 2.0 * exact, "axis of the ellipsoid");
        }
    }
}
