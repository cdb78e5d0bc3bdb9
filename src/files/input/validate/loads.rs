//! Gravity and prescribed velocities; rigid surfaces stand in `surfaces`.

use std::path::Path;

use toml::Spanned;

use super::motion::motion;
use super::region::region;
use super::shapes::vector;
use super::touch;
use crate::input::names;
use crate::input::quantity::{Acceleration, Placed};
use crate::input::schema::{CaseParams, LoadParams};
use crate::input::source::Diagnostic;
use model::readable::Readable;
use model::{Body, Loads, RigidSurface, SymmetryPlane, VelocityLoad};
use populate::{self, Wanted};

/// Inputs of the reading of loads.
pub struct Reader<'a> {
    pub dimension: usize,
    pub bodies: &'a mut [Body],
    pub symmetry: &'a [SymmetryPlane],
    /// The unit of length in messages.
    pub length_unit: &'a Readable,
    /// Folder of the files that the case names.
    pub folder: &'a Path,
}

impl Reader<'_> {
    /// Lays bodies on the surfaces of a case, on which loads then act where they are.
    pub fn all(self, params: &CaseParams) -> Result<Loads, Diagnostic> {
        let (symmetry, dimension) = (self.symmetry, self.dimension);
        let surfaces = self.surfaces(params)?;
        touch::lay_on_planes(&params.body, self.bodies, &surfaces, symmetry, dimension)?;
        self.loads(params, surfaces)
    }

    /// All loads of a case that has these `surfaces`.
    fn loads(&self, params: &CaseParams, surfaces: Vec<RigidSurface>) -> Result<Loads, Diagnostic> {
        let velocities: Result<Vec<VelocityLoad>, _> = params
            .load
            .iter()
            .enumerate()
            .map(|(n, table)| self.load(table.get_ref(), n + 1))
            .collect();
        let rigid = self.bodies.iter().filter(|body| body.rigid.is_some());
        if let Some(table) = params.load.last()
            && params.load.len() + rigid.count() > Loads::MOST
        {
            let title = format!(
                "a case can have at most {} loads and rigid bodies together",
                Loads::MOST
            );
            return Err(Diagnostic::new(table.span(), title));
        }
        self.check_names(params)?;
        self.check_starts(params, &surfaces)?;
        Ok(Loads {
            gravity: self.gravity(params.gravity.as_ref())?,
            self_gravity: None,
            velocities: velocities?,
            absorbers: Vec::new(),
            surfaces,
            detonators: Vec::new(),
        })
    }

    /// Names are those of rows in one table, with rigid bodies.
    fn check_names(&self, params: &CaseParams) -> Result<(), Diagnostic> {
        let named = || {
            let loads = params.load.iter().map(|t| ("load", &t.get_ref().name));
            let planes = params.plane.iter().map(|t| ("plane", &t.get_ref().name));
            let zones = params.absorb.iter().map(|t| ("zone", &t.get_ref().name));
            let surfaces = (params.surface.iter()).map(|t| ("surface", &t.get_ref().name));
            let all = loads.chain(zones).chain(planes).chain(surfaces);
            all.filter_map(|(kind, name)| Some((kind, name.as_ref()?)))
        };
        for (n, (kind, name)) in named().enumerate() {
            names::check(name, kind)?;
            let mut before = named().take(n).map(|(_, name)| name.get_ref());
            let mut bodies = self.bodies.iter().map(|body| &body.name);
            if before.any(|b| b == name.get_ref()) || bodies.any(|b| b == name.get_ref()) {
                let title = format!("the name `{}` is taken already", name.get_ref());
                return Err(Diagnostic::new(name.span(), title));
            }
        }
        Ok(())
    }

    fn gravity(
        &self,
        params: Option<&Spanned<Vec<Placed<Acceleration>>>>,
    ) -> Result<[f64; 3], Diagnostic> {
        let gravity = vector("gravity", params, self.dimension)?;
        let across = |plane: &&SymmetryPlane| gravity[plane.axis.index()] != 0.0;
        if let (Some(params), Some(plane)) = (params, self.symmetry.iter().find(across)) {
            let axis = plane.axis;
            let title = format!(
                "gravity along {} is not its own mirror image at the symmetry plane of {}",
                axis.name(),
                axis.name()
            );
            return Err(
                Diagnostic::new(params.get_ref()[axis.index()].span(), title)
                    .help("a frictionless floor is a `[[plane]]`"),
            );
        }
        Ok(gravity)
    }

    pub fn body(&self, name: &Spanned<String>) -> Result<(usize, &Body), Diagnostic> {
        let found = self.bodies.iter().position(|b| b.name == *name.get_ref());
        let index = found.ok_or_else(|| {
            let known = self.bodies.iter().map(|body| body.name.as_str());
            Diagnostic::unknown(name.span(), "body", name.get_ref(), known)
        })?;
        Ok((index, &self.bodies[index]))
    }

    fn load(&self, params: &LoadParams, number_of: usize) -> Result<VelocityLoad, Diagnostic> {
        let (index, body) = self.body(&params.body)?;
        if body.rigid.is_some() {
            let title = format!("the body `{}` is rigid", body.name);
            return Err(Diagnostic::new(params.body.span(), title)
                .help("give the body a `velocity` or a `motion` instead"));
        }
        let load = VelocityLoad {
            name: given_name(params.name.as_ref(), "load", number_of),
            body: index,
            region: region(
                [params.above.as_ref(), params.below.as_ref()],
                self.dimension,
                body.lattice.spacing,
            )?,
            motion: motion(&params.velocity, self.dimension)?,
            until: params.until()?.unwrap_or(f64::INFINITY),
        };
        if self.holds_any(&load, body) {
            return Ok(load);
        }
        let at = params.below.as_ref().or(params.above.as_ref());
        let at = at.map_or(params.body.span(), Spanned::span);
        let title = format!("the region holds no particle of `{}`", body.name);
        let (lower, upper) = populate::bounds(body, self.dimension).unwrap_or_default();
        let corner = |x: [f64; 3]| self.length_unit.vector(&x[..self.dimension]);
        Err(Diagnostic::new(at, title).help(format!(
            "its particles stand from {} to {}",
            corner(lower),
            corner(upper)
        )))
    }

    /// True if a load drives any particle of its body.
    fn holds_any(&self, load: &VelocityLoad, body: &Body) -> bool {
        // Nought in the region and infinite beyond.
        let value = |is_within: bool| if is_within { 0.0 } else { f64::INFINITY };
        let found = populate::search(
            (body, self.dimension, self.symmetry),
            Wanted {
                most: 1,
                limit: 1.0,
                any: true,
            },
            |lower, upper| value(load.region.meets(lower, upper)),
            |x| value(load.region.contains(x)),
        );
        !found.is_empty()
    }
}

pub fn given_name(name: Option<&Spanned<String>>, kind: &str, number_of: usize) -> String {
    name.map_or_else(
        || format!("{kind}-{number_of}"),
        |name| name.get_ref().clone(),
    )
}
