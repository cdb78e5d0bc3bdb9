//! Binary STL: the surface of a body as triangles. Coordinates are of single precision, as the
//! format has them, in metres, which it cannot say but in its head.

use super::ExportError;
use super::surface::Triangle;
use super::text::line;
use files::output::NewFile;

/// Bytes of the head.
const HEAD: usize = 80;
/// Bytes of a triangle.
const EACH: usize = 50;
/// Triangles that are put at a time.
const PART: usize = 1 << 14;

/// Writes the surface of a body.
pub fn write(
    name: &str,
    time: f64,
    surface: &[Triangle],
    out: &mut NewFile,
) -> Result<(), ExportError> {
    let count = u32::try_from(surface.len()).map_err(|_| {
        let many = surface.len();
        ExportError::Options(format!(
            "a surface of {many} triangles is too large: give larger cells with --cell"
        ))
    })?;
    // No head may begin with "solid": texts do.
    let mut head = format!("whipple: {}, t = {time:?} s, in metres", line(name)).into_bytes();
    head.resize(HEAD, b' ');
    out.put(&head)?;
    out.put(&count.to_le_bytes())?;
    for part in surface.chunks(PART) {
        let mut bytes = Vec::with_capacity(part.len() * EACH);
        for triangle in part {
            let vectors = [normal(triangle)].into_iter().chain(*triangle);
            for x in vectors.flatten() {
                #[expect(clippy::cast_possible_truncation, reason = "the format's precision")]
                bytes.extend((x as f32).to_le_bytes());
            }
            bytes.extend([0; 2]);
        }
        out.put(&bytes)?;
    }
    Ok(())
}

/// The unit normal of a triangle; zero of one without an area.
fn normal([a, b, c]: &Triangle) -> [f64; 3] {
    let side = |to: &[f64; 3]| -> [f64; 3] { std::array::from_fn(|k| to[k] - a[k]) };
    let (u, v) = (side(b), side(c));
    let cross: [f64; 3] = std::array::from_fn(|k| {
        let (i, j) = ((k + 1) % 3, (k + 2) % 3);
        u[i] * v[j] - u[j] * v[i]
    });
    let length = cross.iter().map(|x| x * x).sum::<f64>().sqrt();
    if length > 0.0 {
        cross.map(|x| x / length)
    } else {
        [0.0; 3]
    }
}
