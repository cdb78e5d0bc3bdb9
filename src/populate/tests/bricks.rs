//! Parts of bodies between faces along several axes.

use super::*;

/// Bricks between faces along two or three axes give each site once with the same bits, whatever the
/// filling, and a count gives as many.
#[test]
fn bricks_add_up_to_the_whole() {
    let kinds = [
        LatticeKind::Cubic,
        LatticeKind::Hexagonal,
        LatticeKind::Rings,
        LatticeKind::Shells,
        LatticeKind::Glass,
    ];
    let plane = &planes()[..1];
    for kind in kinds {
        let body = body(
            ball(1.0),
            kind,
            0.11,
            if matches!(kind, LatticeKind::Cubic | LatticeKind::Hexagonal) {
                0.3
            } else {
                0.0
            },
        );
        let mut whole = bits(sites(&body, 3, plane, None));
        whole.sort_unstable();
        let on_site = f64::from_bits(whole[77].1[1]);
        let mut faces = [f64::NEG_INFINITY, -0.3, on_site, 0.4, f64::INFINITY];
        faces.sort_by(f64::total_cmp);
        let mut union = Vec::new();
        for x in faces.windows(2) {
            for y in faces.windows(2) {
                for z in [[f64::NEG_INFINITY, 0.1], [0.1, f64::INFINITY]] {
                    let brick = Brick {
                        lower: [x[0], y[0], z[0]],
                        upper: [x[1], y[1], z[1]],
                    };
                    let part = bits(sites(&body, 3, plane, Some(brick)));
                    assert_eq!(part.len() as u64, count(&body, 3, plane, Some(brick)));
                    union.extend(part);
                }
            }
        }
        union.sort_unstable();
        assert_eq!(union, whole, "{kind:?}");
    }
}
