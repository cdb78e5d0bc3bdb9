//! Closed surfaces of triangles from files, for bodies and for rigid surfaces.

use std::io;
use std::path::Path;
use std::sync::Arc;

use toml::Spanned;

use super::shapes::{unit, vector};
use crate::input::schema::MeshFileParams;
use crate::input::source::{Diagnostic, nearest};
use crate::input::triangles::{self, Format};
use model::Mesh;

/// Inputs of the reading of meshes.
pub struct MeshReader<'a> {
    /// Folder of the files that the case names.
    pub folder: &'a Path,
    /// Particle spacing (m): what is smaller is mended.
    pub spacing: f64,
    /// Use of it: a body, a rigid surface.
    pub what: &'a str,
}

impl MeshReader<'_> {
    /// The mesh of a file, in its place.
    pub fn read(
        &self,
        table: &Spanned<MeshFileParams>,
        format: Format,
    ) -> Result<Arc<Mesh>, Diagnostic> {
        let params = table.get_ref();
        let unit_length = params.unit()?;
        let at = vector("at", params.at.as_ref(), 3)?;
        let path = self.folder.join(params.file.get_ref());
        let refuse = |cause: &str| {
            let title = format!(
                "cannot take the surface `{}`: {cause}",
                params.file.get_ref()
            );
            Diagnostic::new(params.file.span(), title)
        };
        let (mut soup, file) = triangles::read(&path, format).map_err(|cause| {
            let diagnostic = refuse(&cause.to_string());
            if cause.kind() == io::ErrorKind::NotFound {
                missing_file(diagnostic, &path)
            } else {
                diagnostic
            }
        })?;
        let known = params.sha256.as_ref();
        if let Some(known) = known.filter(|digest| *digest.get_ref() != file.sha256) {
            let title = format!(
                "the file {} is no longer the one that the case began with",
                file.path
            );
            return Err(Diagnostic::new(known.span(), title)
                .help("bring it back, or begin a new case without `sha256`"));
        }
        let turn = params.turn.as_ref();
        let turn = turn.map(|turn| (unit(*turn.axis.get_ref()), turn.angle.get_ref().si));
        let mirror = params.mirror.as_ref().map(|axis| axis.get_ref().index());
        for x in soup.iter_mut().flatten() {
            if let Some(axis) = mirror {
                x[axis] = -x[axis];
            }
            let scaled = x.map(|c| c * unit_length);
            let turned = turn.map_or(scaled, |(axis, angle)| turned(&scaled, &axis, angle));
            *x = std::array::from_fn(|a| turned[a] + at[a]);
        }
        if soup.iter().flatten().flatten().any(|c| !c.is_finite()) {
            let title = "with this `unit` the surface has corners that are no numbers";
            return Err(Diagnostic::new(params.unit.span(), title));
        }
        let mesh = Mesh::mend(&soup, self.spacing).map_err(|cause| {
            let help = format!("a {} must be one or more closed solids", self.what);
            refuse(&cause.to_string()).help(help)
        })?;
        Ok(Arc::new(mesh.of_file(file)))
    }
}

/// Says where a file was looked for, and which other one there may be meant.
pub(super) fn missing_file(diagnostic: Diagnostic, path: &Path) -> Diagnostic {
    let text =
        |name: Option<&std::ffi::OsStr>| name.unwrap_or_default().to_string_lossy().into_owned();
    let folder = path.parent().unwrap_or(Path::new(""));
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut there: Vec<String> = entries
        .map(|entry| text(Some(&entry.file_name())))
        .collect();
    there.sort();
    let there: Vec<&str> = there.iter().map(String::as_str).collect();
    let diagnostic = diagnostic.help(format!("it is looked for at {}", path.display()));
    match nearest(&text(path.file_name()), &there) {
        Some(name) => diagnostic.label(format!("did you mean `{name}`?")),
        None => diagnostic,
    }
}

/// A vector turned by an angle (rad) about a coordinate axis.
fn turned(x: &[f64; 3], axis: &[f64; 3], angle: f64) -> [f64; 3] {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    let n = (0..3).position(|a| axis[a] == 1.0).unwrap_or(2);
    let (k, l) = ((n + 1) % 3, (n + 2) % 3);
    let mut turned = *x;
    turned[k] = c * x[k] - s * x[l];
    turned[l] = s * x[k] + c * x[l];
    turned
}
