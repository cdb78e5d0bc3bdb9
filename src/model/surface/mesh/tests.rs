//! Nearest places, sides, and what is no closed surface.

use super::*;

/// Four corners in order about the outward normal, as two triangles.
fn quad(q: [[f64; 3]; 4]) -> [[[f64; 3]; 3]; 2] {
    [[q[0], q[1], q[2]], [q[0], q[2], q[3]]]
}

/// The solid over an outline in x and y (counter-clockwise), from z = −1 to 1, and its ends as
/// triangles of the outline's corners.
fn prism(outline: &[[f64; 2]], ends: &[[usize; 3]]) -> Vec<[[f64; 3]; 3]> {
    let at = |k: usize, z: f64| [outline[k][0], outline[k][1], z];
    let n = outline.len();
    let mut soup: Vec<_> = (0..n)
        .flat_map(|k| {
            let l = (k + 1) % n;
            quad([at(k, -1.0), at(l, -1.0), at(l, 1.0), at(k, 1.0)])
        })
        .collect();
    for &[a, b, c] in ends {
        soup.push([at(a, 1.0), at(b, 1.0), at(c, 1.0)]);
        soup.push([at(a, -1.0), at(c, -1.0), at(b, -1.0)]);
    }
    soup
}

fn cube() -> Vec<[[f64; 3]; 3]> {
    let outline = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
    prism(&outline, &[[0, 1, 2], [0, 2, 3]])
}

/// An L with its inner corner at the origin, open towards +x and +y.
fn angle_iron() -> Vec<[[f64; 3]; 3]> {
    let outline = [
        [-1.0, -1.0],
        [2.0, -1.0],
        [2.0, 0.0],
        [0.0, 0.0],
        [0.0, 2.0],
        [-1.0, 2.0],
    ];
    prism(&outline, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]])
}

fn near(foot: Option<Foot>, normal: [f64; 3], gap: f64) {
    crate::surface::tests::near(foot.expect("a foot"), normal, gap);
}

#[test]
fn faces_edges_and_corners_of_a_cube() {
    let mesh = Mesh::new(&cube()).unwrap();
    assert!(mesh.is_convex());
    assert_eq!(mesh.triangles.len(), 12);
    let far = f64::INFINITY;
    near(mesh.foot(&[1.5, 0.2, 0.1], far), [1.0, 0.0, 0.0], 0.5);
    near(mesh.foot(&[0.9, 0.2, 0.1], far), [1.0, 0.0, 0.0], -0.1);
    // The diagonal of two triangles is no edge to be seen.
    near(mesh.foot(&[0.3, 0.3, 1.25], far), [0.0, 0.0, 1.0], 0.25);
    near(mesh.foot(&[1.3, 1.4, 0.1], far), [0.6, 0.8, 0.0], 0.5);
    near(
        mesh.foot(&[-1.0 - 2.0 / 3.0, -1.0 - 2.0 / 3.0, -1.0 - 1.0 / 3.0], far),
        [-2.0 / 3.0, -2.0 / 3.0, -1.0 / 3.0],
        1.0,
    );
    assert!(mesh.foot(&[1.5, 0.0, 0.0], 0.49).is_none());
    // On an edge and on a corner the way out is between the faces.
    let half = 0.5_f64.sqrt();
    near(mesh.foot(&[1.0, 1.0, 0.3], far), [half, half, 0.0], 0.0);
    let third = (1.0_f64 / 3.0).sqrt();
    near(mesh.foot(&[1.0; 3], far), [third; 3], 0.0);
}

#[test]
fn a_valley_has_an_inside_beneath_its_edge() {
    let mesh = Mesh::new(&angle_iron()).unwrap();
    assert!(!mesh.is_convex());
    let far = f64::INFINITY;
    near(mesh.foot(&[0.3, 0.1, 0.0], far), [0.0, 1.0, 0.0], 0.1);
    near(mesh.foot(&[0.1, 0.3, 0.0], far), [1.0, 0.0, 0.0], 0.1);
    // Behind the valley the nearest place is its edge.
    near(mesh.foot(&[-0.3, -0.4, 0.0], far), [0.6, 0.8, 0.0], -0.5);
}

/// Against all triangles one by one.
#[test]
fn the_tree_finds_the_closest() {
    let mesh = Mesh::new(&angle_iron()).unwrap();
    for n in 0..4000 {
        let n = f64::from(n);
        let x = [0.7, 1.3, 2.1].map(|f| 3.0 * libm::sin(f * n + f));
        let square = mesh
            .triangles
            .iter()
            .map(|t| {
                let corners = t.map(|c| mesh.corners[c as usize]);
                let r = minus(&x, &closest_on_triangle(&corners, &x).0);
                dot(&r, &r)
            })
            .fold(f64::INFINITY, f64::min);
        let foot = mesh.foot(&x, f64::INFINITY).expect("a foot");
        assert!((foot.gap.abs() - square.sqrt()).abs() < 1e-12);
        let [a, b, c] = x;
        let solid = |low: [f64; 3], high: [f64; 3]| {
            (0..3).all(|k| low[k] < [a, b, c][k] && [a, b, c][k] < high[k])
        };
        let inside = solid([-1.0; 3], [2.0, 0.0, 1.0]) || solid([-1.0; 3], [0.0, 2.0, 1.0]);
        assert_eq!(foot.gap < 0.0, inside, "{x:?}");
    }
}

#[test]
fn what_is_no_closed_surface_is_refused() {
    let mut soup = cube();
    let mut turned = soup.clone();
    for t in &mut turned {
        t.swap(0, 1);
    }
    let mesh = Mesh::new(&turned).unwrap();
    near(mesh.foot(&[1.5, 0.2, 0.1], 1.0), [1.0, 0.0, 0.0], 0.5);
    // A needle without width changes nothing.
    soup.push([[1.0; 3], [1.0; 3], [0.0; 3]]);
    assert_eq!(Mesh::new(&soup).unwrap().triangles.len(), 12);
    soup.truncate(11);
    let open = Mesh::new(&soup).unwrap_err();
    assert!(
        open.to_string().contains("3 edges have no second triangle"),
        "{open}"
    );
    let mut soup = cube();
    soup[0].swap(0, 1);
    assert!(Mesh::new(&soup).is_err());
    let line = [[[0.0; 3], [1.0; 3], [2.0; 3]]];
    assert!(matches!(
        Mesh::new(&line),
        Err(MeshError::Flat { triangle: 1, .. })
    ));
    assert_eq!(Mesh::new(&[]), Err(MeshError::Empty));
    let mut twice = cube();
    twice.extend(cube());
    assert!(matches!(Mesh::new(&twice), Err(MeshError::Tangled { .. })));
}
