//! Initial values of the particles of bodies: constants or formulas of the place.

use std::f64::consts::FRAC_PI_2;
use std::ops::Range;

use toml::Spanned;

use super::check::components;
use super::loading;
use crate::input::formula;
use crate::input::profile::ProfileParams;
use crate::input::quantity::{Kind, Velocity, demand};
use crate::input::schema::{AngularVelocityParams, BodyParams};
use crate::input::source::Diagnostic;
use model::{Body, Case, Heat, Initial, Place, Profile, Vec3};
use populate;

/// Bodies with more particles are looked at on a wider lattice; each particle is as the run begins.
pub const MOST_PLACES: u64 = 100_000;

/// A velocity as it is typed.
pub type VelocityParams = Spanned<Vec<Spanned<ProfileParams<Velocity>>>>;

/// The initial velocity (m/s) if it is the same everywhere, else its components.
pub fn velocity(
    params: Option<&VelocityParams>,
    dimension: usize,
) -> Result<(Vec3, Option<[Profile; 3]>), Diagnostic> {
    let mut profiles: [Profile; 3] = Default::default();
    if let Some(params) = params {
        components("velocity", params, dimension)?;
        for (axis, given) in params.get_ref().iter().enumerate() {
            profiles[axis] = profile(given, dimension)?;
        }
    }
    let constant = profiles.each_ref().map(Profile::constant);
    match constant {
        [Some(x), Some(y), Some(z)] => Ok((Vec3::new(x, y, z), None)),
        _ => Ok((Vec3::zeros(), Some(profiles))),
    }
}

/// The velocity (m/s) of a `speed` at an obliquity, if there is one.
pub fn oblique(params: &BodyParams, dimension: usize) -> Result<Option<Vec3>, Diagnostic> {
    let refuse = |at: Range<usize>, title: &str| Err(Diagnostic::new(at, title));
    let angle = params.angle()?;
    let Some(given) = &params.speed else {
        return match &params.angle {
            Some(given) if angle != 0.0 => refuse(
                given.span(),
                "`angle` is that of a `speed`, which the body does not have",
            ),
            _ => Ok(None),
        };
    };
    let speed = params.speed()?.unwrap_or(0.0);
    if params.velocity.is_some() {
        return refuse(
            given.span(),
            "a body has a `velocity` or a `speed`, not both",
        );
    }
    if let Some(given) = &params.angle {
        if dimension == 1 {
            return refuse(given.span(), "in one dimension a `speed` has no `angle`");
        }
        if angle.abs() >= FRAC_PI_2 {
            let title = "`angle`, which counts from the normal, must be less than 90 deg";
            return refuse(given.span(), title);
        }
    }
    let mut velocity = Vec3::zeros();
    velocity.x = speed * libm::sin(angle);
    velocity[dimension - 1] = 0.0 - speed * libm::cos(angle);
    Ok(Some(velocity))
}

/// Initial values beside the velocity, whose components these are where they vary.
pub fn initial(
    params: &BodyParams,
    velocity: Option<[Profile; 3]>,
    dimension: usize,
) -> Result<Initial, Diagnostic> {
    let heat = match (&params.specific_energy, &params.temperature) {
        (None, None) => Heat::Reference,
        (Some(energy), None) => Heat::Energy(profile(energy, dimension)?),
        (None, Some(temperature)) => Heat::Temperature(profile(temperature, dimension)?),
        (Some(_), Some(temperature)) => {
            let title = "a body begins with a `temperature` or a `specific_energy`, not both";
            return Err(Diagnostic::new(temperature.span(), title));
        }
    };
    let strain = params.plastic_strain.as_ref();
    let strain = strain
        .map(|strain| profile(strain, dimension))
        .transpose()?;
    if params.rigid == Some(true) {
        let strain = params
            .plastic_strain
            .as_ref()
            .map(|s| (s.span(), "plastic_strain"));
        let temperature = params.temperature.as_ref();
        let temperature = temperature.map(|t| (t.span(), "temperature"));
        if let Some((span, key)) = temperature.or(strain) {
            let title = format!("nothing heats or deforms a rigid body: it has no `{key}`");
            return Err(Diagnostic::new(span, title));
        }
    }
    Ok(Initial {
        velocity,
        heat,
        plastic_strain: strain.unwrap_or_default(),
        loading: loading::stated(params, dimension)?,
        ..Initial::default()
    })
}

/// The profile of a key, of the kind that it wants.
pub fn profile<K: Kind>(
    given: &Spanned<ProfileParams<K>>,
    dimension: usize,
) -> Result<Profile, Diagnostic> {
    let (text, span) = (given.get_ref().text.as_str(), given.span());
    let (profile, powers) =
        formula::read(text, dimension).map_err(|inner| within(inner, &span, text))?;
    let value = profile.constant().unwrap_or(1.0);
    demand::<K>(text, value, powers).map_err(|title| Diagnostic::new(span, title))?;
    Ok(profile)
}

/// A diagnostic of a text as one of the value that holds it: at its place between the quotes, if no
/// escapes shift that.
fn within(mut inner: Diagnostic, span: &Range<usize>, text: &str) -> Diagnostic {
    let begin = span.start + 1;
    inner.span = if span.len() == text.len() + 2 {
        begin + inner.span.start..begin + inner.span.end
    } else {
        span.clone()
    };
    inner
}

/// Finds where bodies in their final places turn and how far what varies goes, and refuses what
/// nature or the material does not know.
pub fn resolve(case: &mut Case, params: &[Spanned<BodyParams>]) -> Result<(), Diagnostic> {
    for (b, table) in params.iter().enumerate() {
        let params = table.get_ref();
        fits_material(case, &case.bodies[b], params)?;
        turn_about(&mut case.bodies[b], params, case.dimension)?;
        survey(case, b, table)?;
    }
    Ok(())
}

/// The material has a temperature, or plastic strain, if one is given.
fn fits_material(case: &Case, body: &Body, params: &BodyParams) -> Result<(), Diagnostic> {
    let material = &case.materials[body.material];
    if let Some(temperature) = &params.temperature
        && material.thermal.is_none()
    {
        let title = format!(
            "the material `{}` has no `thermal` constants that would make an energy of a temperature",
            material.name
        );
        return Err(Diagnostic::new(temperature.span(), title)
            .help("give it `thermal.specific_heat`, or the body a `specific_energy`"));
    }
    if let Some(strain) = &params.plastic_strain
        && !material.strength.state().contains(&"plastic_strain")
    {
        let title = format!(
            "the strength of `{}` knows no plastic strain",
            material.name
        );
        return Err(Diagnostic::new(strain.span(), title));
    }
    Ok(())
}

/// A turn about any point is one about the centre, which then has a velocity by it.
fn turn_about(body: &mut Body, params: &BodyParams, dimension: usize) -> Result<(), Diagnostic> {
    let turn = params.angular_velocity.as_ref().map(Spanned::get_ref);
    let point = match (body.freedom.pivot, turn) {
        (Some(pivot), _) => pivot,
        (None, Some(AngularVelocityParams::About(table))) => {
            components("about", &table.about, dimension)?;
            let mut point = Vec3::zeros();
            for (axis, given) in table.about.get_ref().iter().enumerate() {
                point[axis] = given.get_ref().metres(body.lattice.spacing);
            }
            point
        }
        _ => return Ok(()),
    };
    let arm = Vec3::from_fn(|axis, _| {
        if axis < dimension {
            body.shape.centre()[axis] - point[axis]
        } else {
            0.0
        }
    });
    let moved = body.angular_velocity.cross(&arm);
    match body.initial.velocity.take() {
        None => body.velocity += moved,
        Some(components) => {
            let mut axes = 0..3;
            body.initial.velocity =
                Some(components.map(|c| c.plus(moved[axes.next().unwrap_or(0)])));
        }
    }
    Ok(())
}

/// True if what a body begins with is in range at its particles, and how far it goes.
fn survey(case: &mut Case, b: usize, table: &Spanned<BodyParams>) -> Result<(), Diagnostic> {
    let body = &case.bodies[b];
    let refuse = |position: &Vec3| {
        let (key, title) = case.unsound(body, position)?;
        Some(Diagnostic::new(key_span(table, key), title))
    };
    if !body.initial.varies() {
        // What turns is looked at particle by particle as the run begins.
        let centre = body.shape.centre();
        if let Some(diagnostic) = refuse(&centre) {
            return Err(diagnostic);
        }
        let even = case.stressed(
            body,
            &centre,
            body.initial.plastic_strain.constant().unwrap_or(0.0),
        );
        if let Some(Ok(even)) = even {
            let body = &mut case.bodies[b];
            (body.initial.even, body.density) = (Some(even), Some(even.density));
        }
        return Ok(());
    }
    let (places, all) = populate::sample(body, case.dimension, &case.symmetry, MOST_PLACES);
    let mut ends = [[f64::INFINITY, f64::NEG_INFINITY]; 3];
    let mut largest = 0.0_f64;
    let (mut densities, mut found_places) = (0.0, 0.0);
    for site in places {
        let position = Vec3::from(site.position);
        match refuse(&position) {
            Some(diagnostic) if all => return Err(diagnostic),
            // A wide lattice has places where no particle is.
            Some(_) => continue,
            None => {}
        }
        let found = case.beginning(body, &position);
        if found.specific_energy.abs() > largest.abs() {
            largest = found.specific_energy;
        }
        densities += found.density;
        found_places += 1.0;
        if let Some(components) = &body.initial.velocity {
            let place = Place::new(&position, &body.shape.centre());
            for (ends, component) in ends.iter_mut().zip(components) {
                let v = component.at(&place);
                *ends = [ends[0].min(v), ends[1].max(v)];
            }
        }
    }
    let body = &mut case.bodies[b];
    body.initial.largest_energy = largest;
    if body.initial.loading.is_some() && found_places > 0.0 {
        body.density = Some(densities / found_places);
    }
    if body.initial.velocity.is_some() && ends[0][0].is_finite() {
        let half = |sign: f64| Vec3::from(ends.map(|[low, high]| 0.5 * (high + sign * low)));
        body.velocity = half(1.0);
        body.initial.velocity_spread = half(-1.0).norm();
    }
    Ok(())
}

/// Place of a key of a body, or of its name.
pub fn key_span(table: &Spanned<BodyParams>, key: &str) -> Range<usize> {
    let params = table.get_ref();
    let span = match key {
        "velocity" => {
            let speed = params.speed.as_ref().map(Spanned::span);
            params.velocity.as_ref().map(Spanned::span).or(speed)
        }
        "temperature" => params.temperature.as_ref().map(Spanned::span),
        "specific_energy" => params.specific_energy.as_ref().map(Spanned::span),
        "pressure" => params.pressure.as_ref().map(Spanned::span),
        "stress" => params.stress.as_ref().map(Spanned::span),
        "overburden" => params.overburden.as_ref().map(Spanned::span),
        _ => params.plastic_strain.as_ref().map(Spanned::span),
    };
    let turn = params.angular_velocity.as_ref().map(Spanned::span);
    span.or(turn).unwrap_or_else(|| params.name.span())
}
