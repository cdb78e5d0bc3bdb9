//! The quantity of a particle that a picture draws.

use std::ops::Range;

use super::snapshot::{FROZEN, Snapshot};
use crate::PlotError;
use crate::units::parse_span;
use model::Axis;
use numerics::vector::norm;

/// Components of a vector, in the order of the file.
pub const VECTOR: [&str; 3] = ["x", "y", "z"];

/// Components of a symmetric tensor, in the order of the file, which is VTK's.
pub const SYMMETRIC: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// Components of a tensor, row by row.
pub const TENSOR: [&str; 9] = ["xx", "xy", "xz", "yx", "yy", "yz", "zx", "zy", "zz"];

/// The quantity that colours the particles of a picture.
#[derive(Debug, Clone, PartialEq)]
pub enum Drawn {
    /// The body that a particle belongs to.
    Body,
    /// A number.
    Field(Field),
}

/// A number for each particle, made from a dataset of a snapshot.
#[derive(Debug, Clone, PartialEq)]
pub struct Field {
    dataset: String,
    /// Numbers of the dataset for each particle.
    components: usize,
    pick: Pick,
    /// For the colour bar: `"velocity x"`.
    pub label: String,
    /// Unit of the dataset.
    pub unit: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Pick {
    Component(usize),
    Magnitude,
    VonMises,
    /// A component of −p I + S, made from pressure and deviatoric stress, and that of the stress
    /// by contact with it.
    Stress {
        component: usize,
        contact: bool,
    },
}

impl Drawn {
    /// Finds what `name` means in a snapshot: `body`, a field, or `FIELD.COMPONENT`; `stress` and
    /// `material_stress` are made from their parts.
    ///
    /// # Errors
    /// [`PlotError::Field`] or [`PlotError::Component`] if the snapshot has none of that name, [`PlotError::Read`] if it
    /// cannot be read.
    pub fn find(snapshot: &Snapshot, name: &str) -> Result<Self, PlotError> {
        match name {
            "body" => Ok(Self::Body),
            // A run may write the stress, or only what follows from it.
            "von_mises" if !snapshot.has("deviatoric_stress")? => {
                find(snapshot, "von_mises_stress", None).map(Self::Field)
            }
            "von_mises" => find(snapshot, "deviatoric_stress", Some("von_mises")).map(Self::Field),
            _ => {
                let (dataset, component) = match name.split_once('.') {
                    Some((dataset, component)) => (dataset, Some(component)),
                    None => (name, None),
                };
                let field = match (dataset, component) {
                    ("stress" | "material_stress", Some(component))
                        if !snapshot.has(dataset)? =>
                    {
                        stress(snapshot, dataset, component)
                    }
                    _ => find(snapshot, dataset, component),
                };
                field.map(Self::Field)
            }
        }
    }

    /// Reads the range of colours `LOW:HIGH`, in the unit of the field.
    ///
    /// # Errors
    /// [`PlotError::Quantity`] for another text, [`PlotError::Options`] if there is no field.
    pub fn range(&self, text: Option<&str>) -> Result<Option<[f64; 2]>, PlotError> {
        match (text, self) {
            (None, _) => Ok(None),
            (Some(text), Self::Field(field)) => parse_span(text, None, &field.unit).map(Some),
            (Some(_), Self::Body) => {
                Err(PlotError::Options("--range needs a --field to colour by"))
            }
        }
    }

    /// The drawn number of some rows; the body's index for [`Drawn::Body`] is left to the caller.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the rows cannot be read.
    pub fn values(&self, snapshot: &Snapshot, rows: Range<usize>) -> Result<Vec<f64>, PlotError> {
        match self {
            Self::Body => Ok(vec![0.0; rows.len()]),
            Self::Field(field) => field.values(snapshot, rows),
        }
    }

    /// `true` for rows that have it: none that is frozen, but in a picture of just that; if there
    /// are stress points, these or the particles that have mass.
    ///
    /// # Errors
    /// [`PlotError::Read`] if the rows cannot be read.
    pub fn bearers(&self, snapshot: &Snapshot, rows: Range<usize>) -> Result<Vec<bool>, PlotError> {
        let active = match self {
            Self::Field(field) if field.dataset == FROZEN => vec![true; rows.len()],
            _ => snapshot.active(rows.clone())?,
        };
        if !snapshot.has(STRESS_MASS)? {
            return Ok(active);
        }
        let of_points = match self {
            Self::Body => false,
            Self::Field(field) => OF_STRESS_POINTS.contains(&field.dataset.as_str()),
        };
        let masses = snapshot.file.scalar(STRESS_MASS, 0, rows)?;
        let bears = |(mass, active): (f64, bool)| active && (mass > 0.0) == of_points;
        Ok(masses.into_iter().zip(active).map(bears).collect())
    }
}

/// Stress by contact forces.
const CONTACT_STRESS: &str = "contact_stress";
/// The field that separates stress points from particles.
const STRESS_MASS: &str = "stress_mass";
/// The fields of stress points, if there are any.
const OF_STRESS_POINTS: [&str; 16] = [
    "density",
    "pressure",
    "deviatoric_stress",
    "plastic_strain",
    "damage",
    "failure_energy",
    "compaction",
    "distension",
    "burn",
    "lighting_time",
    "specific_energy",
    "sound_speed",
    "velocity_gradient",
    "von_mises_stress",
    "temperature",
    STRESS_MASS,
];

impl Field {
    /// `true` if its value changes sign in a mirror normal to an axis.
    pub fn flips(&self, axis: Axis) -> bool {
        let letter = axis.name();
        let name = match self.pick {
            Pick::Component(k) => match self.components {
                3 => VECTOR[k],
                6 => SYMMETRIC[k],
                9 => TENSOR[k],
                _ => "",
            },
            Pick::Stress { component, .. } => SYMMETRIC[component],
            Pick::Magnitude | Pick::VonMises => "",
        };
        name.matches(letter).count() == 1
    }

    fn values(&self, snapshot: &Snapshot, rows: Range<usize>) -> Result<Vec<f64>, PlotError> {
        match self.pick {
            Pick::Component(k) => Ok(snapshot.file.scalar(&self.dataset, k, rows)?),
            Pick::Magnitude => {
                let values = snapshot.file.values(&self.dataset, rows)?;
                Ok(values.as_chunks::<3>().0.iter().map(norm).collect())
            }
            Pick::VonMises => {
                let values = snapshot.file.values(&self.dataset, rows)?;
                Ok(values.as_chunks::<6>().0.iter().map(von_mises).collect())
            }
            Pick::Stress { component, contact } => {
                let part = |name, k| snapshot.file.scalar(name, k, rows.clone());
                let mut values = part(&self.dataset, component)?;
                if component < 3 {
                    for (value, p) in values.iter_mut().zip(part("pressure", 0)?) {
                        *value -= p;
                    }
                }
                if contact {
                    for (value, more) in values.iter_mut().zip(part(CONTACT_STRESS, component)?) {
                        *value += more;
                    }
                }
                Ok(values)
            }
        }
    }
}

fn find(snapshot: &Snapshot, dataset: &str, part: Option<&str>) -> Result<Field, PlotError> {
    let names = snapshot.file.names()?;
    if !names.iter().any(|name| name == dataset) {
        return Err(PlotError::Field {
            name: dataset.to_owned(),
            nearest: nearest(dataset, &names),
            known: names,
        });
    }
    let width = snapshot.file.components(dataset)?;
    let words = dataset.replace('_', " ");
    let among = |known: &[&str], part: &str| known.iter().position(|&k| k == part);
    let component = match (width, part) {
        (1, None) => Some((Pick::Component(0), words)),
        (3, None | Some("magnitude")) => Some((Pick::Magnitude, format!("{words} magnitude"))),
        (3, Some(part)) => {
            among(&VECTOR, part).map(|k| (Pick::Component(k), format!("{words} {part}")))
        }
        (6, Some("von_mises")) => Some((Pick::VonMises, von_mises_label(dataset, &words))),
        (6, Some(part)) => {
            among(&SYMMETRIC, part).map(|k| (Pick::Component(k), format!("{words} {part}")))
        }
        (9, Some(part)) => {
            among(&TENSOR, part).map(|k| (Pick::Component(k), format!("{words} {part}")))
        }
        _ => None,
    };
    let (pick, label) = component.ok_or_else(|| PlotError::Component {
        field: dataset.to_owned(),
        component: part.map(str::to_owned),
        known: match width {
            1 => "none: it is a scalar".to_owned(),
            3 => format!("{}, magnitude", VECTOR.join(", ")),
            6 => format!("{}, von_mises", SYMMETRIC.join(", ")),
            9 => TENSOR.join(", "),
            _ => format!("{width} components, which plot does not know"),
        },
    })?;
    Ok(Field {
        dataset: dataset.to_owned(),
        components: width,
        pick,
        label,
        unit: snapshot.file.field_attribute(dataset, "unit")?,
    })
}

/// A component of a stress, tension positive: of the material stress −p I + S, or of the total
/// stress, with that of contact if the snapshot has it. Stress points have no contact.
fn stress(snapshot: &Snapshot, name: &str, part: &str) -> Result<Field, PlotError> {
    find(snapshot, "pressure", None)?;
    let unknown = || PlotError::Component {
        field: name.to_owned(),
        component: Some(part.to_owned()),
        known: SYMMETRIC.join(", "),
    };
    let component = SYMMETRIC.iter().position(|&known| known == part);
    let component = component.ok_or_else(unknown)?;
    let deviator = find(snapshot, "deviatoric_stress", Some(part))?;
    let contact =
        name == "stress" && snapshot.has(CONTACT_STRESS)? && !snapshot.has(STRESS_MASS)?;
    Ok(Field {
        pick: Pick::Stress { component, contact },
        label: format!("{} {part}", name.replace('_', " ")),
        ..deviator
    })
}

fn von_mises_label(dataset: &str, words: &str) -> String {
    if dataset.ends_with("stress") {
        "von Mises stress".to_owned()
    } else {
        format!("von Mises {words}")
    }
}

/// √(3/2 S:S) of the deviatoric part S of a stress: the uniaxial stress of equal distortion.
fn von_mises(t: &[f64; 6]) -> f64 {
    let [xx, yy, zz, xy, yz, xz] = *t;
    let mean = (xx + yy + zz) / 3.0;
    let normal = (xx - mean).powi(2) + (yy - mean).powi(2) + (zz - mean).powi(2);
    let shear = xy * xy + yz * yz + xz * xz;
    (1.5 * (normal + 2.0 * shear)).sqrt()
}

/// The known name that shares the most pairs of letters with a mistyped one.
fn nearest(name: &str, known: &[String]) -> Option<String> {
    let pairs =
        |word: &str| -> Vec<(char, char)> { word.chars().zip(word.chars().skip(1)).collect() };
    let wanted = pairs(name);
    let share = |candidate: &String| {
        let other = pairs(candidate);
        let common = wanted.iter().filter(|pair| other.contains(pair)).count();
        2 * 100 * common / (wanted.len() + other.len()).max(1)
    };
    let best = known.iter().max_by_key(|candidate| share(candidate))?;
    (share(best) >= 50).then(|| best.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn von_mises_is_the_stress_of_the_tensile_test() {
        assert!((von_mises(&[3.0, 0.0, 0.0, 0.0, 0.0, 0.0]) - 3.0).abs() < 1e-14);
        assert!((von_mises(&[2.0, -1.0, -1.0, 0.0, 0.0, 0.0]) - 3.0).abs() < 1e-14);
        assert!(von_mises(&[5.0, 5.0, 5.0, 0.0, 0.0, 0.0]) < 1e-14);
        let shear = von_mises(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
        assert!((shear - 3.0_f64.sqrt()).abs() < 1e-14);
    }

    #[test]
    fn a_typing_error_finds_its_field() {
        let known = ["density", "pressure", "velocity"].map(String::from);
        assert_eq!(nearest("presure", &known).as_deref(), Some("pressure"));
        assert_eq!(nearest("q", &known), None);
    }
}
