//! Typed tables → a [`Case`]: defaults, ranges, references between tables.

#[macro_use]
pub(super) mod check;
mod absorbers;
mod across;
mod areal;
mod axisymmetric;
mod bodies;
mod contact;
mod defaults;
mod detonators;
mod domain;
mod eos;
mod failure;
mod fibres;
mod fragments;
mod freedom;
mod grading;
mod initial;
mod lattice;
mod laws;
mod loading;
mod loads;
mod materials;
mod measure;
mod measures;
mod meshes;
mod motion;
mod named;
mod numerical_limits;
mod output;
mod particles;
mod porosity;
mod pressures;
mod region;
mod relaxation;
mod self_gravity;
mod shapes;
mod solids;
mod strength;
mod stress_points;
mod surfaces;
mod total;
mod touch;

use std::ops::Range;
use std::path::Path;

use super::names;
use super::schema::{
    BodyParams, CaseParams, RunParams, SmoothingName, SphParams, SymmetryParams, TimeStepParams,
};
use super::source::Diagnostic;
use material::{Eos, Material};
use model::readable::Readable;
use model::{
    Axis, Body, Case, DefaultFactors, DomainOptions, MeasureOptions, NumericalLimits,
    OutputOptions, RunControl, SmoothingLength, SphOptions, SymmetryPlane, TimeStepOptions,
};
use populate::{Searches, close_pairs, overlap};
use region::KeepReader;
use toml::Spanned;

/// Overlaps up to this may be those of curved faces on a lattice (spacings).
const MOST_OVERLAP: f64 = 0.5;

/// Builds the case, whose files stand in `folder`; `resolved` is left empty.
pub fn case(params: &CaseParams, folder: &Path) -> Result<Case, Diagnostic> {
    let dimension = dimension(&params.dimension)?;
    let mut symmetry = symmetry(&params.symmetry, dimension)?;
    let axisymmetric = axisymmetric::axisymmetric(params, dimension, &mut symmetry)?;
    let extent = if axisymmetric { 3 } else { dimension };
    let (names, mut materials) = materials::materials(&params.material, extent, folder)?;
    // A material that no body has changes nothing.
    let is_of_body = |material: &&Material| {
        let mut names = params.body.iter().filter_map(|body| body.get_ref().material.as_ref());
        names.any(|name| *name.get_ref() == material.name)
    };
    let (sph, smoothing) = sph(&params.sph, materials.iter().filter(is_of_body))?;
    let mut bodies = bodies::Reader {
        dimension,
        case: params,
        materials: &names,
        known: &materials,
        filling: lattice::default_kind(extent, sph.form),
        smoothing,
        folder,
    }
    .bodies(&params.body, &symmetry)?;
    if bodies.iter().any(|body| body.material == materials.len()) {
        materials.push(bodies::no_material());
    }
    let length_unit = length_unit(params, &bodies);
    let tears = may_tear(&bodies, &materials);
    let (default_contact, contacts, self_contact) =
        contact::contacts(&params.contact, &params.body, sph.form, smoothing, tears)?;
    let loads = loads::Reader {
        dimension,
        bodies: &mut bodies,
        symmetry: &symmetry,
        length_unit: &length_unit,
        folder,
    }
    .all(params)?;
    let time_step = time_step(extent, &params.time_step, &sph, &bodies, &materials)?;
    let boxes = KeepReader::new(dimension, &bodies, &symmetry, &length_unit);
    let (domain, output) = domain_and_output(params, &boxes, &materials)?;
    let mut case = Case {
        title: names::title(params)?,
        length_unit,
        dimension,
        axisymmetric,
        materials,
        bodies,
        contacts,
        default_contact,
        self_contact,
        symmetry,
        loads,
        sph,
        time_step,
        domain,
        numerical_limits: NumericalLimits::default(),
        run: run(params.run.get_ref())?,
        output,
        fragments: fragments::fragments(params.fragments.as_ref())?,
        measure: MeasureOptions::default(),
        resolved: String::new(),
    };
    axisymmetric::fit(&mut case);
    complete(&mut case, params)?;
    Ok(case)
}

/// Reads what asks a case, and checks what does not go together in it.
fn complete(case: &mut Case, params: &CaseParams) -> Result<(), Diagnostic> {
    areal::resolve(case, &params.body)?;
    loading::resolve(case, &params.body)?;
    case.loads.self_gravity = self_gravity::self_gravity(case, params)?;
    initial::resolve(case, &params.body)?;
    case.numerical_limits = numerical_limits::numerical_limits(&params.numerical_limits, case)?;
    case.loads.absorbers = absorbers::absorbers(&params.absorb, case)?;
    relaxation::relax(case, params)?;
    fibres::resolve(case, &params.body)?;
    case.loads.detonators = detonators::detonators(&params.detonate, &params.body, case)?;
    pressures::check_form(case, &params.pressure)?;
    total::resolve(case, &params.body)?;
    // Its defaults hang on the forms of bodies.
    case.time_step = time_step(
        case.extent(),
        &params.time_step,
        &case.sph,
        &case.bodies,
        &case.materials,
    )?;
    case.measure = measure::measure(case, &params.measure, &params.gauge, &params.witness)?;
    stress_points::check(case, params.sph.form.as_ref().map(Spanned::span))?;
    across::check(case, params)?;
    axisymmetric::check(case, params)?;
    check_moduli(case, &params.body)?;
    check_overlaps(case, &params.body)
}

/// True if bodies may come apart into what can meet again.
fn may_tear(bodies: &[Body], materials: &[Material]) -> bool {
    let soft = bodies.iter().filter(|body| body.rigid.is_none());
    let mut materials = soft.map(|body| &materials[body.material]);
    materials.clone().all(|m| m.p_wave_modulus() > 0.0) && materials.any(|m| m.failure.has_memory())
}

/// Contact scales with a modulus, which a gas has only at a pressure: of its reference state or of the start.
fn check_moduli(case: &Case, params: &[Spanned<BodyParams>]) -> Result<(), Diagnostic> {
    for (a, (body, table)) in case.bodies.iter().zip(params).enumerate() {
        let material = &case.materials[body.material];
        let pushes = |b| {
            if a == b {
                case.self_contact.is_some()
            } else {
                case.contact_between(a, b).class().is_some()
            }
        };
        if case.contact_modulus(body) == 0.0 && (0..case.bodies.len()).any(pushes) {
            let title = format!(
                "the gas `{}` has no modulus that contact could scale with",
                material.name
            );
            let named = table.get_ref().material.as_ref();
            return Err(Diagnostic::new(named.map_or_else(|| table.span(), Spanned::span), title)
                .help("give its `eos.ideal_gas` a `reference_pressure`, or join the bodies by `kernel` contact"));
        }
    }
    Ok(())
}

/// Bodies that begin within each other would fly apart at once.
fn check_overlaps(case: &Case, params: &[Spanned<BodyParams>]) -> Result<(), Diagnostic> {
    let mut pairs = close_pairs(case);
    // The first body that lies in one before it.
    pairs.sort_by_key(|&[a, b]| [b, a]);
    let searches = Searches::new(case);
    for [a, b] in pairs {
        let found = overlap(&searches, a, b).filter(|found| found.depth > MOST_OVERLAP);
        if let Some(found) = found {
            let title = format!(
                "`{}` begins {:.1} spacings within `{}`, near {}",
                case.bodies[b].name,
                found.depth,
                case.bodies[a].name,
                case.length_unit.vector(&found.at[..case.dimension])
            );
            return Err(
                Diagnostic::new(params[b].get_ref().form_span(), title).help(
                    "move one of them, or let it `touch` the other; only bodies with contact of \
                 mode \"none\" may overlap",
                ),
            );
        }
    }
    Ok(())
}

/// The unit in which the spacing is given, of the case or of its first body, or a file's; one that
/// fits where none is stated.
fn length_unit(params: &CaseParams, made: &[Body]) -> Readable {
    let bodies = || params.body.iter().map(Spanned::get_ref);
    let of_case = params.spacing.iter().map(Spanned::get_ref);
    let spacings = bodies().flat_map(|body| &body.spacing);
    let of_bodies = spacings.filter_map(|spacing| spacing.get_ref().finest());
    let given = bodies().flat_map(|body| &body.particles);
    let of_files = given.flat_map(|particles| &particles.get_ref().unit);
    let all = of_case
        .chain(of_bodies)
        .chain(of_files.map(Spanned::get_ref));
    let size = all.map(|spacing| spacing.unit).next();
    let fits = || made.first().map_or(1.0, |body| body.lattice.spacing);
    size.map_or_else(|| Readable::new("m", fits()), Readable::length)
}

fn dimension(params: &Spanned<i64>) -> Result<usize, Diagnostic> {
    match params.get_ref() {
        1 => Ok(1),
        2 => Ok(2),
        3 => Ok(3),
        _ => Err(Diagnostic::new(
            params.span(),
            "`dimension` must be 1 (uniaxial strain), 2 (plane strain) or 3",
        )),
    }
}

/// An axis that must exist in the dimension.
fn in_dimension(axis: Axis, dimension: usize, at: Range<usize>) -> Result<Axis, Diagnostic> {
    if axis.index() < dimension {
        return Ok(axis);
    }
    let title = format!("a {dimension}-dimensional case has no {} axis", axis.name());
    Err(Diagnostic::new(at, title))
}

/// As [`in_dimension`], of the axis that a key names.
fn axis(name: &Spanned<Axis>, dimension: usize) -> Result<Axis, Diagnostic> {
    in_dimension(*name.get_ref(), dimension, name.span())
}

fn symmetry(params: &[SymmetryParams], dimension: usize) -> Result<Vec<SymmetryPlane>, Diagnostic> {
    let mut planes: Vec<SymmetryPlane> = Vec::new();
    for plane in params {
        let axis = axis(&plane.axis, dimension)?;
        if planes.iter().any(|p| p.axis == axis) {
            let title = format!("a second symmetry plane normal to {}", axis.name());
            return Err(Diagnostic::new(plane.axis.span(), title).help("each axis can have one"));
        }
        planes.push(SymmetryPlane {
            axis,
            position: plane.position()?,
        });
    }
    Ok(planes)
}

/// The options of the sums, and smoothing length over spacing. A gas expands beyond the reach that its particles had.
pub(super) fn sph<'a>(
    params: &SphParams,
    mut materials: impl Iterator<Item = &'a Material>,
) -> Result<(SphOptions, f64), Diagnostic> {
    let is_gas = |material: &Material| matches!(material.eos, Eos::IdealGas(_) | Eos::Jwl(_));
    let expands = params.smoothing_length.is_none() && materials.any(is_gas);
    let [min, max] = if expands { [1.0, 10.0] } else { [0.6, 2.0] };
    let bounds = SmoothingLength::Variable {
        min: params.smoothing_length_min()?.unwrap_or(min),
        max: params.smoothing_length_max()?.unwrap_or(max),
    };
    let options = SphOptions {
        form: params.form(),
        alpha: params.alpha()?,
        beta: params.beta()?,
        smoothing_length: match params.smoothing_length {
            Some(SmoothingName::Variable) => bounds,
            None if expands => bounds,
            _ => SmoothingLength::Constant,
        },
        terms: params.terms()?,
        hourglass: params.hourglass()?,
    };
    Ok((options, params.smoothing()?))
}

/// Smallest h/h₀ that a particle may have.
fn smallest_smoothing(sph: &SphOptions) -> f64 {
    match sph.smoothing_length {
        SmoothingLength::Constant => 1.0,
        SmoothingLength::Variable { min, .. } => min,
    }
}

fn time_step(
    dimension: usize,
    params: &TimeStepParams,
    sph: &SphOptions,
    bodies: &[Body],
    materials: &[Material],
) -> Result<TimeStepOptions, Diagnostic> {
    let diffusion = bodies.iter().map(|body| {
        let shortest = body.smoothing_length * smallest_smoothing(sph);
        materials[body.material].diffusion_time(shortest)
    });
    let default = DefaultFactors::of(dimension, sph, bodies);
    Ok(TimeStepOptions {
        courant: params.courant()?.unwrap_or(default.courant),
        force: params.force()?.unwrap_or(default.force),
        contact: params.contact()?.unwrap_or(default.contact),
        max: diffusion.fold(params.max()?.unwrap_or(f64::INFINITY), f64::min),
    })
}

/// Options that have boxes.
fn domain_and_output(
    params: &CaseParams,
    boxes: &KeepReader,
    materials: &[Material],
) -> Result<(DomainOptions, OutputOptions), Diagnostic> {
    let spacing = params.spacing.as_ref().map(|spacing| spacing.get_ref().si);
    let reader = output::Reader {
        boxes,
        spacing,
        materials,
    };
    let domain = domain::domain(&params.domain, boxes, spacing)?;
    Ok((domain, reader.read(&params.output)?))
}

fn run(params: &RunParams) -> Result<RunControl, Diagnostic> {
    Ok(RunControl {
        end_time: params.end_time()?,
        max_steps: params.max_steps()?,
    })
}
