//! Rigid surfaces: planes, and the shapes of `[[surface]]`.

use std::ops::Range;

use toml::Spanned;

use super::axis;
use super::check::outer_radius;
use super::loads::{Reader, given_name};
use super::meshes::MeshReader;
use super::motion::{motion, rate};
use super::shapes::{normalised, unit, vector};
use super::touch::direction;
use crate::input::quantity::{Length, Placed};
use crate::input::schema::contact::resistance;
use crate::input::schema::{
    CaseParams, NormalParams, PlaneParams, RotationParams, SideName, SurfaceCylinderParams,
    SurfaceParams, SurfaceShapeParams, SurfaceSphereParams,
};
use crate::input::source::Diagnostic;
use crate::input::triangles::Format;
use model::{Axis, Motion, Resistance, RigidSurface, Spin, SurfaceShape};
use populate;

/// A place as it is typed.
type Place = Spanned<Vec<Placed<Length>>>;

impl Reader<'_> {
    /// The planes and the other surfaces of a case, wherever its bodies stand.
    pub(super) fn surfaces(&self, params: &CaseParams) -> Result<Vec<RigidSurface>, Diagnostic> {
        let planes = params.plane.iter().enumerate();
        let planes = planes.map(|(n, table)| self.plane(table.get_ref(), n + 1));
        let others = params.surface.iter().enumerate();
        let others = others.map(|(n, table)| self.surface(table.get_ref(), n + 1));
        planes.chain(others).collect()
    }

    /// No body may begin behind one of the [`Self::surfaces`].
    pub fn check_starts(
        &self,
        params: &CaseParams,
        surfaces: &[RigidSurface],
    ) -> Result<(), Diagnostic> {
        let planes = params.plane.iter().map(|t| t.get_ref().normal.span());
        let others = params.surface.iter().map(|t| t.get_ref().shape.span());
        for (surface, at) in surfaces.iter().zip(planes.chain(others)) {
            self.check_start(surface, &at)?;
        }
        Ok(())
    }

    fn plane(&self, params: &PlaneParams, number_of: usize) -> Result<RigidSurface, Diagnostic> {
        let normal = unit_vector("normal", &params.normal, self.dimension)?;
        let point = self.place("point", params.point.as_ref())?;
        let position = normal[0] * point[0] + normal[1] * point[1] + normal[2] * point[2];
        let given = params.motion.as_ref();
        Ok(RigidSurface {
            name: given_name(params.name.as_ref(), "plane", number_of),
            shape: SurfaceShape::Plane { normal, position },
            inside: false,
            stiffness: params.stiffness()?,
            resistance: resistance(params.friction()?, params.damping()?, Resistance::default()),
            bodies: self.acts_on(params.bodies.as_deref())?,
            motion: given.map_or(Ok(Motion::default()), |m| motion(m, self.dimension))?,
            spin: None,
        })
    }

    fn surface(
        &self,
        params: &SurfaceParams,
        number_of: usize,
    ) -> Result<RigidSurface, Diagnostic> {
        let given = params.motion.as_ref();
        let spin = params.rotation.as_ref().map(|table| self.spin(table));
        Ok(RigidSurface {
            name: given_name(params.name.as_ref(), "surface", number_of),
            shape: self.shape(&params.shape)?,
            inside: params.side() == SideName::Inside,
            stiffness: params.stiffness()?,
            resistance: resistance(params.friction()?, params.damping()?, Resistance::default()),
            bodies: self.acts_on(params.bodies.as_deref())?,
            motion: given.map_or(Ok(Motion::default()), |m| motion(m, self.dimension))?,
            spin: spin.transpose()?,
        })
    }

    /// Flags of the bodies that feel a surface: those named, or all that are not driven.
    fn acts_on(&self, names: Option<&[Spanned<String>]>) -> Result<Vec<bool>, Diagnostic> {
        let mut bodies: Vec<bool> = self.bodies.iter().map(|b| b.driven().is_none()).collect();
        let Some(names) = names else {
            return Ok(bodies);
        };
        bodies.fill(false);
        for name in names {
            let (index, body) = self.body(name)?;
            if body.driven().is_some() {
                let title = format!("the body `{}` is rigid: no surface moves it", body.name);
                return Err(Diagnostic::new(name.span(), title));
            }
            bodies[index] = true;
        }
        Ok(bodies)
    }

    /// No body may begin behind a surface.
    fn check_start(&self, surface: &RigidSurface, at: &Range<usize>) -> Result<(), Diagnostic> {
        let acts = surface.bodies.iter();
        for (body, _) in self.bodies.iter().zip(acts).filter(|(_, acts)| **acts) {
            let gap = populate::smallest_gap(body, self.dimension, self.symmetry, surface);
            if gap >= 0.0 {
                continue;
            }
            let behind = -gap / body.lattice.spacing;
            let (what, help) = match surface.shape {
                SurfaceShape::Plane { .. } => (
                    "plane",
                    "the normal points to the side of the bodies; `bodies` names those that it \
                     stops",
                ),
                _ => (
                    "surface",
                    "`side` says whether bodies are outside or inside; `bodies` names those that \
                     it stops",
                ),
            };
            let name = &body.name;
            let title = format!("the body `{name}` reaches {behind:.3} spacings behind the {what}");
            return Err(Diagnostic::new(at.clone(), title).help(help));
        }
        Ok(())
    }

    fn shape(&self, table: &Spanned<SurfaceShapeParams>) -> Result<SurfaceShape, Diagnostic> {
        let SurfaceShapeParams {
            sphere,
            cylinder,
            stl,
            obj,
        } = table.get_ref();
        let needs = |least: usize, shape: &str| {
            let title = format!("a {}-dimensional case has no {shape}", self.dimension);
            if self.dimension >= least {
                return Ok(());
            }
            let other = if self.dimension == 1 {
                "a `[[plane]]`"
            } else {
                "`shape.sphere`, a disc,"
            };
            Err(Diagnostic::new(table.span(), title).help(format!("take {other} instead")))
        };
        let mesh = |params, format| {
            needs(3, "surface of triangles")?;
            let spacings = self.bodies.iter().map(|body| body.lattice.spacing);
            let reader = MeshReader {
                folder: self.folder,
                spacing: spacings.fold(f64::INFINITY, f64::min),
                what: "rigid surface",
            };
            Ok(SurfaceShape::Mesh(reader.read(params, format)?))
        };
        match (sphere, cylinder, stl, obj) {
            (Some(params), None, None, None) => {
                needs(2, "sphere")?;
                self.sphere(params, &table.span())
            }
            (None, Some(params), None, None) => {
                needs(3, "cylinder")?;
                self.cylinder(params, &table.span())
            }
            (None, None, Some(params), None) => mesh(params, Format::Stl),
            (None, None, None, Some(params)) => mesh(params, Format::Obj),
            _ => Err(Diagnostic::new(
                table.span(),
                "`shape` must have exactly one of `sphere`, `cylinder`, `stl`, `obj`",
            )),
        }
    }

    fn sphere(
        &self,
        params: &SurfaceSphereParams,
        table: &Range<usize>,
    ) -> Result<SurfaceShape, Diagnostic> {
        let typed = [params.radius()?, params.diameter()?];
        Ok(SurfaceShape::Sphere {
            centre: self.place("centre", params.centre.as_ref())?,
            radius: outer_radius(typed, table)?,
        })
    }

    fn cylinder(
        &self,
        params: &SurfaceCylinderParams,
        table: &Range<usize>,
    ) -> Result<SurfaceShape, Diagnostic> {
        let typed = [params.radius()?, params.diameter()?];
        Ok(SurfaceShape::Cylinder {
            centre: self.place("centre", params.centre.as_ref())?,
            axis: unit(params.axis.as_ref().map_or(Axis::Z, |axis| *axis.get_ref())),
            radius: outer_radius(typed, table)?,
            half_length: 0.5 * params.length()?.unwrap_or(f64::INFINITY),
        })
    }

    fn spin(&self, table: &Spanned<RotationParams>) -> Result<Spin, Diagnostic> {
        let params = table.get_ref();
        match self.dimension {
            1 => {
                let title = "a 1-dimensional case has no rotation";
                return Err(Diagnostic::new(table.span(), title));
            }
            2 if *params.axis.get_ref() != Axis::Z => {
                let title = "a 2-dimensional case turns about z alone";
                return Err(Diagnostic::new(params.axis.span(), title));
            }
            2 => {}
            _ => {
                axis(&params.axis, self.dimension)?;
            }
        }
        Ok(Spin {
            point: self.place("point", params.point.as_ref())?,
            axis: unit(*params.axis.get_ref()),
            rate: rate(params)?,
        })
    }

    /// A place (m); the origin if absent.
    fn place(&self, key: &str, params: Option<&Place>) -> Result<[f64; 3], Diagnostic> {
        vector(key, params, self.dimension)
    }
}

/// The unit vector of a key.
pub fn unit_vector(
    key: &str,
    params: &Spanned<NormalParams>,
    dimension: usize,
) -> Result<[f64; 3], Diagnostic> {
    let mut normal = [0.0; 3];
    match params.get_ref() {
        NormalParams::Axis(word) => {
            let (axis, forward) = direction(*word, params.span(), dimension)?;
            normal[axis.index()] = if forward { 1.0 } else { -1.0 };
        }
        NormalParams::Vector(vector) => {
            let unit = normalised(key, vector, dimension);
            normal = unit.map_err(|title| Diagnostic::new(params.span(), title))?;
        }
    }
    Ok(normal)
}
