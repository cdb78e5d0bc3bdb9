//! Rigid surfaces: planes, and the shapes of `[[surface]]`.

use std::io;
use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use toml::Spanned;

use super::axis;
use super::check::{Allowed, Value, number};
use super::loads::{Reader, given_name};
use super::motion::{motion, rate};
use super::shapes::{normalised, vector};
use super::touch::direction;
use crate::input::quantity::{Length, Placed};
use crate::input::schema::contact::resistance;
use crate::input::schema::{
    CaseParams, NormalParams, PlaneParams, RotationParams, SideName, StlParams,
    SurfaceCylinderParams, SurfaceParams, SurfaceShapeParams, SurfaceSphereParams,
};
use crate::input::source::{Diagnostic, nearest};
use crate::input::stl;
use crate::model::{Axis, Mesh, Motion, Resistance, RigidSurface, Spin, SurfaceFile, SurfaceShape};
use crate::populate;

/// Default stiffness of a rigid surface: that of the half spacing of material before it.
const STIFFNESS: f64 = 2.0;

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
            stiffness: number!(params.stiffness, or STIFFNESS, Positive),
            resistance: resistance(
                params.friction.as_ref(),
                params.damping.as_ref(),
                Resistance::default(),
            )?,
            bodies: self.acts_on(params.bodies.as_deref())?,
            motion: given.map_or(Ok(Motion::default()), |m| motion(m, self.dimension))?,
            spin: None,
            file: None,
        })
    }

    fn surface(
        &self,
        params: &SurfaceParams,
        number_of: usize,
    ) -> Result<RigidSurface, Diagnostic> {
        let (shape, file) = self.shape(&params.shape)?;
        let given = params.motion.as_ref();
        let spin = params.rotation.as_ref().map(|table| self.spin(table));
        Ok(RigidSurface {
            name: given_name(params.name.as_ref(), "surface", number_of),
            shape,
            inside: params.side == Some(SideName::Inside),
            stiffness: number!(params.stiffness, or STIFFNESS, Positive),
            resistance: resistance(
                params.friction.as_ref(),
                params.damping.as_ref(),
                Resistance::default(),
            )?,
            bodies: self.acts_on(params.bodies.as_deref())?,
            motion: given.map_or(Ok(Motion::default()), |m| motion(m, self.dimension))?,
            spin: spin.transpose()?,
            file,
        })
    }

    /// Which bodies feel a surface: those named, or all that are not rigid.
    fn acts_on(&self, names: Option<&[Spanned<String>]>) -> Result<Vec<bool>, Diagnostic> {
        let mut bodies: Vec<bool> = self.bodies.iter().map(|b| b.rigid.is_none()).collect();
        let Some(names) = names else {
            return Ok(bodies);
        };
        bodies.fill(false);
        for name in names {
            let (index, body) = self.body(name)?;
            if body.rigid.is_some() {
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

    fn shape(
        &self,
        table: &Spanned<SurfaceShapeParams>,
    ) -> Result<(SurfaceShape, Option<SurfaceFile>), Diagnostic> {
        let SurfaceShapeParams {
            sphere,
            cylinder,
            stl,
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
        match (sphere, cylinder, stl) {
            (Some(params), None, None) => {
                needs(2, "sphere")?;
                Ok((self.sphere(params)?, None))
            }
            (None, Some(params), None) => {
                needs(3, "cylinder")?;
                Ok((self.cylinder(params)?, None))
            }
            (None, None, Some(params)) => {
                needs(3, "surface of triangles")?;
                let (shape, file) = self.mesh(params)?;
                Ok((shape, Some(file)))
            }
            _ => Err(Diagnostic::new(
                table.span(),
                "`shape` must have exactly one of `sphere`, `cylinder`, `stl`",
            )),
        }
    }

    fn sphere(&self, params: &SurfaceSphereParams) -> Result<SurfaceShape, Diagnostic> {
        Ok(SurfaceShape::Sphere {
            centre: self.place("centre", params.centre.as_ref())?,
            radius: number(Some(&params.radius), "radius", 0.0, Allowed::Positive)?,
        })
    }

    fn cylinder(&self, params: &SurfaceCylinderParams) -> Result<SurfaceShape, Diagnostic> {
        Ok(SurfaceShape::Cylinder {
            centre: self.place("centre", params.centre.as_ref())?,
            axis: unit(params.axis.as_ref().map_or(Axis::Z, |axis| *axis.get_ref())),
            radius: number(Some(&params.radius), "radius", 0.0, Allowed::Positive)?,
            half_length: 0.5 * number!(params.length, or f64::INFINITY, Positive),
        })
    }

    fn mesh(&self, params: &StlParams) -> Result<(SurfaceShape, SurfaceFile), Diagnostic> {
        let unit_length = number(Some(&params.unit), "unit", 0.0, Allowed::Positive)?;
        let at = self.place("at", params.at.as_ref())?;
        let path = self.folder.join(params.file.get_ref());
        let refuse = |cause: &str| {
            let title = format!(
                "cannot take the surface `{}`: {cause}",
                params.file.get_ref()
            );
            Diagnostic::new(params.file.span(), title)
        };
        let (mut soup, file) = stl::read(&path).map_err(|cause| {
            let diagnostic = refuse(&cause.to_string());
            if cause.kind() == io::ErrorKind::NotFound {
                missing_file(diagnostic, &path)
            } else {
                diagnostic
            }
        })?;
        if let Some(known) = params
            .sha256
            .as_ref()
            .filter(|d| *d.get_ref() != file.sha256)
        {
            let title = format!(
                "the file {} is no longer the one that the case began with",
                file.path
            );
            return Err(Diagnostic::new(known.span(), title)
                .help("bring it back, or begin a new case without `sha256`"));
        }
        let turn = params.turn.as_ref();
        let turn = turn.map(|turn| (unit(*turn.axis.get_ref()), turn.angle.get_ref().si()));
        for x in soup.iter_mut().flatten() {
            let scaled = x.map(|c| c * unit_length);
            let turned = turn.map_or(scaled, |(axis, angle)| turned(&scaled, &axis, angle));
            *x = std::array::from_fn(|a| turned[a] + at[a]);
        }
        let mesh = Mesh::new(&soup).map_err(|cause| {
            refuse(&cause.to_string()).help("a rigid surface must be one or more closed solids")
        })?;
        Ok((SurfaceShape::Mesh(Arc::new(mesh)), file))
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

/// Says where a file was looked for, and which other one there may be meant.
pub(super) fn missing_file(diagnostic: Diagnostic, path: &Path) -> Diagnostic {
    let text =
        |name: Option<&std::ffi::OsStr>| name.unwrap_or_default().to_string_lossy().into_owned();
    let folder = path.parent().unwrap_or(Path::new(""));
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut there: Vec<String> = entries
        .map(|entry| text(Some(&entry.file_name())))
        .collect();
    there.sort();
    let there: Vec<&str> = there.iter().map(String::as_str).collect();
    let diagnostic = diagnostic.help(format!("it is looked for at {}", path.display()));
    match nearest(&text(path.file_name()), &there) {
        Some(name) => diagnostic.label(format!("did you mean `{name}`?")),
        None => diagnostic,
    }
}

fn unit(axis: Axis) -> [f64; 3] {
    Axis::ALL.map(|other| f64::from(u8::from(other == axis)))
}

/// A vector turned by an angle (rad) about a coordinate axis.
fn turned(x: &[f64; 3], axis: &[f64; 3], angle: f64) -> [f64; 3] {
    let (s, c) = (libm::sin(angle), libm::cos(angle));
    let n = (0..3).position(|a| axis[a] == 1.0).unwrap_or(2);
    let (k, l) = ((n + 1) % 3, (n + 2) % 3);
    let mut turned = *x;
    turned[k] = c * x[k] - s * x[l];
    turned[l] = s * x[k] + c * x[l];
    turned
}
