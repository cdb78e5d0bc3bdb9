//! Repaired surfaces from files, and those that cannot be repaired.

use std::path::Path;

use model::Case;

/// One line for each surface that is not as its file has it.
pub fn warnings(case: &Case, messages: &mut Vec<String>) {
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
