//! Frames as LAMMPS, ASE and this program write them, and as they should not be.

use super::*;
use crate::input::cloud::{Columns, TakeName, Wanted};
use model::Quantity;

fn request(part: &str) -> Request {
    Request {
        dimension: 3,
        units: UnitSystem {
            length: Some(1e-3),
            mass: Some(1e-3),
            time: Some(1e-6),
        },
        columns: Columns::default(),
        parts: vec![Wanted::Name(part.to_owned())],
        take: TakeName::Elements,
    }
}

const DUMP: &str = "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: BOX BOUNDS ff ff ff\n\
    0 1\n0 1\n0 1\nITEM: ATOMS id type x y z\n1 1 0 0 0\n\
    ITEM: TIMESTEP\n5\nITEM: NUMBER OF ATOMS\n2\nITEM: BOX BOUNDS pp pp pp\n0 1\n0 1\n0 1\n\
    ITEM: ATOMS id type xu yu zu vx vy vz mass\n2 2 1 2 3 4 5 6 7\n1 1 9 9 9 0 0 0 1\n";
const XYZ: &str = "1\nProperties=species:S:1:pos:R:3\na 0 0 0\n2\n\
    Lattice=\"1 0 0 0 1 0 0 0 1\" Properties=species:S:1:pos:R:3:Z:I:1:part:I:1:velocity:R:3:mass:R:1 \
    title=\"no = one\"@UNITS@\nball 1 2 3 2 0 4 5 6 7\nwall 9 9 9 1 0 0 0 0 1\n";

#[test]
fn the_last_frame_is_read() {
    let si = DUMP.replacen("ITEM", "ITEM: UNITS\nsi\nITEM: TIME\n0.5\nITEM", 1);
    let units = " units=\"Time: s, position: m, velocity: m/s, mass: kg\"";
    let xyz = |text: &str| super::xyz(text, &request("ball")).unwrap();
    let lammps = |text: &str| super::lammps(text, &request("2")).unwrap();
    for (table, [length, velocity, mass]) in [
        (lammps(DUMP), [1e-3, 1e3, 1e-3]),
        (lammps(&si), [1.0; 3]),
        (xyz(&XYZ.replace("@UNITS@", "")), [1e-3, 1e3, 1e-3]),
        (xyz(&XYZ.replace("@UNITS@", units)), [1.0; 3]),
    ] {
        assert_eq!(table.rows(), 1);
        let near = |quantity, expected: &[f64]| {
            let found = table.get(quantity).unwrap();
            let off = found.iter().zip(expected).map(|(a, b)| (a / b - 1.0).abs());
            assert!(off.fold(0.0, f64::max) < 1e-12, "{found:?}");
        };
        near(Quantity::Position, &[1.0, 2.0, 3.0].map(|x| x * length));
        near(Quantity::Velocity, &[4.0, 5.0, 6.0].map(|x| x * velocity));
        near(Quantity::Mass, &[7.0 * mass]);
    }
}

#[test]
fn what_cannot_be_read_is_told_with_its_line() {
    let of = |from: &str, to: &str| DUMP.replace(from, to);
    for (text, said) in [
        (String::new(), "it has no `ITEM: ATOMS`"),
        ("1\n".to_owned(), "line 1: it is no LAMMPS dump"),
        (
            of("ATOMS\n2", "ATOMS\n3"),
            "line 19: the file ends too early",
        ),
        (
            of("ATOMS\n2", "ATOMS\n-2"),
            "line 14: `-2` is no number of things",
        ),
        (
            of("xu yu zu", "xs ys zs"),
            "line 19: scaled places are not read",
        ),
        (
            of("TIMESTEP\n5", "TABLE\n5"),
            "line 11: the item `TABLE` is not read",
        ),
        (of("9 9 9", "9 9 nan"), "line 21: `nan` is no number"),
        (of("9 9 9", "9 9"), "line 21: 8 values, and 9 columns"),
        (of("xu", "q"), "there is no column `x`"),
    ] {
        let words = lammps(&text, &request("2")).unwrap_err().words;
        assert!(words.contains(said), "{said}: {words}");
    }
    let of = |from: &str, to: &str| XYZ.replace(from, to);
    for (text, said) in [
        (String::new(), "it is empty"),
        ("x\n".to_owned(), "line 1: it is no XYZ file"),
        (of("2\nL", "99\nL"), "line 5: the file ends too early"),
        (of("Properties", "P"), "line 5: it has no `Properties`"),
        (of("pos:R:3", "pos:R"), "line 5: `Z` is no number of things"),
        (
            of("pos:R:3", "pos:R:0"),
            "line 5: the property `pos` has 0 columns",
        ),
        (
            of("@UNITS@", " units=\"mass: m\""),
            "the unit `m` of its column `mass`",
        ),
    ] {
        let words = xyz(&text, &request("ball")).unwrap_err().words;
        assert!(words.contains(said), "{said}: {words}");
    }
}
