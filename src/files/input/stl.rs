//! Triangles from STL files, binary or ASCII.

use std::io::Cursor;

/// Bytes of a binary file before its triangles, and of each of these.
const HEAD: usize = 84;
const TRIANGLE: usize = 50;

/// The triangles of a content, in its own units.
///
/// # Errors
/// The fault.
pub fn triangles(mut bytes: Vec<u8>) -> Result<Vec<[[f64; 3]; 3]>, String> {
    prepare(&mut bytes)?;
    let mut content = Cursor::new(bytes);
    let triangles = stl_io::create_stl_reader(&mut content).map_err(|cause| cause.to_string())?;
    let mut soup = Vec::new();
    for triangle in triangles {
        let vertices = triangle.map_err(|cause| cause.to_string())?.vertices;
        if vertices.iter().any(|v| v.0.iter().any(|x| !x.is_finite())) {
            let number = soup.len() + 1;
            return Err(format!("triangle {number} has a corner that is no number"));
        }
        soup.push(vertices.map(|v| v.0.map(f64::from)));
    }
    Ok(soup)
}

/// Makes the first bytes say which of the two kinds the content is: binary files may begin with
/// any words, `solid` among them, and ASCII files may have no name. What tells is the length.
fn prepare(bytes: &mut Vec<u8>) -> Result<(), String> {
    let count = bytes
        .get(80..HEAD)
        .map(|n| u32::from_le_bytes([n[0], n[1], n[2], n[3]]));
    if count.is_some_and(|n| bytes.len() == HEAD + TRIANGLE * n as usize) {
        bytes[..80].fill(0);
        return Ok(());
    }
    let start = bytes.iter().position(|b| !b.is_ascii_whitespace());
    let start = start.filter(|&s| bytes[s..].starts_with(b"solid"));
    let line = start.and_then(|s| bytes[s..].iter().position(|&b| b == b'\n').map(|n| s + n));
    match line {
        Some(end) => {
            bytes.splice(..end, *b"solid surface");
            Ok(())
        }
        None => Err(
            "it is no STL file: neither does it begin with `solid`, nor is it as long as \
                     its number of triangles says"
                .to_owned(),
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn count(bytes: &[u8]) -> Result<usize, String> {
        triangles(bytes.to_vec()).map(|soup| soup.len())
    }

    fn binary(header: &[u8], count: u32) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(80, b' ');
        bytes.extend(count.to_le_bytes());
        bytes.extend((0_u8..).take(count as usize).flat_map(|n| {
            let mut triangle = [0; 50];
            triangle[12..16].copy_from_slice(&(1.0 + f32::from(n)).to_le_bytes());
            triangle
        }));
        bytes
    }

    #[test]
    fn both_kinds_whatever_they_begin_with() {
        assert_eq!(count(&binary(b"", 3)), Ok(3));
        assert_eq!(count(&binary(b"solid of a careless program", 2)), Ok(2));
        let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n\
                     endloop\nendfacet\n";
        for head in ["solid", "solid part 7", "\n  solid\t"] {
            let text = format!("{head}\n{facet}{facet}endsolid\n");
            assert_eq!(count(text.as_bytes()), Ok(2));
        }
    }

    #[test]
    fn what_is_neither_is_refused() {
        let short = &binary(b"", 3)[..200];
        for bytes in [short, b"", b"PK\x03\x04", b"solid"] {
            assert!(count(bytes).unwrap_err().contains("no STL file"));
        }
        assert!(count(b"solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 zero 0\n").is_err());
        let mut bytes = binary(b"", 1);
        bytes[96..100].copy_from_slice(&f32::NAN.to_le_bytes());
        assert!(count(&bytes).unwrap_err().contains("triangle 1"));
    }
}
