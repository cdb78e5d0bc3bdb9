//! Directions of matter that has some of its own.

use toml::Spanned;

use super::shapes::{axis_vector, vector};
use crate::input::schema::{AxisParams, BodyParams, FibresParams};
use crate::input::source::Diagnostic;
use model::{Body, Case, FibrePattern, Fibres, SymmetryPlane, Vec3};

/// Cosine of the angle within which two directions are one, or a sine within which they are across.
const CLOSE: f64 = 1e-9;

/// Gives its directions to every body whose matter has some.
pub fn resolve(case: &mut Case, params: &[Spanned<BodyParams>]) -> Result<(), Diagnostic> {
    let (dimension, symmetry) = (case.dimension, case.symmetry.clone());
    let has_directions: Vec<bool> = (case
        .bodies
        .iter()
        .map(|body| case.materials[body.material].has_directions()))
    .collect();
    let absorbed: Vec<usize> = (case.loads.absorbers.iter().map(|zone| zone.body)).collect();
    let bodies = case.bodies.iter_mut().zip(params).zip(has_directions);
    for (number, ((body, table), has_directions)) in bodies.enumerate() {
        let stated = table.get_ref().fibres.as_ref();
        if !has_directions || body.rigid.is_some() {
            if let Some(stated) = stated {
                let title = format!("the matter of `{}` has no directions of its own", body.name);
                return Err(Diagnostic::new(stated.span(), title)
                    .help("that of `strength.orthotropic` has"));
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
        let fibres = stated.map_or_else(|| Ok(DEFAULT), |table| fibres(table, dimension))?;
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

/// Direction 1 along x, 3 along z.
const DEFAULT: Fibres = Fibres {
    pattern: FibrePattern::Straight,
    along: Vec3::new(1.0, 0.0, 0.0),
    normal: Vec3::new(0.0, 0.0, 1.0),
    centre: Vec3::new(0.0, 0.0, 0.0),
    angle: 0.0,
};

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

fn fibres(table: &Spanned<FibresParams>, dimension: usize) -> Result<Fibres, Diagnostic> {
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
    if let Some(centre) = params.centre.as_ref().filter(|_| straight) {
        let title = "directions that are the same everywhere have no `centre`";
        return Err(Diagnostic::new(centre.span(), title));
    }
    let third = if straight {
        &params.normal
    } else {
        &params.axis
    };
    let normal = axis_vector(third.as_ref())?;
    let first = match &params.along {
        Some(along) => axis_vector(Some(along))?,
        // Whatever is across the axis.
        None if !straight && normal.x.abs() > 0.9 => Vec3::y(),
        None => Vec3::x(),
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
    })
}

/// True if a plane mirrors directions into themselves.
fn keeps(fibres: &Fibres, plane: &SymmetryPlane) -> bool {
    let a = plane.axis as usize;
    let is_across = |direction: Vec3| 1.0 - direction[a].abs() < CLOSE;
    let [first, third] = fibres.at(&(fibres.centre + fibres.along));
    if fibres.pattern == FibrePattern::Straight {
        return [first, third, third.cross(&first)]
            .into_iter()
            .any(is_across);
    }
    let axis = fibres.normal;
    let lies_in = axis[a].abs() < CLOSE && {
        let off = fibres.centre[a] - plane.position;
        off.abs() <= CLOSE * fibres.centre.norm().max(plane.position.abs())
    };
    // Helices have a sense.
    let unturned = libm::sin(2.0 * fibres.angle).abs() < CLOSE;
    (lies_in || is_across(axis)) && unturned
}
