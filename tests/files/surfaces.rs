//! Surfaces of triangles, and files of them.

use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

/// The corners of a triangle, and of several.
pub type Triangle = [[f64; 3]; 3];
pub type Triangles = Vec<Triangle>;

/// A box between two corners, normals outwards.
pub fn cuboid(lower: [f64; 3], upper: [f64; 3]) -> Triangles {
    let x = |n: usize| std::array::from_fn(|a| if n >> a & 1 == 1 { upper[a] } else { lower[a] });
    let quads = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let triangles = quads
        .into_iter()
        .flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]);
    triangles.map(|t| t.map(x)).collect()
}

/// A torus about z of 2 `n` by `n` quads.
pub fn torus(n: u32, radius: f64, tube: f64) -> Triangles {
    let place = |i: u32, j: u32| {
        let turn = |k: u32, of: u32| TAU * f64::from(k % of) / f64::from(of);
        let (u, v) = (turn(i, 2 * n), turn(j, n));
        let r = radius + tube * v.cos();
        [r * u.cos(), r * u.sin(), tube * v.sin()]
    };
    of_quads(2 * n, n, place)
}

/// A ball of 2 `n` by `n` quads.
pub fn ball(n: u32, radius: f64) -> Triangles {
    let place = |i: u32, j: u32| {
        let (u, v) = (
            TAU * f64::from(i % (2 * n)) / f64::from(2 * n),
            0.5 * TAU * f64::from(j) / f64::from(n),
        );
        // Poles are one place.
        let s = if j == 0 || j == n { 0.0 } else { v.sin() };
        [
            radius * s * u.cos(),
            radius * s * u.sin(),
            -radius * v.cos(),
        ]
    };
    let mut triangles = of_quads(2 * n, n, place);
    triangles.retain(|t| t[0] != t[1] && t[1] != t[2] && t[2] != t[0]);
    triangles
}

fn of_quads(rows: u32, columns: u32, place: impl Fn(u32, u32) -> [f64; 3]) -> Triangles {
    let quads = (0..rows).flat_map(|i| (0..columns).map(move |j| (i, j)));
    let triangles = quads.flat_map(|(i, j)| {
        let [a, b, c, d] =
            [(i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)].map(|(i, j)| place(i, j));
        [[a, b, c], [a, c, d]]
    });
    triangles.collect()
}

/// Turned about an axis through the origin, as `turn` is.
pub fn turned(triangles: &[Triangle], axis: [f64; 3], angle: f64) -> Triangles {
    let turn = model::rotation(&axis.into(), angle);
    let place = |x: [f64; 3]| (turn * model::Vec3::from(x)).into();
    triangles.iter().map(|t| t.map(place)).collect()
}

/// Coordinates as a binary STL file holds them.
pub fn rounded(triangles: &[Triangle]) -> Triangles {
    #[allow(clippy::cast_possible_truncation, reason = "that is what is meant")]
    let round = |x: [f64; 3]| x.map(|c| f64::from(c as f32));
    triangles.iter().map(|t| t.map(round)).collect()
}

/// The volume, by tetrahedra from the first corner, summed without rounding to speak of.
pub fn volume(triangles: &[Triangle]) -> f64 {
    let from = triangles[0][0];
    let (mut sum, mut rest) = (0.0_f64, 0.0);
    for t in triangles {
        let [a, b, c] = t.map(|x| [x[0] - from[0], x[1] - from[1], x[2] - from[2]]);
        let part = (a[0] * (b[1] * c[2] - b[2] * c[1])
            + a[1] * (b[2] * c[0] - b[0] * c[2])
            + a[2] * (b[0] * c[1] - b[1] * c[0]))
            / 6.0;
        // Kahan.
        let part = part - rest;
        let next = sum + part;
        rest = (next - sum) - part;
        sum = next;
    }
    sum
}

/// Writes a binary STL file.
pub fn write_stl(path: &Path, triangles: &[Triangle]) {
    let mut bytes = vec![b' '; 80];
    bytes.extend(u32::try_from(triangles.len()).unwrap().to_le_bytes());
    for t in triangles {
        bytes.extend([0; 12]);
        for c in t.iter().flatten() {
            #[allow(clippy::cast_possible_truncation, reason = "that is what is meant")]
            bytes.extend((*c as f32).to_le_bytes());
        }
        bytes.extend([0; 2]);
    }
    std::fs::write(path, bytes).unwrap();
}

/// Writes an OBJ file, each triangle with places of its own.
pub fn write_obj(path: &Path, triangles: &[Triangle]) {
    let mut text = String::new();
    for t in triangles {
        for x in t {
            writeln!(text, "v {:?} {:?} {:?}", x[0], x[1], x[2]).unwrap();
        }
        text += "f -3 -2 -1\n";
    }
    std::fs::write(path, text).unwrap();
}
