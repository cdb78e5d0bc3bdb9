//! Slabs and whole bodies, counted and tallied.

use super::*;

#[test]
fn slabs_hold_what_the_whole_holds_to_the_bit() {
    let mut body = body(ball(20.0), LatticeKind::Glass, 1.0);
    slabs_add_up(&body);
    body.lattice.grade(Some(Grading {
        from: Focus::Point(Vec3::new(3.0, 12.0, 0.0)),
        even: 3.0,
        growth: 0.15,
        coarsest: 3.0,
    }));
    slabs_add_up(&body);
}

fn slabs_add_up(body: &Body) {
    let whole: Vec<Site> = crate::sites(body, 3, &[], None).collect();
    assert_eq!(whole.len() as u64, crate::count(body, 3, &[], None));
    let mut pieces: Vec<Site> = Vec::new();
    let faces = [f64::NEG_INFINITY, -14.0, -12.0, -4.0, 1.5, f64::INFINITY];
    for pair in faces.windows(2) {
        let (lower, upper) = (pair[0], pair[1]);
        let slab = Some(crate::Brick::slab(0, lower, upper));
        let before = pieces.len();
        pieces.extend(crate::sites(body, 3, &[], slab));
        let count = (pieces.len() - before) as u64;
        assert_eq!(count, crate::count(body, 3, &[], slab));
    }
    pieces.sort_by_key(|site| site.index);
    assert!(pieces == whole);
}

/// Whole tiles are counted together: as many sites at the same coordinates as a walk finds, and the
/// same bounds.
#[test]
fn large_bodies_are_told_by_tiles() {
    let share = |part| crate::Share { part, parts: 3 };
    for kind in [LatticeKind::Glass, LatticeKind::FaceCentred] {
        let body = body(ball(40.0), kind, 1.0);
        let cells = Cells::of(&body, 3, &[]).unwrap();
        for axis in 0..3 {
            let mut walked: Vec<f64> = cells
                .all_blocks(&[])
                .flat_map(|block| cells.sites_of(block, &[]))
                .map(|site| site.position[axis])
                .collect();
            let mut tallied = Vec::new();
            for part in 0..3 {
                crate::tally(&body, 3, &[], axis, share(part), |x, n| {
                    tallied.extend(std::iter::repeat_n(x, n as usize));
                });
            }
            assert_eq!(tallied.len() as u64, cells.count(&[]));
            walked.sort_by(f64::total_cmp);
            tallied.sort_by(f64::total_cmp);
            assert_eq!(tallied.len(), walked.len());
            let near = |(a, b): (&f64, &f64)| (a - b).abs() < 1e-12;
            assert!(tallied.iter().zip(&walked).all(near));
        }
    }
    let body = body(ball(12.0), LatticeKind::Glass, 1.0);
    let (lower, upper) = crate::bounds(&body, 3).unwrap();
    let centre = [0.3, -0.2, 0.1];
    for a in 0..3 {
        assert!((lower[a] - centre[a] + 11.5).abs() < 0.1, "{lower:?}");
        assert!((upper[a] - centre[a] - 11.5).abs() < 0.1, "{upper:?}");
    }
    let visits = crate::visits::of(|| {
        let edges = Shape::Box {
            lower: Vec3::zeros(),
            upper: Vec3::repeat(400.0),
        };
        let body = self::body(edges, LatticeKind::Glass, 1.0);
        let (lower, upper) = crate::bounds(&body, 3).unwrap();
        for a in 0..3 {
            assert!((lower[a] - 0.5).abs() < 1e-8 && (upper[a] - 399.5).abs() < 1e-8);
        }
    });
    assert!(visits < 20_000, "{visits}");
}
