//! Stresses that bodies begin under: stated ones, and those of the weight above.

use std::ops::Range;

use toml::Spanned;

use super::initial::profile;
use crate::input::schema::{BodyParams, OverburdenParams};
use crate::input::source::Diagnostic;
use model::{Axis, Body, Case, Column, ColumnOf, Loading, Place, Profile};

/// The stress that the text states for a body.
pub fn stated(params: &BodyParams, dimension: usize) -> Result<Option<Loading>, Diagnostic> {
    let Some((key, span)) = key(params)? else {
        return Ok(None);
    };
    let refuse = |title: String| Err(Diagnostic::new(span.clone(), title));
    if params.rigid == Some(true) {
        return refuse(format!("a rigid body bears no stress: it has no `{key}`"));
    }
    if params.particles.is_some() {
        return refuse(format!(
            "particles of a file have densities of their own: their body has no `{key}`"
        ));
    }
    if let Some(density) = &params.density {
        let title = format!("`{key}` sets the density, which `density` sets as well");
        return Err(Diagnostic::new(density.span(), title)
            .help("leave `density` out; a `temperature` sets the energy at that pressure"));
    }
    if let Some(pressure) = &params.pressure {
        return Ok(Some(Loading::Pressure(profile(pressure, dimension)?)));
    }
    let Some(stress) = &params.stress else {
        // What lies above is not known yet.
        return Ok(None);
    };
    let table = stress.get_ref();
    let all = [
        (&table.xx, 1),
        (&table.yy, 1),
        (&table.zz, 1),
        (&table.xy, 2),
        (&table.xz, 3),
        (&table.yz, 3),
    ];
    let mut components: [Profile; 6] = Default::default();
    for (component, (given, least)) in components.iter_mut().zip(all) {
        let Some(given) = given else { continue };
        if dimension < least {
            let title = format!("in {dimension} dimensions nothing bears this shear");
            return Err(Diagnostic::new(given.span(), title));
        }
        *component = profile(given, dimension)?;
    }
    Ok(Some(Loading::Stress(Box::new(components))))
}

/// The one key of a body that states a stress, and its place.
fn key(params: &BodyParams) -> Result<Option<(&'static str, Range<usize>)>, Diagnostic> {
    let overburden = params.overburden.as_ref();
    let overburden = overburden.filter(|o| !matches!(o.get_ref(), OverburdenParams::Is(false)));
    let all = [
        params.pressure.as_ref().map(|p| ("pressure", p.span())),
        params.stress.as_ref().map(|s| ("stress", s.span())),
        overburden.map(|o| ("overburden", o.span())),
    ];
    let mut given = all.into_iter().flatten();
    let first = given.next();
    if let (Some((one, _)), Some((other, span))) = (&first, given.next()) {
        let title = format!("a body has a `{one}` or a `{other}`, not both");
        return Err(Diagnostic::new(span, title));
    }
    Ok(first)
}

/// Checks stated stresses against the planes of symmetry, and finds those of the weight above.
pub fn resolve(case: &mut Case, params: &[Spanned<BodyParams>]) -> Result<(), Diagnostic> {
    for (body, table) in case.bodies.iter().zip(params) {
        if let Some(Loading::Stress(components)) = &body.initial.loading {
            across_planes(case, components, table.get_ref())?;
        }
    }
    let mut weighed: Vec<Weighed> = Vec::new();
    for (b, table) in params.iter().enumerate() {
        let params = table.get_ref();
        let Some(("overburden", span)) = key(params)? else {
            continue;
        };
        weighed.push(Weighed::new(case, b, params, span)?);
    }
    // From above, so that what lies on a body is known before.
    weighed.sort_by(|a, b| a.height().total_cmp(&b.height()).reverse());
    for n in 0..weighed.len() {
        let (before, rest) = weighed.split_at(n);
        let this = &rest[0];
        let above = before.iter().filter_map(|other| other.on(this, case));
        let above = above.fold(0.0, f64::max);
        let column = this.column(case, above)?;
        case.bodies[this.body].initial.loading = Some(Loading::Overburden(column));
    }
    Ok(())
}

/// Shear across a plane of symmetry is not its own mirror image.
fn across_planes(
    case: &Case,
    components: &[Profile; 6],
    params: &BodyParams,
) -> Result<(), Diagnostic> {
    let axes = [[0, 1], [0, 2], [1, 2]];
    let table = params.stress.as_ref().map(Spanned::get_ref);
    for (n, pair) in axes.into_iter().enumerate() {
        let mut planes = case.symmetry.iter();
        let Some(plane) = planes.find(|plane| pair.contains(&plane.axis.index())) else {
            continue;
        };
        if components[3 + n].constant() == Some(0.0) {
            continue;
        }
        let given = table.and_then(|table| [&table.xy, &table.xz, &table.yz][n].as_ref());
        let title = format!(
            "shear across the symmetry plane of {} is not its own mirror image",
            plane.axis.name()
        );
        return Err(Diagnostic::new(given.map_or(0..0, Spanned::span), title));
    }
    Ok(())
}

/// A body that begins under the weight above it.
struct Weighed {
    body: usize,
    span: Range<usize>,
    axis: Axis,
    /// 1 or −1: the sense of the axis in which things fall.
    down: f64,
    /// Acceleration of gravity (m/s²).
    gravity: f64,
    lateral: f64,
    /// Smallest and largest coordinates (m).
    bounds: [[f64; 3]; 2],
}

impl Weighed {
    fn new(
        case: &Case,
        body: usize,
        params: &BodyParams,
        span: Range<usize>,
    ) -> Result<Self, Diagnostic> {
        let gravity = case.loads.gravity;
        let mut along = Axis::ALL.into_iter().filter(|a| gravity[a.index()] != 0.0);
        let (Some(axis), None) = (along.next(), along.next()) else {
            let title =
                "`overburden` is a weight along one axis, and `gravity` has no such direction";
            return Err(Diagnostic::new(span, title)
                .help("give the case a `gravity` along an axis, as in `gravity = [0, 0, \"-9.81 m/s^2\"]`"));
        };
        let lateral = match params.overburden.as_ref().map(Spanned::get_ref) {
            Some(OverburdenParams::Of(table)) => table.lateral()?,
            _ => 1.0,
        };
        let (lower, upper) = case.bodies[body].shape.solid(case.dimension).bounds();
        Ok(Self {
            body,
            span,
            axis,
            down: gravity[axis.index()].signum(),
            gravity: gravity[axis.index()].abs(),
            lateral,
            bounds: [lower.into(), upper.into()],
        })
    }

    /// Where the axis enters and leaves the body (m).
    fn ends(&self) -> [f64; 2] {
        let [lower, upper] = self.bounds.map(|x| x[self.axis.index()]);
        if self.down > 0.0 {
            [lower, upper]
        } else {
            [upper, lower]
        }
    }

    /// How high its top is against the fall (m).
    fn height(&self) -> f64 {
        -self.down * self.ends()[0]
    }

    fn depth(&self) -> f64 {
        (self.bounds[1][self.axis.index()] - self.bounds[0][self.axis.index()]).abs()
    }

    /// Vertical stress (Pa) of this body, which has a column, at the top of another one that it lies on.
    fn on(&self, other: &Self, case: &Case) -> Option<f64> {
        let half = 0.5 * case.bodies[other.body].lattice.spacing;
        let higher = self.height() - other.height();
        let beside = (0..case.dimension).any(|a| {
            let [lower, upper] = [self.bounds[0][a], self.bounds[1][a]];
            a != self.axis.index()
                && (upper < other.bounds[0][a] + half || lower > other.bounds[1][a] - half)
        });
        let Some(Loading::Overburden(column)) = &case.bodies[self.body].initial.loading else {
            return None;
        };
        (higher > half && !beside).then(|| column.vertical(higher))
    }

    /// The column of this body under a stress (Pa) from what lies on it.
    fn column(&self, case: &Case, above: f64) -> Result<Column, Diagnostic> {
        let body: &Body = &case.bodies[self.body];
        let material = &case.materials[body.material];
        let (centre, [top, _]) = (body.shape.centre(), self.ends());
        let of = ColumnOf {
            axis: self.axis,
            down: self.down,
            top,
            depth: self.depth(),
            lateral: self.lateral,
            above,
        };
        let weight = |depth: f64, pressure: f64| {
            let mut position = centre;
            position[self.axis.index()] = top + self.down * depth;
            let place = Place::new(&position, &centre);
            let energy = |density: f64| case.loaded_energy_at(body, &place, density);
            let density = material.density_under(pressure, energy)?;
            Some(self.gravity * density)
        };
        Column::new(of, weight).ok_or_else(|| {
            let title = format!(
                "the equation of state of `{}` has no density at a pressure under this weight",
                material.name
            );
            Diagnostic::new(self.span.clone(), title)
        })
    }
}
