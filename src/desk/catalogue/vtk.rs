//! Surfaces as polygonal data of VTK's legacy format.
//!
//! Layout: Kitware, VTK File Formats for VTK 4.2; binary numbers are big-endian.

use super::Solid;

/// The surfaces of pieces, with numbers of each piece on its triangles.
#[must_use]
pub fn polydata(title: &str, solids: &[Solid], columns: &[(&str, Vec<f64>)]) -> Vec<u8> {
    let count: usize = solids.iter().map(|solid| solid.triangles.len()).sum();
    // One line of at most 256 characters.
    let title: String = title
        .chars()
        .filter(|c| !c.is_control())
        .take(200)
        .collect();
    let mut bytes = format!(
        "# vtk DataFile Version 3.0\n{title}\nBINARY\nDATASET POLYDATA\nPOINTS {} double\n",
        3 * count
    )
    .into_bytes();
    for corner in solids
        .iter()
        .flat_map(|solid| solid.triangles.as_flattened())
    {
        bytes.extend(corner.iter().flat_map(|x| x.to_be_bytes()));
    }
    bytes.extend(format!("\nPOLYGONS {count} {}\n", 4 * count).bytes());
    for first in (0_i32..).step_by(3).take(count) {
        bytes.extend(
            [3, first, first + 1, first + 2]
                .iter()
                .flat_map(|n: &i32| n.to_be_bytes()),
        );
    }
    bytes.extend(format!("\nCELL_DATA {count}\n").bytes());
    for (name, values) in columns {
        bytes.extend(format!("SCALARS {name} double 1\nLOOKUP_TABLE default\n").bytes());
        for (solid, value) in solids.iter().zip(values) {
            for _ in &solid.triangles {
                bytes.extend(value.to_be_bytes());
            }
        }
        bytes.push(b'\n');
    }
    bytes
}
