//! Axial symmetry: two dimensions are the distance from an axis and the place along it, and particles are rings.

use super::{Axis, Case, Placement, Polygon, Primitive, Shape, Solid, SymmetryPlane, Vec3};

impl Case {
    /// Number of dimensions that matter extends in, and its kernel with it: three for rings about an axis.
    #[must_use]
    pub fn extent(&self) -> usize {
        if self.axisymmetric { 3 } else { self.dimension }
    }

    /// Factor from the mass of a particle in the plane (kg/m) to that of all of it (kg), by its place (m): the
    /// circumference of its ring; one without axial symmetry.
    #[must_use]
    pub fn around(&self, position: &[f64; 3]) -> f64 {
        if self.axisymmetric {
            std::f64::consts::TAU * position[0]
        } else {
            1.0
        }
    }

    /// Where the ring of a site stands (m), for a spacing (m): half way from the middle of its annulus to the centroid
    /// of that, which is `Δp²/12 r` farther out. There a uniform pressure pushes the rings about the axis by some
    /// hundredths of what it does in the middles; elsewhere it makes no difference.
    #[must_use]
    pub fn stands(&self, position: &[f64; 3], spacing: f64) -> [f64; 3] {
        let [x, y, z] = *position;
        if !self.axisymmetric {
            return *position;
        }
        let aside = spacing * spacing / (24.0 * x.max(0.5 * spacing));
        [x + aside, y, z]
    }

    /// The quarter, between the planes of x = 0 and z = 0, of the model in space that an axisymmetric one stands for: with
    /// its measures, and without what fills its bodies.
    #[must_use]
    pub fn revolved(&self) -> Self {
        let mut space = self.clone();
        space.dimension = 3;
        space.axisymmetric = false;
        space.symmetry.push(SymmetryPlane {
            axis: Axis::Z,
            position: 0.0,
        });
        for body in &mut space.bodies {
            body.shape = Shape::Solid(about(&body.shape.solid(2)));
            body.lattice.volume = None;
        }
        space
    }
}

/// The solid that a solid of the plane sweeps as it turns about the y axis.
fn about(flat: &Solid) -> Solid {
    let all = |parts: &[Solid]| parts.iter().map(about).collect();
    match flat {
        Solid::Primitive(primitive, place) => swept(primitive, place).unwrap_or_else(|| {
            // What lies beside the axis sweeps its own box at most.
            let (lower, upper) = flat.bounds();
            turned(vec![
                [lower.x, lower.y],
                [upper.x, lower.y],
                [upper.x, upper.y],
                [lower.x, upper.y],
            ])
            .unwrap_or_else(|| flat.clone())
        }),
        Solid::Union(parts) => Solid::Union(all(parts)),
        Solid::Intersection(parts) => Solid::Intersection(all(parts)),
        Solid::Difference(base, cuts) => Solid::Difference(Box::new(about(base)), all(cuts)),
        Solid::Repeat(..) => flat.clone(),
    }
}

/// That of a form in its place, if it is one that has a name.
fn swept(primitive: &Primitive, place: &Placement) -> Option<Solid> {
    let in_plane = |corner: [f64; 2]| {
        let p = place.at + place.turn * Vec3::new(corner[0], corner[1], 0.0);
        [p.x, p.y]
    };
    match primitive {
        Primitive::Ball(radius) if place.at.x == 0.0 => {
            Some(Solid::Primitive(Primitive::Ball(*radius), place.clone()))
        }
        Primitive::Ball(tube) => {
            let ring = Primitive::Torus {
                radius: place.at.x,
                tube: *tube,
            };
            let at = Vec3::new(0.0, place.at.y, 0.0);
            Some(Solid::Primitive(
                ring,
                Placement::turned(Shape::onto(Axis::Y), at),
            ))
        }
        Primitive::Box(half) => {
            let corner = |x: f64, y: f64| in_plane([x * half.x, y * half.y]);
            turned(vec![
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ])
        }
        Primitive::Prism { section, .. } => turned(
            section
                .corners()
                .iter()
                .map(|&corner| in_plane(corner))
                .collect(),
        ),
        Primitive::Ellipsoid(semi) if place.at.x == 0.0 => {
            // Its axes are those of the plane, or no turn about y sweeps an ellipsoid.
            let along = (0..2).find(|&a| place.turn[(1, a)].abs() == 1.0)?;
            let [across, along] = [semi[1 - along], semi[along]];
            let semi = Vec3::new(across, along, across);
            Some(Solid::Primitive(
                Primitive::Ellipsoid(semi),
                Placement::at(place.at),
            ))
        }
        _ => None,
    }
}

/// The solid of revolution about y of a polygon of (x, y) (m); what of it is beyond the axis goes on to it.
fn turned(corners: Vec<[f64; 2]>) -> Option<Solid> {
    // About z the radius comes first, and y is its axis.
    let profile = Polygon::new(corners.into_iter().map(|[x, y]| [x.max(0.0), y]).collect())?;
    let place = Placement::turned(Shape::onto(Axis::Y), Vec3::zeros());
    Some(Solid::Primitive(Primitive::Revolved(profile), place))
}
