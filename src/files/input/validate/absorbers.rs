//! Absorbing zones of bodies that stand in their final places.

use toml::Spanned;

use super::loads::given_name;
use super::shapes::vector;
use super::surfaces::unit_vector;
use crate::input::schema::{AbsorbParams, RoundParams, RoundTable};
use crate::input::source::Diagnostic;
use model::{Absorber, Axis, Body, Case, OuterFace, Shape, Vec3};
use populate::{self, Wanted};

/// The zones of a case that is whole but for them.
pub fn absorbers(
    params: &[Spanned<AbsorbParams>],
    case: &Case,
) -> Result<Vec<Absorber>, Diagnostic> {
    let mut all: Vec<Absorber> = Vec::new();
    for (n, table) in params.iter().enumerate() {
        let absorber = Reader { case, table }.absorber(n + 1)?;
        if all.iter().any(|other| other.body == absorber.body) {
            let body = &table.get_ref().body;
            let title = format!("a second absorbing zone of `{}`", body.get_ref());
            return Err(Diagnostic::new(body.span(), title).help("name all faces in one zone"));
        }
        all.push(absorber);
    }
    Ok(all)
}

/// Inputs of the reading of one zone.
struct Reader<'a> {
    case: &'a Case,
    table: &'a Spanned<AbsorbParams>,
}

impl Reader<'_> {
    fn absorber(&self, number_of: usize) -> Result<Absorber, Diagnostic> {
        let params = self.table.get_ref();
        let index = self.body()?;
        let body = &self.case.bodies[index];
        let absorber = Absorber {
            name: given_name(params.name.as_ref(), "absorb", number_of),
            body: index,
            depth: self.depth(body)?,
            faces: self.faces(body)?,
        };
        self.check_rest(&absorber, body)?;
        Ok(absorber)
    }

    /// Index of the body: one that deforms, does not turn, and in which sound has a speed.
    fn body(&self) -> Result<usize, Diagnostic> {
        let name = &self.table.get_ref().body;
        let found = self.case.body_named(name.get_ref());
        let index = found.ok_or_else(|| {
            let known = self.case.bodies.iter().map(|body| body.name.as_str());
            Diagnostic::unknown(name.span(), "body", name.get_ref(), known)
        })?;
        let body = &self.case.bodies[index];
        let material = &self.case.materials[body.material];
        let title = if body.rigid.is_some() {
            format!("the body `{}` is rigid: no wave runs in it", body.name)
        } else if body.angular_velocity != Vec3::zeros() {
            format!(
                "the body `{}` turns, which an absorbing zone would stop",
                body.name
            )
        } else if let Some(loading) = &body.initial.loading {
            format!(
                "an absorbing zone would relax the `{}` that `{}` begins under",
                loading.key(),
                body.name
            )
        } else if material.p_wave_modulus() == 0.0 {
            format!(
                "the gas `{}` has no modulus that would tell the speed of waves",
                material.name
            )
        } else {
            return Ok(index);
        };
        Err(Diagnostic::new(name.span(), title))
    }

    fn depth(&self, body: &Body) -> Result<f64, Diagnostic> {
        let spacing = body.lattice.coarsest();
        let Some(depth) = &self.table.get_ref().depth else {
            return Ok(Absorber::DEPTH * spacing);
        };
        let metres = depth.get_ref().metres(spacing);
        if metres >= Absorber::LEAST_DEPTH * spacing {
            return Ok(metres);
        }
        let title = format!(
            "`depth` must be {} spacings at least",
            Absorber::LEAST_DEPTH
        );
        Err(Diagnostic::new(depth.span(), title).help(format!(
            "waves up to as long as the zone is deep are absorbed at any angle; the default is {} \
             spacings",
            Absorber::DEPTH
        )))
    }

    fn faces(&self, body: &Body) -> Result<Vec<OuterFace>, Diagnostic> {
        let params = self.table.get_ref();
        let mut faces = Vec::new();
        for name in params.faces.iter().flat_map(Spanned::get_ref) {
            let normal = unit_vector("faces", name, self.case.dimension)?;
            let position = -body.shape.lowest(&Vec3::from(normal.map(|n| -n)));
            let face = OuterFace::Plane { normal, position };
            if faces.contains(&face) {
                let title = "this face is named twice";
                return Err(Diagnostic::new(name.span(), title));
            }
            let hidden = |a: usize, at: f64| normal[a] < -0.999 && -position <= at;
            let mut planes = self.case.symmetry.iter();
            if let Some(plane) = planes.find(|plane| hidden(plane.axis.index(), plane.position)) {
                let title = format!(
                    "this face of `{}` lies at or behind the symmetry plane of {}",
                    body.name,
                    plane.axis.name()
                );
                return Err(Diagnostic::new(name.span(), title));
            }
            faces.push(face);
        }
        if let Some(round) = &params.round {
            faces.extend(self.round(round, body)?);
        }
        if faces.is_empty() {
            let at = params
                .faces
                .as_ref()
                .map_or(self.table.span(), Spanned::span);
            return Err(Diagnostic::new(at, "an absorbing zone must have a face").help(
                "name some, as in `faces = [\"-z\", \"+x\"]`, or `round = true` for the curved face \
                 of a cylinder or a sphere",
            ));
        }
        Ok(faces)
    }

    /// The curved face of the body, or another one.
    fn round(
        &self,
        params: &Spanned<RoundParams>,
        body: &Body,
    ) -> Result<Option<OuterFace>, Diagnostic> {
        if self.case.dimension == 1 {
            let title = "in one dimension nothing is round";
            return Err(Diagnostic::new(params.span(), title));
        }
        let (centre, axis, radius) = match params.get_ref() {
            RoundParams::Is(false) => return Ok(None),
            RoundParams::Is(true) => match &body.shape {
                Shape::Sphere { centre, radius } | Shape::Shell { centre, radius, .. } => {
                    (*centre, None, *radius)
                }
                Shape::Cylinder {
                    centre,
                    axis,
                    radius,
                    ..
                } => (*centre, Some(*axis), *radius),
                Shape::Box { .. } | Shape::Solid(_) => {
                    let title = format!("the shape of `{}` has no round face", body.name);
                    return Err(Diagnostic::new(params.span(), title).help(
                        "say which one: `round = { centre = […], axis = \"z\", radius = \"…\" }`",
                    ));
                }
            },
            RoundParams::Of(table) => self.round_table(table)?,
        };
        Ok(Some(OuterFace::Round {
            centre: centre.into(),
            axis,
            radius,
        }))
    }

    fn round_table(&self, table: &RoundTable) -> Result<(Vec3, Option<Axis>, f64), Diagnostic> {
        let axis = match &table.axis {
            Some(name) if self.case.dimension == 2 && *name.get_ref() != Axis::Z => {
                let title = "in two dimensions what is round is so about z";
                return Err(Diagnostic::new(name.span(), title));
            }
            axis => axis.as_ref().map(|name| *name.get_ref()),
        };
        let centre = vector("centre", table.centre.as_ref(), self.case.dimension)?;
        let radius = table.radius()?;
        Ok((centre.into(), axis, radius))
    }

    /// Some matter must be left that no zone slows down, and the zone must hold some.
    fn check_rest(&self, absorber: &Absorber, body: &Body) -> Result<(), Diagnostic> {
        // Nought for what is looked for and infinite beyond.
        let value = |is_wanted: bool| if is_wanted { 0.0 } else { f64::INFINITY };
        let case = self.case;
        let any = |wanted: &dyn Fn(&[f64; 3], &[f64; 3]) -> bool| {
            let found = populate::search(
                (body, case.dimension, &case.symmetry),
                Wanted {
                    most: 1,
                    limit: 1.0,
                    any: true,
                },
                |lower, upper| value(wanted(lower, upper)),
                |x| value(wanted(x, x)),
            );
            !found.is_empty()
        };
        let params = self.table.get_ref();
        let at = (params.depth.as_ref().map(Spanned::span))
            .or(params.faces.as_ref().map(Spanned::span))
            .or(params.round.as_ref().map(Spanned::span));
        let at = at.unwrap_or(self.table.span());
        if !any(&|lower, upper| absorber.may_spare(lower, upper)) {
            let title = format!("the absorbing zone leaves nothing of `{}`", body.name);
            return Err(Diagnostic::new(at, title).help(format!(
                "it is {} deep from each of its faces",
                case.length_unit.text(absorber.depth)
            )));
        }
        if !any(&|lower, upper| absorber.may_hold(lower, upper)) {
            let title = format!("the absorbing zone holds no particle of `{}`", body.name);
            return Err(Diagnostic::new(at, title));
        }
        Ok(())
    }
}
