//! Repaired surfaces from files, and those that cannot be repaired.

use std::path::Path;

use model::{Case, cube};

/// A particle of a surface's body may have so much more or less mass than fills its cell: few layers
/// of particles do not fill a part.
const MOST_MISFIT: f64 = 0.25;

/// One line for each surface that is not as its file has it, and each body that it does not fill.
pub fn warnings(case: &Case, messages: &mut Vec<String>) {
    for body in &case.bodies {
        let mut meshes = Vec::new();
        let solid = body.shape.solid(case.dimension);
        solid.meshes(&mut meshes);
        let cell = cube(body.lattice.spacing, case.dimension);
        let more = body.lattice.particle_volume(case.dimension) / cell - 1.0;
        if !meshes.is_empty() && more.abs() > MOST_MISFIT {
            let word = if more > 0.0 { "more" } else { "less" };
            messages.push(format!(
                "each particle of `{}` has {:.0} % {word} mass than fills its cell: parts of its surface are \
                 thinner than a few spacings, or lie in one another",
                body.name,
                100.0 * more.abs()
            ));
        }
    }
    for (owner, mesh) in case.meshes() {
        let path = mesh.file().map(|file| Path::new(&file.path));
        let name = path.and_then(Path::file_name).unwrap_or_default();
        let name = name.to_string_lossy();
        if let Some(words) = mesh.mended().words() {
            messages.push(format!("`{name}` of `{owner}` was mended: {words}"));
        }
        if let Some(crossing) = mesh.crossing() {
            let pairs = if crossing.count == 1 { "pair" } else { "pairs" };
            messages.push(format!(
                "{} {pairs} of triangles of `{name}` of `{owner}` cut through each other, as near {}, \
                 where inside and outside may be mistaken: parts that overlap go together by `union`, \
                 one file each",
                crossing.count,
                case.length_unit.vector(&crossing.at)
            ));
        }
    }
}
