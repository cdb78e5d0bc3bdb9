//! Directions of matter that has some of its own.

use toml::Spanned;

use super::shapes::{axis_vector, vector};
use crate::input::schema::{AxisParams, BodyParams, FibresParams};
use crate::input::source::Diagnostic;
use model::{Body, Case, FibrePattern, Fibres, Layup, SymmetryPlane, Vec3};

/// Cosine of the angle within which two directions are one, or a sine within which they are across.
const CLOSE: f64 = 1e-9;
/// A plate is at most this part as thick as it is wide.
const THIN: f64 = 1.0 / 3.0;
/// Least particles across a layer of yarns or walls; rounding may take a hundredth.
const LAYER: f64 = 3.0;

/// Gives its directions to every body whose matter has some.
pub fn resolve(case: &mut Case, params: &[Spanned<BodyParams>]) -> Result<(), Diagnostic> {
    let (dimension, symmetry) = (case.dimension, case.symmetry.clone());
    let kinds: Vec<[bool; 2]> = (case.bodies.iter())
        .map(|body| &case.materials[body.material])
        .map(|material| [material.has_directions(), material.has_members()])
        .collect();
    let absorbed: Vec<usize> = (case.loads.absorbers.iter().map(|zone| zone.body)).collect();
    let bodies = case.bodies.iter_mut().zip(params).zip(kinds);
    for (number, ((body, table), [has_directions, has_members])) in bodies.enumerate() {
        let stated = table.get_ref().fibres.as_ref();
        if !has_directions || body.rigid.is_some() {
            if let Some(stated) = stated {
                let title = format!("the matter of `{}` has no directions of its own", body.name);
                return Err(Diagnostic::new(stated.span(), title)
                    .help("that of `strength.orthotropic` and `strength.uncoupled` has"));
            }
            continue;
        }
        let at = stated.map_or_else(|| table.get_ref().name.span(), Spanned::span);
        refuse_stress(body, table.get_ref())?;
        if absorbed.contains(&number) {
            let title = format!(
                "`{}` has directions of its own: no zone absorbs what reaches it",
                body.name
            );
            return Err(Diagnostic::new(at, title));
        }
        let across = if has_members {
            across(body, table.get_ref(), dimension)
        } else {
            Vec3::z()
        };
        let fibres = stated.map_or_else(
            || Ok(straight(across)),
            |table| fibres(table, &across, dimension),
        )?;
        if has_members {
            check_layer(body, table.get_ref(), &fibres, dimension)?;
        }
        if let Some(plane) = symmetry.iter().find(|plane| !keeps(&fibres, plane)) {
            let title = format!(
                "the symmetry plane across {} does not mirror the directions of `{}`",
                plane.axis.name(),
                body.name
            );
            return Err(Diagnostic::new(at, title).help(
                "one of the three directions must be across it, and an axis must be across it or lie in it",
            ));
        }
        body.initial.fibres = Some(fibres);
    }
    Ok(())
}

/// Direction 1 along x where 3 is not.
fn beside(normal: &Vec3) -> Vec3 {
    if normal.x.abs() > 0.9 {
        Vec3::y()
    } else {
        Vec3::x()
    }
}

/// Direction 3 along an axis, 1 beside it.
fn straight(normal: Vec3) -> Fibres {
    Fibres {
        pattern: FibrePattern::Straight,
        along: beside(&normal),
        normal,
        centre: Vec3::zeros(),
        angle: 0.0,
        layup: None,
    }
}

/// Across the layer or the plate that a body is; z of any other.
fn across(body: &Body, params: &BodyParams, dimension: usize) -> Vec3 {
    let unit = |a: usize| Vec3::from_fn(|b, _| f64::from(u8::from(a == b)));
    let mut sides: Vec<(f64, usize)> = (0..dimension)
        .map(|a| (body.thickness_along(&unit(a), dimension), a))
        .collect();
    sides.sort_by(|a, b| a.0.total_cmp(&b.0));
    let (thin, axis) = sides[0];
    let is_plate = sides.get(1).is_none_or(|(wide, _)| thin <= THIN * wide);
    if is_plate || params.areal_density.is_some() {
        unit(axis)
    } else {
        Vec3::z()
    }
}

/// Direction 3 of a body whose matter may have some, as `fibres` says or as it is a plate.
pub fn normal(params: &BodyParams, body: &Body, dimension: usize) -> Result<Vec3, Diagnostic> {
    let stated = params.fibres.as_ref();
    match stated.and_then(|table| table.get_ref().normal.as_ref()) {
        Some(normal) => axis_vector(Some(normal)),
        None => Ok(across(body, params, dimension)),
    }
}

/// A layer of yarns or walls has three particles across it.
fn check_layer(
    body: &Body,
    params: &BodyParams,
    fibres: &Fibres,
    dimension: usize,
) -> Result<(), Diagnostic> {
    if fibres.pattern != FibrePattern::Straight || body.cloud().is_some() {
        return Ok(());
    }
    let count = body.thickness_along(&fibres.normal, dimension) / body.lattice.spacing;
    if count >= LAYER - 0.01 {
        return Ok(());
    }
    let title = format!(
        "`{}` is {count:.1} particles thick: a layer of yarns or walls has three at least",
        body.name
    );
    Err(Diagnostic::new(params.form_span(), title).help("make its spacing finer"))
}

/// What is elastic along directions begins without stress.
fn refuse_stress(body: &Body, params: &BodyParams) -> Result<(), Diagnostic> {
    let pressure = params.pressure.as_ref().map(Spanned::span);
    let stress = params.stress.as_ref().map(Spanned::span);
    let overburden = params.overburden.as_ref().map(Spanned::span);
    let Some(at) = pressure.or(stress).or(overburden) else {
        return Ok(());
    };
    let title = format!(
        "`{}` has directions of its own: it begins without stress",
        body.name
    );
    Err(Diagnostic::new(at, title))
}

fn fibres(
    table: &Spanned<FibresParams>,
    plate: &Vec3,
    dimension: usize,
) -> Result<Fibres, Diagnostic> {
    let params = table.get_ref();
    let pattern = params.pattern.unwrap_or_default();
    let straight = pattern == FibrePattern::Straight;
    let unused: [(&str, Option<&Spanned<AxisParams>>); 2] = if straight {
        [("axis", params.axis.as_ref()), ("", None)]
    } else {
        [
            ("along", params.along.as_ref()),
            ("normal", params.normal.as_ref()),
        ]
    };
    for (key, given) in unused {
        if let Some(given) = given {
            let title = format!("directions of this `pattern` have no `{key}`");
            return Err(Diagnostic::new(given.span(), title));
        }
    }
    let layup = layup(params)?;
    if let Some(centre) = (params.centre.as_ref()).filter(|_| straight && layup.is_none()) {
        let title = "directions that are the same everywhere have no `centre`";
        return Err(Diagnostic::new(centre.span(), title));
    }
    let third = if straight {
        &params.normal
    } else {
        &params.axis
    };
    let normal = match third {
        None if straight => *plate,
        third => axis_vector(third.as_ref())?,
    };
    let first = match &params.along {
        Some(along) => axis_vector(Some(along))?,
        None => beside(&normal),
    };
    let across = first - normal * first.dot(&normal);
    if across.norm() < 1e-3 {
        let at = params.along.as_ref().or(params.normal.as_ref());
        let title = "`along` and `normal` must not have the same direction";
        return Err(Diagnostic::new(
            at.map_or(table.span(), Spanned::span),
            title,
        ));
    }
    Ok(Fibres {
        pattern,
        along: across.normalize(),
        normal,
        centre: vector("centre", params.centre.as_ref(), dimension)?.into(),
        angle: params.angle()?,
        layup,
    })
}

/// The layers of a table.
fn layup(params: &FibresParams) -> Result<Option<Layup>, Diagnostic> {
    let (angles, ply) = match (&params.layup, params.ply()?) {
        (None, None) => return Ok(None),
        (Some(angles), Some(ply)) => (angles, ply),
        (Some(layup), None) => {
            let title = "the layers of a `layup` have a thickness, `ply`";
            return Err(Diagnostic::new(layup.span(), title));
        }
        (None, Some(_)) => {
            let at = params.ply.as_ref().map_or(0..0, Spanned::span);
            let title = "`ply` is the thickness of the layers of a `layup`, which is missing";
            return Err(Diagnostic::new(at, title));
        }
    };
    let values: Vec<f64> = angles
        .get_ref()
        .iter()
        .map(|angle| angle.get_ref().si)
        .collect();
    if values.is_empty() {
        return Err(Diagnostic::new(
            angles.span(),
            "a `layup` has a layer at least",
        ));
    }
    Ok(Some(Layup {
        ply,
        angles: values,
    }))
}

/// True if a plane mirrors directions into themselves.
fn keeps(fibres: &Fibres, plane: &SymmetryPlane) -> bool {
    let a = plane.axis as usize;
    let is_across = |direction: Vec3| 1.0 - direction[a].abs() < CLOSE;
    // Helices have a sense.
    let is_square = |angle: f64| libm::sin(2.0 * angle).abs() < CLOSE;
    let [axis, first] = [fibres.normal, fibres.along];
    if fibres.pattern == FibrePattern::Straight {
        let second = axis.cross(&first);
        let turned = |angle: f64| {
            let (s, c) = (libm::sin(angle), libm::cos(angle));
            is_across(first * c + second * s) || is_across(second * c - first * s)
        };
        return is_across(axis) || fibres.angles().all(turned);
    }
    let lies_in = axis[a].abs() < CLOSE && {
        let off = fibres.centre[a] - plane.position;
        off.abs() <= CLOSE * fibres.centre.norm().max(plane.position.abs())
    };
    (lies_in || is_across(axis)) && fibres.angles().all(is_square)
}
