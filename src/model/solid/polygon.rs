//! Polygons in a plane: the outlines of prisms and of solids of revolution.

/// A closed polygon, its corners counter-clockwise.
#[derive(Debug, Clone, PartialEq)]
pub struct Polygon {
    corners: Vec<[f64; 2]>,
}

/// A nearest place of an edge: its distance (m) and the unit vector from the point to it.
pub(super) struct Nearest {
    pub distance: f64,
    pub way: [f64; 2],
}

impl Polygon {
    /// Of corners (m) in either order; `None` if they enclose no area or edges cross.
    #[must_use]
    pub fn new(mut corners: Vec<[f64; 2]>) -> Option<Self> {
        corners.dedup();
        if corners.len() > 1 && corners.first() == corners.last() {
            corners.pop();
        }
        let mut profile = Self { corners };
        let area = profile.area();
        if !area.is_finite() || area == 0.0 || profile.crosses() {
            return None;
        }
        if area < 0.0 {
            profile.corners.reverse();
        }
        Some(profile)
    }

    /// The corners (m).
    #[must_use]
    pub fn corners(&self) -> &[[f64; 2]] {
        &self.corners
    }

    fn edges(&self) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
        let next = self.corners.iter().cycle().skip(1);
        self.corners.iter().zip(next).map(|(a, b)| [*a, *b])
    }

    /// `true` if two edges that are no neighbours meet.
    fn crosses(&self) -> bool {
        let edges: Vec<_> = self.edges().collect();
        let n = edges.len();
        let side = |[a, b]: [[f64; 2]; 2], p: [f64; 2]| {
            (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0])
        };
        let cross = |e: [[f64; 2]; 2], f: [[f64; 2]; 2]| {
            side(e, f[0]) * side(e, f[1]) <= 0.0 && side(f, e[0]) * side(f, e[1]) <= 0.0
        };
        (0..n).any(|i| (i + 2..n).any(|j| (i != 0 || j != n - 1) && cross(edges[i], edges[j])))
    }

    /// Area (m²), positive once the corners are counter-clockwise.
    #[must_use]
    pub fn area(&self) -> f64 {
        0.5 * self
            .edges()
            .map(|[a, b]| a[0] * b[1] - b[0] * a[1])
            .sum::<f64>()
    }

    /// Volume (m³) of the solid that the polygon sweeps as it turns about the second axis: by
    /// Pappus, 2π times its first moment.
    #[must_use]
    pub fn swept_volume(&self) -> f64 {
        let moment = self
            .edges()
            .map(|[a, b]| (a[0] * b[1] - b[0] * a[1]) * (a[0] + b[0]));
        std::f64::consts::TAU * moment.sum::<f64>() / 6.0
    }

    /// Smallest and largest coordinates (m).
    #[must_use]
    pub fn bounds(&self) -> ([f64; 2], [f64; 2]) {
        let mut ends = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        for corner in &self.corners {
            for a in 0..2 {
                ends.0[a] = ends.0[a].min(corner[a]);
                ends.1[a] = ends.1[a].max(corner[a]);
            }
        }
        ends
    }

    /// Distance (m) of a point from the outline, negative inside. Edges that `counts` refuses are
    /// no outline.
    pub(super) fn distance(&self, p: [f64; 2], counts: impl Fn(&[[f64; 2]; 2]) -> bool) -> f64 {
        let mut nearest = f64::INFINITY;
        let mut is_inside = false;
        for edge in self.edges() {
            let [a, b] = edge;
            // A ray to larger first coordinates crosses the edge.
            if (a[1] > p[1]) != (b[1] > p[1]) {
                let at = a[0] + (p[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                is_inside ^= p[0] < at;
            }
            if counts(&edge) {
                let way = to_edge(p, edge);
                nearest = nearest.min(way[0] * way[0] + way[1] * way[1]);
            }
        }
        let distance = nearest.sqrt();
        if is_inside { -distance } else { distance }
    }

    /// Tells the edges that a point inside faces within `reach` (m).
    pub(super) fn near_edges(
        &self,
        p: [f64; 2],
        reach: f64,
        counts: impl Fn(&[[f64; 2]; 2]) -> bool,
        mut emit: impl FnMut(Nearest),
    ) {
        let mut last: Option<[f64; 2]> = None;
        let mut first: Option<[f64; 2]> = None;
        for edge in self.edges().filter(counts) {
            let way = to_edge(p, edge);
            let distance = libm::hypot(way[0], way[1]);
            // A corner that is nearest to both its edges is one face, not two.
            let is_known = [last, first].into_iter().flatten().any(|w| w == way);
            last = Some(way);
            first = first.or(Some(way));
            if distance < reach && distance > 0.0 && !is_known {
                let way = way.map(|c| c / distance);
                emit(Nearest { distance, way });
            }
        }
    }
}

/// The way (m) from a point to the nearest one of an edge.
fn to_edge(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> [f64; 2] {
    let along = [b[0] - a[0], b[1] - a[1]];
    let to = [p[0] - a[0], p[1] - a[1]];
    let squared = along[0] * along[0] + along[1] * along[1];
    let t = ((to[0] * along[0] + to[1] * along[1]) / squared).clamp(0.0, 1.0);
    // The end itself, so that two edges give the same to the bit.
    let at = if t == 0.0 {
        a
    } else if t == 1.0 {
        b
    } else {
        [a[0] + t * along[0], a[1] + t * along[1]]
    };
    [at[0] - p[0], at[1] - p[1]]
}
