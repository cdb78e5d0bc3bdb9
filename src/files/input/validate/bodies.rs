//! Bodies: shapes in metres, lattices, velocities; then touch and whether there are particles.

use std::collections::HashSet;
use std::path::Path;

use toml::Spanned;

use super::freedom::freedom;
use super::grading::{finest, graded, grading};
use super::initial;
use super::lattice::lattice;
use super::motion::motion;
use super::particles::{self, Files};
use super::shapes::Shapes;
use super::touch;
use crate::input::names;
use crate::input::schema::{AngularVelocityParams, BodyParams, CaseParams, ShapeParams};
use crate::input::source::Diagnostic;
use material::{Eos, Failure, Linear, LinearForm, Material, Strength};
use model::{
    Body, Lattice, LatticeKind, Motion, Primitive, Profile, Shape, Solid, SymmetryPlane, Vec3,
};
use populate;

/// Bounding lattices beyond this are a slip in a unit rather than a body.
const MOST_SITES: u64 = 100_000_000_000;
/// Most bodies.
const MOST_BODIES: usize = 100_000;
/// Range of the first layer above a symmetry plane, in spacings, so that particles neither
/// sit on their own mirror images nor leave a gap.
const FIRST_LAYER: (f64, f64) = (0.25, 0.75);

/// Material of a rigid body without one: contact takes the smaller of two moduli, so that of its
/// partner. The density has no effect, since only volumes count.
pub fn no_material() -> Material {
    Material {
        name: "rigid".to_owned(),
        reference_density: 1000.0,
        eos: Eos::Linear(Linear {
            bulk_modulus: f64::INFINITY,
            form: LinearForm::Logarithmic,
        }),
        strength: Strength::None,
        failure: Failure::NONE,
        thermal: None,
        porosity: None,
    }
}

/// An initial velocity (m/s), the motion of a rigid body, and the components of a velocity that varies.
type Moves = (Vec3, Option<Motion>, Option<[Profile; 3]>);

/// Inputs that all bodies share.
pub struct Reader<'a> {
    pub dimension: usize,
    /// The case, whose spacing is that of bodies that set none.
    pub case: &'a CaseParams,
    pub materials: &'a [String],
    /// The materials themselves.
    pub known: &'a [Material],
    /// Filling of bodies that do not state one.
    pub filling: LatticeKind,
    /// Smoothing length over spacing.
    pub smoothing: f64,
    /// Folder of the files that the case names.
    pub folder: &'a Path,
}

impl Reader<'_> {
    /// All bodies in their final places.
    pub fn bodies(
        &self,
        params: &[Spanned<BodyParams>],
        symmetry: &[SymmetryPlane],
    ) -> Result<Vec<Body>, Diagnostic> {
        if params.is_empty() {
            return Err(Diagnostic::new(0..0, "the case has no `[[body]]`"));
        }
        if let Some(table) = params.get(MOST_BODIES) {
            let title = format!("more than {MOST_BODIES} bodies");
            return Err(Diagnostic::new(table.get_ref().name.span(), title));
        }
        let mut bodies: Vec<Body> = Vec::with_capacity(params.len());
        let mut taken = HashSet::new();
        for table in params {
            let body = self.body(table)?;
            if !taken.insert(table.get_ref().name.get_ref().as_str()) {
                let title = format!("a second body is named `{}`", body.name);
                return Err(Diagnostic::new(table.get_ref().name.span(), title));
            }
            bodies.push(body);
        }
        if bodies.iter().all(|body| body.driven().is_some()) {
            return Err(Diagnostic::new(params[0].span(), "every body is rigid"));
        }
        self.check_size(params, &bodies)?;
        touch::resolve(params, &mut bodies, self.dimension)?;
        populate::fill(&mut bodies, self.dimension, symmetry);
        for (table, body) in params.iter().zip(&mut bodies) {
            self.check_particles(table.get_ref(), body, symmetry)?;
            body.lattice.volume = populate::even_volume(body, self.dimension, symmetry);
        }
        Ok(bodies)
    }

    fn body(&self, table: &Spanned<BodyParams>) -> Result<Body, Diagnostic> {
        let params = table.get_ref();
        let name = params.name.get_ref();
        if name.is_empty() || name.bytes().all(|c| c.is_ascii_digit()) {
            let title = "a body's name must have a letter";
            return Err(Diagnostic::new(params.name.span(), title));
        }
        names::check(&params.name, "body")?;
        let material = self.material(params, table)?;
        let (velocity, rigid, varied) = self.motion(params)?;
        let spin = self.angular_velocity(params)?;
        let density = params.density()?;
        let (shape, lattice) = self.form(params, material, table)?;
        let mut body = Body {
            name: name.clone(),
            smoothing_length: self.smoothing * lattice.spacing,
            total: false,
            layer: false,
            filled: None,
            shape,
            material,
            lattice,
            velocity,
            angular_velocity: spin,
            rigid,
            freedom: freedom(
                params,
                [velocity, spin],
                (self.dimension, self.case.symmetry.len()),
            )?,
            density,
            initial: initial::initial(params, varied, self.dimension)?,
        };
        if let Some(cloud) = body.cloud().map(|(cloud, _)| cloud.clone()) {
            particles::set_initial(&cloud, &mut body.velocity, &mut body.initial);
        }
        Ok(body)
    }

    /// The shape of a body and how it is filled.
    fn form(
        &self,
        params: &BodyParams,
        material: usize,
        table: &Spanned<BodyParams>,
    ) -> Result<(Shape, Lattice), Diagnostic> {
        let own = params.spacing.as_ref().map(finest).transpose()?;
        let of_case = self.case.spacing()?;
        let spacing = own.or(of_case);
        match (&params.shape, &params.particles) {
            (Some(shape), None) => {
                let Some(spacing) = spacing else {
                    let name = params.name.get_ref();
                    let title = format!("the body `{name}` has no `spacing`");
                    return Err(Diagnostic::new(params.name.span(), title).help(
                        "give it one, or one to all bodies at the top: `spacing = \"0.02 mm\"`",
                    ));
                };
                self.filled(params, shape, spacing)
            }
            (None, Some(particles)) => {
                let files = Files {
                    dimension: self.dimension,
                    folder: self.folder,
                    material: self.known.get(material),
                    spacing,
                };
                let (shape, mean) = files.shape(params, particles)?;
                if graded(params.spacing.as_ref()).is_some() {
                    let title = "particles of a file have their own spacings: none can grow";
                    return Err(Diagnostic::new(particles.span(), title));
                }
                let mut lattice = Lattice {
                    spacing: own.unwrap_or(mean),
                    ..Lattice::default()
                };
                if let Shape::Solid(Solid::Primitive(Primitive::Cloud(cloud), _)) = &shape {
                    lattice.sizes = cloud.sizes();
                }
                Ok((shape, lattice))
            }
            (Some(_), Some(particles)) => {
                let title = "a body has a `shape` or `particles`, not both";
                Err(Diagnostic::new(particles.span(), title))
            }
            (None, None) => {
                let title = "the key `shape` is missing";
                Err(Diagnostic::new(table.span(), title)
                    .label("in this table")
                    .help("or give the body the `particles` of a file"))
            }
        }
    }

    /// A shape, and how it is filled with particles of a spacing (m).
    fn filled(
        &self,
        params: &BodyParams,
        shape: &Spanned<ShapeParams>,
        spacing: f64,
    ) -> Result<(Shape, Lattice), Diagnostic> {
        let shapes = Shapes {
            dimension: self.dimension,
            spacing,
            folder: self.folder,
        };
        let shape = shapes.shape(shape)?;
        let mut lattice = lattice(&shapes, params.lattice.as_ref(), &shape, self.filling)?;
        if let Some(table) = graded(params.spacing.as_ref()) {
            if params.lattice.is_none() {
                lattice.kind = LatticeKind::Glass;
            }
            lattice.grade(grading(&shapes, table, &shape, lattice.kind)?);
        }
        Ok((shape, lattice))
    }

    /// Index of the material; one beyond the last for a driven body that names none.
    fn material(
        &self,
        params: &BodyParams,
        table: &Spanned<BodyParams>,
    ) -> Result<usize, Diagnostic> {
        let Some(name) = &params.material else {
            if params.rigid == Some(true) && !params.is_free() {
                return Ok(self.materials.len());
            }
            let title = "the key `material` is missing";
            return Err(Diagnostic::new(table.span(), title).label("in this table"));
        };
        let wanted = name.get_ref();
        let found = self.materials.iter().position(|m| m == wanted);
        found.ok_or_else(|| {
            let known = self.materials.iter().map(String::as_str);
            Diagnostic::unknown(name.span(), "material", wanted, known)
        })
    }

    /// The initial velocity, the motion of a rigid body, and the components of a velocity that varies.
    fn motion(&self, params: &BodyParams) -> Result<Moves, Diagnostic> {
        let given = params.velocity.as_ref();
        let (velocity, varied) = match initial::oblique(params, self.dimension)? {
            Some(velocity) => (velocity, None),
            None => initial::velocity(given, self.dimension)?,
        };
        let rigid = params.rigid == Some(true);
        if let Some(given) = given.filter(|_| rigid && varied.is_some()) {
            let title = "a rigid body has one velocity: its `velocity` cannot vary";
            return Err(Diagnostic::new(given.span(), title));
        }
        if let Some(free) = params.free.as_ref().filter(|free| *free.get_ref()) {
            if let Some(table) = &params.motion {
                let title = "forces move a free rigid body: it has no `motion`";
                return Err(Diagnostic::new(table.span(), title));
            }
            if !rigid {
                let title = "only a rigid body is `free`: forces move all others anyway";
                return Err(Diagnostic::new(free.span(), title));
            }
            return Ok((velocity, Some(Motion::default()), None));
        }
        let Some(table) = &params.motion else {
            let motion = rigid.then(|| Motion::constant(velocity.into()));
            return Ok((velocity, motion, varied));
        };
        if !rigid || params.velocity.is_some() || params.speed.is_some() {
            let title = if rigid {
                "a rigid body has a `velocity` or a `motion`, not both"
            } else {
                "only a rigid body has a `motion`"
            };
            return Err(Diagnostic::new(table.span(), title)
                .help("regions of other bodies are driven by a `[[load]]`"));
        }
        let mut motion = motion(table, self.dimension)?;
        for velocities in &mut motion.velocities {
            velocities.get_or_insert_with(|| vec![0.0; motion.times.len()]);
        }
        let start = std::array::from_fn::<f64, 3, _>(|a| motion.velocity(a, 0.0));
        Ok((start.into(), Some(motion), None))
    }

    /// The initial angular velocity: about x, y and z, or in two dimensions about z.
    fn angular_velocity(&self, params: &BodyParams) -> Result<Vec3, Diagnostic> {
        let Some(given) = &params.angular_velocity else {
            return Ok(Vec3::zeros());
        };
        if params.rigid == Some(true) && !params.is_free() {
            let title = "a rigid body does not turn: it has no `angular_velocity`";
            return Err(Diagnostic::new(given.span(), title).help("a `free` one does"));
        }
        let (rates, span) = match given.get_ref() {
            AngularVelocityParams::Own(rates) => (rates, given.span()),
            AngularVelocityParams::About(table) => (table.rate.get_ref(), table.rate.span()),
        };
        let title = match (self.dimension, rates.as_slice()) {
            (2, [about_z]) => return Ok(Vec3::new(0.0, 0.0, about_z.get_ref().si)),
            (3, [x, y, z]) => return Ok(Vec3::from([x, y, z].map(|rate| rate.get_ref().si))),
            (1, _) => "in one dimension nothing turns",
            (2, _) => "in two dimensions `angular_velocity` has one component, about z",
            _ => "`angular_velocity` must have three components, about x, y and z",
        };
        Err(Diagnostic::new(span, title))
    }

    fn check_size(
        &self,
        params: &[Spanned<BodyParams>],
        bodies: &[Body],
    ) -> Result<(), Diagnostic> {
        for (table, body) in params.iter().zip(bodies) {
            let sites = populate::most_sites(body, self.dimension);
            if sites > MOST_SITES {
                let own = table.get_ref().spacing.as_ref().map(Spanned::span);
                let at = own.or(self.case.spacing.as_ref().map(Spanned::span));
                let at = at.unwrap_or_else(|| table.get_ref().name.span());
                let title = format!(
                    "the body `{}` would have more than {MOST_SITES:e} particles",
                    body.name
                );
                return Err(Diagnostic::new(at, title).help("check the units of size and spacing"));
            }
        }
        Ok(())
    }

    /// There are particles, and symmetry planes cut between their layers.
    fn check_particles(
        &self,
        params: &BodyParams,
        body: &Body,
        symmetry: &[SymmetryPlane],
    ) -> Result<(), Diagnostic> {
        let warn = |title| Diagnostic::new(params.form_span(), title);
        if populate::bounds(body, self.dimension).is_none() {
            let title = format!("the body `{}` is too thin for a single particle", body.name);
            return Err(warn(title).help("make its spacing finer"));
        }
        if populate::bounds_above(body, self.dimension, symmetry).is_none() {
            let title = format!(
                "the body `{}` has no particle above the symmetry planes",
                body.name
            );
            let mut help = "a symmetry plane keeps the side of larger coordinates".to_owned();
            if params.is_of_file() {
                help.push_str(": `mirror` of the file puts it there, as in `mirror = \"x\"`");
            }
            return Err(warn(title).help(help));
        }
        for plane in symmetry {
            self.check_plane(params, body, symmetry, plane)?;
        }
        Ok(())
    }

    /// One of the symmetry planes cuts between layers of a body, or not at all.
    fn check_plane(
        &self,
        params: &BodyParams,
        body: &Body,
        symmetry: &[SymmetryPlane],
        plane: &SymmetryPlane,
    ) -> Result<(), Diagnostic> {
        let warn = |title| Diagnostic::new(params.form_span(), title);
        let (axis, spacing) = (plane.axis, body.lattice.spacing);
        let near = populate::first_layer(body, self.dimension, symmetry, axis);
        let gap = near.map_or(0.5, |x| (x - plane.position) / spacing);
        let is_cut = populate::bounds(body, self.dimension)
            .is_some_and(|(lower, _)| lower[axis.index()] <= plane.position);
        // One that begins at the plane goes on behind it.
        if body.is_free() && !is_cut && gap > 1.0 {
            let title = format!(
                "the symmetry plane of {} does not cut the free rigid body `{}`, which could pass through it",
                axis.name(),
                body.name
            );
            return Err(warn(title).help("model the whole without the plane"));
        }
        let turns_across = (0..3).any(|a| a != axis.index() && body.angular_velocity[a] != 0.0);
        if (is_cut || body.is_free()) && turns_across {
            let title = format!(
                "`{}` is cut by the symmetry plane of {}, so that it can turn only about that axis",
                body.name,
                axis.name()
            );
            let span = params
                .angular_velocity
                .as_ref()
                .map_or_else(|| params.form_span(), Spanned::span);
            return Err(Diagnostic::new(span, title));
        }
        if is_cut && body.lattice.kind == LatticeKind::Shells {
            let title = format!(
                "the symmetry plane of {} cuts `{}`, whose shells are not the same on both sides",
                axis.name(),
                body.name
            );
            return Err(warn(title).help("fill it with glass, or model the whole of it"));
        }
        // Particles of a file stand where they are, fitted ones at a face.
        if body.cloud().is_some() || populate::moves_sites(body) {
            return Ok(());
        }
        if gap < FIRST_LAYER.0 || (is_cut && gap > FIRST_LAYER.1) {
            let title = format!(
                "the symmetry plane of {} does not lie between two layers of `{}`",
                axis.name(),
                body.name
            );
            return Err(warn(title).help(
                "take an even number of layers about the plane, or a body that begins at it",
            ));
        }
        Ok(())
    }
}
