//! Small files that name very much.

use std::io::Write as _;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use flate2::Compression;
use flate2::write::ZlibEncoder;

use super::read;
use crate::input::cloud::{Columns, Request, TakeName, UnitSystem};

/// So many points at zero, and arrays, in a file.
fn refused(points: usize, arrays: &str) -> String {
    let bytes = 24 * points as u64;
    let mut packed = ZlibEncoder::new(Vec::new(), Compression::best());
    packed.write_all(&vec![0; 24 * points]).unwrap();
    let packed = packed.finish().unwrap();
    let head = [1, bytes, 0, packed.len() as u64].map(u64::to_le_bytes);
    let data = STANDARD.encode(head.concat()) + &STANDARD.encode(packed);
    let text = format!(
        "<VTKFile type=\"PolyData\" header_type=\"UInt64\" compressor=\"vtkZLibDataCompressor\">\
         <PolyData><Piece NumberOfPoints=\"{points}\"><PointData>{arrays}</PointData><Points>\
         <DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/>\
         </Points></Piece></PolyData><AppendedData encoding=\"base64\">_{data}</AppendedData></VTKFile>"
    );
    let request = Request {
        dimension: 3,
        units: UnitSystem {
            length: Some(1.0),
            mass: Some(1.0),
            time: Some(1.0),
        },
        columns: Columns::default(),
        parts: Vec::new(),
        take: TakeName::Elements,
    };
    match read(text.as_bytes(), &request) {
        Ok(table) => format!("{} rows", table.rows()),
        Err(fault) => fault.words,
    }
}

#[test]
fn small_files_take_little_memory_and_time() {
    let array = |name: &str| {
        format!(
            "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"3\" \
             format=\"appended\" offset=\"0\"/>"
        )
    };
    // Arrays that nobody asks for are not read.
    assert_eq!(
        refused(100_000, &array("other").repeat(1000)),
        "100000 rows"
    );
    let most = "it takes more than 32 times its length and 64 MiB of memory";
    for said in [
        refused(100_000, &array("velocity").repeat(1000)),
        refused(10_000_000, ""),
    ] {
        assert!(said.ends_with(most), "{said}");
    }
    for attribute in ["a", "xmlns:a"] {
        let many: Vec<String> = (0..1001).map(|n| format!(" {attribute}{n}='1'")).collect();
        let many = many.concat();
        let said = refused(1, &format!("<b{many}/>"));
        assert!(said.contains("too many attributes"), "{said}");
    }
}
