//! Gravity, prescribed velocities and pressures; rigid surfaces stand in `surfaces`.

use std::ops::Range;
use std::path::Path;

use toml::Spanned;

use super::motion::{self, motion};
use super::region::region;
use super::shapes::vector;
use super::touch;
use crate::input::names;
use crate::input::quantity::{Acceleration, Placed};
use crate::input::schema::{CaseParams, LoadParams, PressureParams, SidesParams};
use crate::input::source::Diagnostic;
use model::readable::Readable;
use model::{Body, Loads, PressureLoad, Region, RigidSurface, SymmetryPlane, VelocityLoad};
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
        if let Some(table) = params.pressure.get(Loads::MOST) {
            let title = format!("a case can have at most {} pressures", Loads::MOST);
            return Err(Diagnostic::new(table.span(), title));
        }
        let pressures = params.pressure.iter().enumerate();
        let pressures = pressures.map(|(n, table)| self.pressure(table.get_ref(), n + 1));
        let pressures = pressures.collect::<Result<_, _>>()?;
        self.check_names(params)?;
        self.check_starts(params, &surfaces)?;
        Ok(Loads {
            gravity: self.gravity(params.gravity.as_ref())?,
            self_gravity: None,
            velocities: velocities?,
            absorbers: Vec::new(),
            surfaces,
            detonators: Vec::new(),
            pressures,
            relaxation: None,
        })
    }

    /// Names are those of rows in one table, with rigid bodies.
    fn check_names(&self, params: &CaseParams) -> Result<(), Diagnostic> {
        let named = || {
            let loads = params.load.iter().map(|t| ("load", &t.get_ref().name));
            let planes = params.plane.iter().map(|t| ("plane", &t.get_ref().name));
            let zones = params.absorb.iter().map(|t| ("zone", &t.get_ref().name));
            let pressures = (params.pressure.iter()).map(|t| ("pressure", &t.get_ref().name));
            let surfaces = (params.surface.iter()).map(|t| ("surface", &t.get_ref().name));
            let all = loads.chain(zones).chain(pressures);
            let all = all.chain(planes).chain(surfaces);
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
            starts: false,
        };
        let sides = [params.above.as_ref(), params.below.as_ref()];
        self.check_region(body, &load.region, sides, params.body.span())?;
        Ok(load)
    }

    fn pressure(
        &self,
        params: &PressureParams,
        number_of: usize,
    ) -> Result<PressureLoad, Diagnostic> {
        let (index, body) = self.body(&params.body)?;
        if body.rigid.is_some() {
            let title = format!("the body `{}` is rigid: no pressure moves it", body.name);
            return Err(Diagnostic::new(params.body.span(), title));
        }
        let sides = [params.above.as_ref(), params.below.as_ref()];
        let load = PressureLoad {
            name: given_name(params.name.as_ref(), "pressure", number_of),
            body: index,
            region: region(sides, self.dimension, body.lattice.spacing)?,
            pressure: motion::pressure(params)?,
        };
        self.check_region(body, &load.region, sides, params.body.span())?;
        Ok(load)
    }

    /// Refuses a region, between the sides `above` and `below`, that holds no particle of a body named at a place.
    fn check_region(
        &self,
        body: &Body,
        region: &Region,
        [above, below]: [Option<&Spanned<SidesParams>>; 2],
        named: Range<usize>,
    ) -> Result<(), Diagnostic> {
        if self.holds_any(region, body) {
            return Ok(());
        }
        let at = below.or(above).map_or(named, Spanned::span);
        let title = format!("the region holds no particle of `{}`", body.name);
        let (lower, upper) = populate::bounds(body, self.dimension).unwrap_or_default();
        let corner = |x: [f64; 3]| self.length_unit.vector(&x[..self.dimension]);
        Err(Diagnostic::new(at, title).help(format!(
            "its particles stand from {} to {}",
            corner(lower),
            corner(upper)
        )))
    }

    /// True if a region holds any particle of a body.
    fn holds_any(&self, region: &Region, body: &Body) -> bool {
        // Nought in the region and infinite beyond.
        let value = |is_within: bool| if is_within { 0.0 } else { f64::INFINITY };
        let found = populate::search(
            (body, self.dimension, self.symmetry),
            Wanted {
                most: 1,
                limit: 1.0,
                any: true,
            },
            |lower, upper| value(region.meets(lower, upper)),
            |x| value(region.contains(x)),
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
