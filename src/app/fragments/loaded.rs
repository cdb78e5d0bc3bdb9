//! The particles of a snapshot.

use std::path::Path;

use super::super::results::only_part;
use super::{FragmentsError, read_case};
use desk::catalogue::Grain;
use engine::fragments::{FirstSizes, Matter, belongs};
use files::output::h5::Content;
use files::output::h5::read::SnapshotFile;
use model::{Axis, Case, FragmentOptions, Include, SymmetryPlane};
use results::{ReadError, SnapshotReader as _};

/// Particles of a snapshot, but for frozen ones.
pub struct Loaded {
    pub title: String,
    /// Time (s).
    pub time: f64,
    pub dimension: usize,
    pub bodies: Vec<String>,
    pub symmetry: Vec<SymmetryPlane>,
    /// The case's own rule.
    pub options: Option<FragmentOptions>,
    /// The case, if it can be read.
    pub case: Option<Case>,
    /// The quantities that are unknown, and why.
    pub missing: Option<String>,
    ids: Vec<u64>,
    body: Vec<u32>,
    position: Vec<[f64; 3]>,
    size: Vec<f64>,
    deformation: Vec<[f64; 9]>,
    mass: Vec<f64>,
    velocity: Vec<[f64; 3]>,
    temperature: Vec<f64>,
    plastic_strain: Vec<f64>,
    damage: Vec<f64>,
}

/// Reads fields of one snapshot.
struct Reader<'a> {
    path: &'a Path,
    file: SnapshotFile,
    names: Vec<String>,
}

impl Reader<'_> {
    fn wrong(&self, reason: impl Into<String>) -> FragmentsError {
        wrong(self.path, reason)
    }

    /// An attribute of JSON.
    fn json<T: serde::de::DeserializeOwned>(&self, name: &str) -> Result<T, FragmentsError> {
        let text = self.converted(self.file.attribute("/whipple", name))?;
        let value = serde_json::from_str(&text);
        value.map_err(|e| self.wrong(format!("attribute {name} of /whipple: {e}")))
    }

    fn converted<T>(&self, result: Result<T, ReadError>) -> Result<T, FragmentsError> {
        result.map_err(|error| match error {
            ReadError::Open(error) => error.into(),
            ReadError::Layout { .. } => self.wrong(error.to_string()),
        })
    }

    fn has(&self, field: &str) -> bool {
        self.names.iter().any(|name| name == field)
    }

    /// Numbers of a field, which must have so many components; zeros if the snapshot lacks it.
    fn field(&self, field: &str, components: usize) -> Result<Vec<f64>, FragmentsError> {
        let count = self.file.particles();
        if !self.has(field) {
            return Ok(vec![0.0; count * components]);
        }
        let actual = self.converted(self.file.components(field))?;
        if actual != components {
            return Err(self.wrong(format!("its field {field} has {actual} components")));
        }
        self.converted(self.file.values(field, 0..count))
    }

    fn dimension(&self) -> Result<usize, FragmentsError> {
        let dimension = self.converted(self.file.number("/whipple", "dimension"))?;
        let known = (1..=3).find(|&d| d as u64 == dimension);
        known.ok_or_else(|| self.wrong(format!("it is a model of {dimension} dimensions")))
    }

    fn symmetry(&self) -> Result<Vec<SymmetryPlane>, FragmentsError> {
        let planes: Vec<(String, f64)> = self.json("symmetry")?;
        let plane = |(name, position): (String, f64)| {
            let axis = Axis::named(&name);
            let axis = axis.ok_or_else(|| self.wrong("a symmetry plane along no axis"))?;
            Ok(SymmetryPlane { axis, position })
        };
        planes.into_iter().map(plane).collect()
    }

    /// Sizes of the particles of each body at the start.
    fn first_sizes(&self, bodies: usize) -> Result<Vec<FirstSizes>, FragmentsError> {
        let list = |name: &str| {
            let values: Vec<f64> = self.json(name)?;
            let sound = |value: &f64| *value > 0.0 && value.is_finite();
            if values.len() == bodies && values.iter().all(sound) {
                return Ok(values);
            }
            Err(self.wrong(format!(
                "its {name} are not one positive number for each body"
            )))
        };
        let (densities, coarsest) = (list("densities")?, list("coarsest_spacings")?);
        let spacings = list("spacings")?.into_iter();
        let all = spacings.zip(coarsest).zip(densities);
        let sizes = all.map(|((spacing, coarsest), density)| FirstSizes {
            spacing,
            coarsest,
            density,
        });
        Ok(sizes.collect())
    }

    /// The id of each particle, to the last digit.
    fn ids(&self, content: &Content) -> Result<Vec<u64>, FragmentsError> {
        let ids = content.ids("/VTKHDF/PointData/id")?;
        let count = self.file.particles();
        if ids.len() == count {
            return Ok(ids);
        }
        Err(self.wrong(format!("{} ids of {count} particles", ids.len())))
    }

    /// Deformation gradients of all particles; none if the snapshot has none.
    fn deformation(&self) -> Result<Vec<[f64; 9]>, FragmentsError> {
        let field = "deformation_gradient";
        if !self.has(field) {
            return Ok(Vec::new());
        }
        Ok(self.field(field, 9)?.as_chunks::<9>().0.to_vec())
    }

    /// The body of each particle.
    fn body(&self, bodies: usize) -> Result<Vec<u32>, FragmentsError> {
        let index = |value: f64| {
            let known = (0_u32..).take(bodies).find(|&b| f64::from(b) == value);
            known.ok_or_else(|| self.wrong(format!("body {value} of {bodies} bodies")))
        };
        self.field("body", 1)?.into_iter().map(index).collect()
    }
}

pub(super) fn wrong(path: &Path, reason: impl Into<String>) -> FragmentsError {
    FragmentsError::Snapshot {
        path: path.to_owned(),
        reason: reason.into(),
    }
}

impl Loaded {
    /// Reads a snapshot.
    ///
    /// # Errors
    /// [`FragmentsError`] if it cannot be read, lacks masses, or makes no sense.
    pub fn read(path: &Path) -> Result<Self, FragmentsError> {
        let file = SnapshotFile::open(path).map_err(|error| wrong(path, error.to_string()))?;
        let names = file
            .names()
            .map_err(|error| wrong(path, error.to_string()))?;
        let reader = Reader { path, file, names };
        if let Some(part) = reader.converted(reader.file.portion())? {
            return Err(reader.wrong(only_part(&part)));
        }
        for field in ["mass", "velocity"] {
            if !reader.has(field) {
                let what = format!("it does not tell the {field} of its particles");
                return Err(reader.wrong(format!("{what}: name it in `output.fields` of the run")));
            }
        }
        if reader.has("stress_mass") {
            return Err(reader.wrong("it has stress points, which hold the state of the particles"));
        }
        let bodies: Vec<String> = reader.json("bodies")?;
        let first = reader.first_sizes(bodies.len())?;
        let dimension = reader.dimension()?;
        let content = Content::open(path)?;
        let ids = reader.ids(&content)?;
        let case = content
            .text("/whipple/input")
            .map_err(|error| error.to_string());
        let case = case.and_then(|text| read_case(path, &text));
        if case.as_ref().is_ok_and(|case| case.axisymmetric) {
            return Err(
                reader.wrong("its particles are rings about an axis, which are no fragments")
            );
        }
        let body = reader.body(bodies.len())?;
        let mass = reader.field("mass", 1)?;
        let count = reader.file.particles();
        let sizes = mass.iter().zip(&body);
        let sizes = sizes.map(|(&m, &b)| first[b as usize].of(m, dimension));
        let damage = reader.field("damage", 1)?;
        let (temperature, missing) = temperatures(&reader, case.as_ref(), &body, &damage)?;
        let mut loaded = Self {
            title: reader.converted(reader.file.attribute("/whipple", "title"))?,
            time: reader.converted(reader.file.time())?,
            options: case.as_ref().ok().and_then(|case| case.fragments),
            case: case.ok(),
            missing,
            size: sizes.collect(),
            deformation: reader.deformation()?,
            symmetry: reader.symmetry()?,
            position: reader.converted(reader.file.points(0..count))?,
            velocity: reader.field("velocity", 3)?.as_chunks::<3>().0.to_vec(),
            plastic_strain: reader.field("plastic_strain", 1)?,
            dimension,
            bodies,
            ids,
            body,
            mass,
            temperature,
            damage,
        };
        loaded.leave_out(&reader.field("frozen", 1)?);
        Ok(loaded)
    }

    /// Frozen particles are of the model no more.
    fn leave_out(&mut self, frozen: &[f64]) {
        let sizes = self.size.iter_mut().zip(frozen);
        for (size, _) in sizes.filter(|(_, frozen)| **frozen != 0.0) {
            *size = 0.0;
        }
    }

    /// A particle as one of a piece.
    pub fn grain(&self, i: usize, piece: u32) -> Grain {
        Grain {
            centre: self.position[i],
            size: self.size[i],
            deformation: self.deformation.get(i).copied(),
            piece,
        }
    }

    /// Body, mass (kg) and velocity (m/s) of each particle, but for those that are no matter.
    pub fn matter(&self) -> impl Iterator<Item = Option<(usize, f64, [f64; 3])>> {
        let all = self.size.iter().zip(&self.body).zip(&self.mass);
        let all = all.zip(&self.velocity);
        all.map(|(((size, body), mass), velocity)| {
            (*size > 0.0).then_some((*body as usize, *mass, *velocity))
        })
    }

    /// The particles that belong to fragments.
    pub fn included(&self, include: Include) -> Vec<bool> {
        self.damage
            .iter()
            .map(|&damage| belongs(include, damage))
            .collect()
    }

    /// The particles as the search for fragments takes them.
    pub fn particles<'a>(&'a self, included: &'a [bool]) -> Matter<'a> {
        Matter {
            owned: self.ids.len(),
            bodies: self.bodies.len(),
            ids: &self.ids,
            body: &self.body,
            position: &self.position,
            size: &self.size,
            deformation: &self.deformation,
            included,
            mass: &self.mass,
            velocity: &self.velocity,
            temperature: &self.temperature,
            plastic_strain: &self.plastic_strain,
        }
    }
}

/// Temperatures of the snapshot, or else from the case's materials; else NaN, and why.
fn temperatures(
    reader: &Reader,
    case: Result<&Case, &String>,
    body: &[u32],
    damage: &[f64],
) -> Result<(Vec<f64>, Option<String>), FragmentsError> {
    if reader.has("temperature") {
        return Ok((reader.field("temperature", 1)?, None));
    }
    let unknown = |why: String| {
        let text = format!("no temperatures: {why}");
        Ok((vec![f64::NAN; body.len()], Some(text)))
    };
    let case = match case {
        Ok(case) => case,
        Err(why) => return unknown(format!("the snapshot's case cannot be read ({why})")),
    };
    if case
        .materials
        .iter()
        .all(|material| material.thermal.is_none())
    {
        return Ok((vec![f64::NAN; body.len()], None));
    }
    if !(reader.has("density") && reader.has("specific_energy")) {
        return unknown("the snapshot has neither them nor density and specific energy".into());
    }
    let stores = (case.materials.iter()).any(|material| material.stored_share() > 0.0);
    if stores && !reader.has("plastic_energy") {
        return unknown("the snapshot has neither them nor `plastic_energy`".into());
    }
    let (density, energy) = (
        reader.field("density", 1)?,
        reader.field("specific_energy", 1)?,
    );
    let work = if stores {
        reader.field("plastic_energy", 1)?
    } else {
        vec![0.0; body.len()]
    };
    if case.is_porous() && !reader.has("distension") {
        return unknown("the snapshot has neither them nor `distension`".into());
    }
    let distension = if case.is_porous() {
        reader.field("distension", 1)?
    } else {
        vec![0.0; body.len()]
    };
    let of = |i: usize| {
        let body = case.bodies.get(body[i] as usize)?;
        let material = case.materials.get(body.material)?;
        let energy = material.thermal_energy(energy[i], work[i]);
        material.temperature(density[i], energy, [damage[i], distension[i]])
    };
    let values = (0..body.len()).map(|i| of(i).unwrap_or(f64::NAN));
    Ok((values.collect(), None))
}
