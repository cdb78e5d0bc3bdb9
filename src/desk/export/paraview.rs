//! A script that opens snapshots in ParaView, by itself or as a macro.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::ExportError;
use files::FileOpener;
use files::output::{NewFile, RunFolder};
use plot::{Snapshot, colour_of};

const TEMPLATE: &str = include_str!("open_in_paraview.py");
/// Its name.
pub const NAME: &str = "open_in_paraview.py";

/// Writes the script for a run, of which `snapshot` is one, or for a snapshot alone.
pub fn write(run: Option<&Path>, snapshot: &Path, out: &mut NewFile) -> Result<(), ExportError> {
    let known = Snapshot::open(&FileOpener, snapshot)?;
    let series = run.map(|run| RunFolder::at(run).series());
    let series = series.filter(|series| series.is_file());
    let opened = series.as_deref().unwrap_or(snapshot);
    let path = absolute(opened);
    let folder = absolute(out.path());
    let beside = folder
        .parent()
        .and_then(|folder| path.strip_prefix(folder).ok());
    let beside = beside.unwrap_or(&path);
    let planes = known.symmetry.iter();
    let planes: Vec<Value> = planes
        .map(|p| json!([p.axis.index(), p.position]))
        .collect();
    let colours: Vec<_> = (0..known.bodies.len()).map(colour_of).collect();
    let mut script = String::new();
    // Names are never searched for further marks.
    for (k, part) in TEMPLATE.split('@').enumerate() {
        let value = match part {
            _ if k % 2 == 0 => {
                script.push_str(part);
                continue;
            }
            "TITLE" => json!(known.title),
            "SNAPSHOTS" => json!(beside.to_string_lossy()),
            "PLACE" => json!(path.to_string_lossy()),
            "BODIES" => json!(known.bodies),
            "COLOURS" => json!(colours),
            "RADIUS" => json!(0.5 * known.finest()),
            _ => json!(planes),
        };
        script.push_str(&value.to_string());
    }
    Ok(out.put(script.as_bytes())?)
}

fn absolute(path: &Path) -> PathBuf {
    let folder = |path: &Path| path.canonicalize().ok();
    let parent = match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => folder(parent),
        _ => folder(Path::new(".")),
    };
    match (parent, path.file_name()) {
        (Some(parent), Some(name)) => parent.join(name),
        _ => path.to_owned(),
    }
}
