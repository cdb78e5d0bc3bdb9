//! Bodies whose particles a file gives.

mod asked;

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use toml::Spanned;

use super::axis;
use super::meshes::missing_file;
use super::shapes::Shapes;
use super::solids::turns;
use crate::input::cloud::{self, Columns, Fault, Request, Table, UnitSystem};
use crate::input::schema::{BodyParams, FormatName, ParticlesParams};
use crate::input::source::Diagnostic;
use asked::{columns, parts};
use material::Material;
use model::{
    Cloud, Initial, Placement, Primitive, Quantity, Shape, Solid, SurfaceFile, Vec3, cube, edge,
};

/// Inputs of the particles of a body.
pub struct Files<'a> {
    pub dimension: usize,
    /// The folder of the case.
    pub folder: &'a Path,
    /// Its material; nothing of a rigid body that names none.
    pub material: Option<&'a Material>,
    /// Its spacing, or that of all bodies, as stated (m).
    pub spacing: Option<f64>,
}

type Given<'a> = &'a Spanned<ParticlesParams>;

impl Files<'_> {
    /// The shape of given particles, and their mean spacing (m).
    pub fn shape(&self, body: &BodyParams, table: Given) -> Result<(Shape, f64), Diagnostic> {
        let params = table.get_ref();
        if let Some(lattice) = &body.lattice {
            let title = "particles of a file stand where they are: they have no `lattice`";
            return Err(Diagnostic::new(lattice.span(), title));
        }
        let (mut rows, file) = self.read(params)?;
        self.forget(body, &mut rows);
        let refuse = |words: &str| refusal(params, &Fault::from(words));
        let mut positions = take_positions(&mut rows, self.dimension);
        let volumes = self.volumes(body, &mut rows, positions.len());
        let volumes = volumes.map_err(|words| refuse(&words))?;
        self.heat(body, &mut rows).map_err(|words| refuse(&words))?;
        self.may_fail(&mut rows).map_err(|words| refuse(&words))?;
        self.may_crush(&mut rows).map_err(|words| refuse(&words))?;
        self.may_burn(&mut rows).map_err(|words| refuse(&words))?;
        #[allow(clippy::cast_precision_loss)] // far fewer than 2^52
        let mean = volumes.iter().fold(0.0, |sum, v| sum + v) / volumes.len() as f64;
        let mean = edge(mean, self.dimension);
        self.place(params, mean, &mut positions, &mut rows)?;
        if let Some([a, b]) = coincident(&positions) {
            let [a, b] = [a + 1, b + 1];
            return Err(refuse(&format!(
                "particles {a} and {b} stand at the same place"
            )));
        }
        let cloud = Cloud::new(file, self.dimension, positions, volumes, rows.columns);
        let form = Primitive::Cloud(Arc::new(cloud));
        let place = Placement::at(Vec3::zeros());
        Ok((Shape::Solid(Solid::Primitive(form, place)), mean))
    }

    /// Reads the file, which must be the one that the case began with.
    fn read(&self, params: &ParticlesParams) -> Result<(Table, SurfaceFile), Diagnostic> {
        let path = cloud::resolve(&self.folder.join(params.file.get_ref()));
        let stated = params.format.as_ref().map(|format| *format.get_ref());
        if path.is_dir() {
            let fault = Fault::from("it is a folder without snapshots");
            return Err(refusal(params, &fault));
        }
        let Some(format) = stated.or_else(|| cloud::format_of(&path)) else {
            let title = "its ending does not tell what is in the file: state its `format`";
            return Err(Diagnostic::new(params.file.span(), title).help(
                "one of \"csv\", \"snapshot\", \"hdf5\", \"vtu\", \"dyna\", \"abaqus\", \"gmsh\", \
                 \"lammps\", \"xyz\"",
            ));
        };
        let request = self.request(params, format)?;
        let (rows, file) = cloud::read(&path, format, &request).map_err(|fault| {
            let diagnostic = refusal(params, &fault);
            if fault.is_missing {
                missing_file(diagnostic, &path)
            } else {
                diagnostic
            }
        })?;
        match &params.sha256 {
            Some(known) if *known.get_ref() != file.sha256 => {
                let path = &file.path;
                let title =
                    format!("the file {path} is no longer the one that the case began with");
                Err(Diagnostic::new(known.span(), title)
                    .help("bring it back, or begin a new case without `sha256`"))
            }
            _ => Ok((rows, file)),
        }
    }

    fn request(&self, params: &ParticlesParams, format: FormatName) -> Result<Request, Diagnostic> {
        let stated = UnitSystem {
            length: params.unit()?,
            mass: params.mass_unit()?,
            time: params.time_unit()?,
        };
        if let (FormatName::Snapshot, Some(given)) = (format, &params.unit) {
            let title = "a snapshot of this program is in SI units: it needs no `unit`";
            return Err(Diagnostic::new(given.span(), title));
        }
        let is_mesh = matches!(
            format,
            FormatName::Dyna | FormatName::Abaqus | FormatName::Gmsh | FormatName::Vtu
        );
        if let (false, Some(given)) = (is_mesh, &params.take) {
            let title = "only a mesh has elements and nodes to `take`";
            return Err(Diagnostic::new(given.span(), title));
        }
        let is_deck = matches!(
            format,
            FormatName::Dyna | FormatName::Abaqus | FormatName::Gmsh
        );
        let has_columns = !is_deck && format != FormatName::Snapshot;
        if let (false, Some(given)) = (has_columns, &params.columns) {
            let title = "a file of this format has no `columns` to name";
            return Err(Diagnostic::new(given.span(), title));
        }
        Ok(Request {
            dimension: self.dimension,
            units: stated,
            columns: params
                .columns
                .as_ref()
                .map_or_else(Columns::default, columns),
            parts: params.part.as_ref().map_or(Ok(Vec::new()), parts)?,
            take: params.take(),
        })
    }

    /// Drops what the body says itself, and all state of a rigid one.
    fn forget(&self, body: &BodyParams, rows: &mut Table) {
        let is_rigid = body.rigid == Some(true);
        let moves =
            body.velocity.is_some() || body.speed.is_some() || body.angular_velocity.is_some();
        let is_heated = body.temperature.is_some() || body.specific_energy.is_some();
        rows.columns.retain(|(quantity, _)| match quantity {
            Quantity::Position | Quantity::Volume => true,
            Quantity::Mass => self.material.is_some(),
            _ if is_rigid => false,
            Quantity::Velocity => !moves,
            Quantity::SpecificEnergy | Quantity::Temperature => !is_heated,
            Quantity::PlasticStrain => body.plastic_strain.is_none(),
            Quantity::Density => body.density.is_none(),
            _ => true,
        });
    }

    /// Initial density of the body (kg/m³).
    fn density(&self, body: &BodyParams) -> f64 {
        let stated = body.density.as_ref().map(|density| density.get_ref().si);
        stated.unwrap_or_else(|| self.material.map_or(1.0, |m| m.reference_density))
    }

    /// Volumes (m³; m² or m in two or one dimensions), of masses if those are told, else of the
    /// spacing if neither is.
    fn volumes(
        &self,
        body: &BodyParams,
        rows: &mut Table,
        count: usize,
    ) -> Result<Vec<f64>, String> {
        let density = self.density(body);
        let given = rows.take(Quantity::Volume);
        if let Some(masses) = rows.get(Quantity::Mass) {
            return Ok(masses.iter().map(|mass| mass / density).collect());
        }
        let volumes = match (given, self.spacing) {
            (Some(volumes), _) => volumes,
            (None, Some(spacing)) => {
                let volume = cube(spacing, self.dimension);
                vec![volume; count]
            }
            (None, None) => {
                let help = "give the body its `spacing`";
                return Err(format!(
                    "it tells neither the mass nor the volume of its particles: {help}"
                ));
            }
        };
        // Where densities differ, masses do.
        if let Some(densities) = rows.get(Quantity::Density) {
            let masses = densities.iter().zip(&volumes).map(|(rho, v)| rho * v);
            let masses = masses.collect();
            rows.columns.push((Quantity::Mass, masses));
        }
        Ok(volumes)
    }

    /// Energies of temperatures, if these alone are told.
    fn heat(&self, body: &BodyParams, rows: &mut Table) -> Result<(), String> {
        let Some(temperatures) = rows.take(Quantity::Temperature) else {
            return Ok(());
        };
        let (Some(material), None) = (self.material, rows.get(Quantity::SpecificEnergy)) else {
            return Ok(());
        };
        if material.thermal.is_none() {
            return Err(format!(
                "it tells temperatures, and the material `{}` has no `thermal` constants",
                material.name
            ));
        }
        let (all, densities) = (self.density(body), rows.get(Quantity::Density));
        let energy = |(row, temperature): (usize, &f64)| {
            let density = densities.map_or(all, |densities| densities[row]);
            material.energy(density, *temperature).unwrap_or(f64::NAN)
        };
        let energies: Vec<f64> = temperatures.iter().enumerate().map(energy).collect();
        if energies.iter().any(|energy| !energy.is_finite()) {
            return Err("a temperature makes no energy of its material".to_owned());
        }
        rows.columns.push((Quantity::SpecificEnergy, energies));
        Ok(())
    }

    /// Matter whose pores have been crushed must be of a material that has some.
    fn may_crush(&self, rows: &mut Table) -> Result<(), String> {
        let Some(material) = self.material.filter(|m| m.porosity.is_none()) else {
            return Ok(());
        };
        let compaction = rows.take(Quantity::Compaction);
        match compaction.into_iter().flatten().find(|x| *x > 0.0) {
            Some(compaction) => Err(format!(
                "it tells a compaction of {compaction}, and the material `{}` has no pores",
                material.name
            )),
            None => Ok(()),
        }
    }

    /// Matter that has burnt must be of an explosive.
    fn may_burn(&self, rows: &mut Table) -> Result<(), String> {
        let Some(material) = self.material.filter(|m| !m.burns()) else {
            return Ok(());
        };
        let burn = rows.take(Quantity::Burn);
        match burn.into_iter().flatten().find(|x| *x > 0.0) {
            Some(burn) => Err(format!(
                "it tells a burnt share of {burn}, and the material `{}` is no explosive",
                material.name
            )),
            None => Ok(()),
        }
    }

    /// Matter that has failed must be of a material that can.
    fn may_fail(&self, rows: &mut Table) -> Result<(), String> {
        let Some(material) = self.material.filter(|m| !m.failure.has_memory()) else {
            return Ok(());
        };
        rows.take(Quantity::FailureEnergy);
        let damage = rows.take(Quantity::Damage);
        match damage.into_iter().flatten().find(|damage| *damage > 0.0) {
            Some(damage) => Err(format!(
                "it tells a damage of {damage}, and the material `{}` cannot fail",
                material.name
            )),
            None => Ok(()),
        }
    }

    /// Mirrors, turns and moves particles and all that has directions.
    fn place(
        &self,
        params: &ParticlesParams,
        spacing: f64,
        positions: &mut [[f64; 3]],
        rows: &mut Table,
    ) -> Result<(), Diagnostic> {
        let shapes = Shapes {
            dimension: self.dimension,
            spacing,
            folder: self.folder,
        };
        if let Some(name) = &params.mirror {
            let n = axis(name, self.dimension)?.index();
            let mut mirror = nalgebra::Matrix3::identity();
            mirror[(n, n)] = -1.0;
            for x in &mut *positions {
                x[n] = -x[n];
            }
            for (quantity, values) in &mut rows.columns {
                turned(*quantity, values, &mirror);
            }
        }
        let (lower, upper) = ends(positions);
        let middle = (lower + upper) * 0.5;
        for (turn, about) in turns(&shapes, params.turn.as_ref(), middle)? {
            for x in &mut *positions {
                *x = (about + turn * (Vec3::from(*x) - about)).into();
            }
            for (quantity, values) in &mut rows.columns {
                turned(*quantity, values, &turn);
            }
        }
        if params.shift.is_some() {
            let shift = shapes.point(params.shift.as_ref(), "shift")?;
            for x in positions {
                *x = (Vec3::from(*x) + shift).into();
            }
        }
        Ok(())
    }
}

/// Turns or mirrors rows of vectors or symmetric tensors.
fn turned(quantity: Quantity, values: &mut [f64], turn: &nalgebra::Matrix3<f64>) {
    match quantity {
        Quantity::Velocity | Quantity::HourglassDisplacement => {
            for row in values.chunks_exact_mut(3) {
                let new = turn * Vec3::new(row[0], row[1], row[2]);
                row.copy_from_slice(new.as_slice());
            }
        }
        Quantity::DeviatoricStress => {
            for row in values.chunks_exact_mut(6) {
                let &mut [xx, yy, zz, xy, xz, yz] = row else {
                    continue;
                };
                let stress = nalgebra::Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz);
                let s = turn * stress * turn.transpose();
                let new = [s.m11, s.m22, s.m33, s.m12, s.m13, s.m23];
                row.copy_from_slice(&new);
            }
        }
        _ => {}
    }
}

/// Values by a cloud of its body as a whole: the middle of its velocities (m/s), the largest
/// difference from that, and the specific energy (J/kg) of the largest magnitude.
pub fn set_initial(cloud: &Cloud, velocity: &mut Vec3, initial: &mut Initial) {
    if let Some(velocities) = cloud.all(Quantity::Velocity) {
        let (velocities, _) = velocities.as_chunks::<3>();
        let (lower, upper) = ends(velocities);
        *velocity = (lower + upper) * 0.5;
        initial.velocity_spread = 0.5 * (upper - lower).norm();
    }
    let energies = cloud.all(Quantity::SpecificEnergy).unwrap_or_default();
    let larger = |a: f64, b: &f64| if b.abs() > a.abs() { *b } else { a };
    if !energies.is_empty() {
        initial.largest_energy = energies.iter().fold(0.0, larger);
    }
}

fn ends(points: &[[f64; 3]]) -> (Vec3, Vec3) {
    let nothing = (Vec3::repeat(f64::INFINITY), Vec3::repeat(f64::NEG_INFINITY));
    let each = points.iter().map(|x| Vec3::from(*x));
    each.fold(nothing, |(lower, upper), x| (lower.inf(&x), upper.sup(&x)))
}

/// Positions without what lies beyond the dimension.
fn take_positions(rows: &mut Table, dimension: usize) -> Vec<[f64; 3]> {
    let flat = rows.take(Quantity::Position).unwrap_or_default();
    let (points, _) = flat.as_chunks::<3>();
    let used = |x: &[f64; 3]| [0, 1, 2].map(|a| if a < dimension { x[a] } else { 0.0 });
    points.iter().map(used).collect()
}

/// Two rows that are at the same place.
fn coincident(positions: &[[f64; 3]]) -> Option<[usize; 2]> {
    let mut order: Vec<usize> = (0..positions.len()).collect();
    let compare = |a: &usize, b: &usize| {
        let (a, b) = (&positions[*a], &positions[*b]);
        a.partial_cmp(b).unwrap_or(std::cmp::Ordering::Equal)
    };
    order.sort_unstable_by(compare);
    let mut pairs = order.windows(2);
    let twice = pairs.find(|pair| positions[pair[0]] == positions[pair[1]])?;
    Some([twice[0].min(twice[1]), twice[0].max(twice[1])])
}

/// A fault at the key that it is about.
fn refusal(params: &ParticlesParams, fault: &Fault) -> Diagnostic {
    let file = params.file.get_ref();
    let title = format!("cannot take the particles of `{file}`: {}", fault.words);
    let span: Option<Range<usize>> = match fault.key {
        "part" => params.part.as_ref().map(Spanned::span),
        "columns" => params.columns.as_ref().map(Spanned::span),
        _ => None,
    };
    Diagnostic::new(span.unwrap_or_else(|| params.file.span()), title)
}
