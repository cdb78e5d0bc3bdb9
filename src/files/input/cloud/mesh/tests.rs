//! Volumes and middles of elements.

use super::{Kind, measure};

#[test]
fn volumes_and_middles_are_those_of_geometry() {
    let cube: Vec<[f64; 3]> = [
        [0, 0, 0],
        [2, 0, 0],
        [2, 2, 0],
        [0, 2, 0],
        [0, 0, 2],
        [2, 0, 2],
        [2, 2, 2],
        [0, 2, 2],
    ]
    .map(|x| x.map(f64::from))
    .to_vec();
    let of = |kind, corners: &[usize]| {
        let corners: Vec<[f64; 3]> = corners.iter().map(|&k| cube[k]).collect();
        measure(kind, &corners)
    };
    let near = |found: Option<(f64, [f64; 3])>, volume: f64, middle: [f64; 3]| {
        let (v, x) = found.expect("a volume");
        let off = (0..3).fold((v - volume).abs(), |off, a| {
            off.max((x[a] - middle[a]).abs())
        });
        assert!(off < 1e-14, "{v} {x:?}");
    };
    near(
        of(Kind::Hexahedron, &[0, 1, 2, 3, 4, 5, 6, 7]),
        8.0,
        [1.0; 3],
    );
    // The same seen from the other side.
    near(
        of(Kind::Hexahedron, &[4, 5, 6, 7, 0, 1, 2, 3]),
        8.0,
        [1.0; 3],
    );
    near(
        of(Kind::Wedge, &[0, 1, 3, 4, 5, 7]),
        4.0,
        [2.0 / 3.0, 2.0 / 3.0, 1.0],
    );
    near(of(Kind::Tetrahedron, &[0, 1, 3, 4]), 4.0 / 3.0, [0.5; 3]);
    near(
        of(Kind::Pyramid, &[0, 1, 2, 3, 4]),
        8.0 / 3.0,
        [0.75, 0.75, 0.5],
    );
    near(of(Kind::Quadrilateral, &[0, 1, 2, 3]), 4.0, [1.0, 1.0, 0.0]);
    near(
        of(Kind::Triangle, &[0, 1, 2]),
        2.0,
        [4.0 / 3.0, 2.0 / 3.0, 0.0],
    );
    // LS-DYNA's wedge, whose upper corners are there twice.
    near(
        of(Kind::Hexahedron, &[0, 1, 2, 3, 4, 4, 7, 7]),
        4.0,
        [2.0 / 3.0, 1.0, 2.0 / 3.0],
    );
    assert!(of(Kind::Tetrahedron, &[0, 1, 2, 3]).is_none());
    assert!(of(Kind::Hexahedron, &[0; 8]).is_none());
}
