//! Which cases have an exact answer, found from the resolved input of a run.
//!
//! To teach plots another case: a variant of [`Exact`], a way to recognise it in [`Exact::of`],
//! and its [`Profile`].

use std::path::Path;

use super::PlotError;
use crate::exact::elastic::{Bar, End, Joint, Row, Waves};
use crate::exact::hugoniot::Medium;
use crate::exact::plates::{self, Plate};
use crate::exact::{Profile, Sample, finite_strain};
use crate::input;
use crate::material::{Material, Strength};
use crate::model::{Body, Case, ContactMode, Shape};

/// What has an answer.
const KNOWN: &str = "an exact answer is known for one-dimensional runs of linear elastic bars \
    that meet, and of two plates of Mie-Grüneisen materials with strength = \"none\" until a shock \
    reaches a free face";

/// Fields that an answer has, as they are usually called.
pub const FIELDS: [&str; 7] = [
    "velocity.x",
    "density",
    "pressure",
    "specific_energy",
    "stress.xx",
    "deviatoric_stress.xx",
    "von_mises",
];

/// A case with an exact answer.
#[derive(Debug, Clone)]
pub enum Exact {
    /// Elastic bars in a row, each with the bulk share K/M of its stress.
    Bars(Row, Vec<f64>),
    /// Two plates, left and right.
    Plates([Plate; 2]),
}

impl Exact {
    /// The answer for the run that wrote a snapshot, from the `case.toml` of its folder.
    pub fn of_run(snapshot: &Path) -> Result<Self, PlotError> {
        let folder = snapshot.parent().and_then(Path::parent);
        let path = folder.unwrap_or(Path::new(".")).join("case.toml");
        let unknown = |reason: String| PlotError::Exact { reason };
        let case = input::load(&path, &[]).map_err(|e| unknown(e.to_string()))?;
        Self::of(&case).map_err(|reason| unknown(format!("{reason}; {KNOWN}")))
    }

    /// The answer for a case.
    ///
    /// # Errors
    /// What the case has that no answer covers.
    pub fn of(case: &Case) -> Result<Self, String> {
        if case.dimension != 1 {
            return Err(format!("the case has {} dimensions", case.dimension));
        }
        let mut bodies: Vec<(&Body, [f64; 2])> = Vec::new();
        for body in &case.bodies {
            let Shape::Box { lower, upper } = &body.shape else {
                return Err(format!("body \"{}\" is no box", body.name));
            };
            bodies.push((body, [lower.x, upper.x]));
        }
        for a in 0..case.bodies.len() {
            for b in 0..a {
                if matches!(case.contact_between(a, b), ContactMode::None) {
                    return Err("bodies do not see each other".to_owned());
                }
            }
        }
        bodies.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        let plane = case.symmetry.first().map(|plane| plane.position);
        if let (Some(plane), Some(first)) = (plane, bodies.first_mut()) {
            first.1[0] = first.1[0].max(plane);
        }
        let held = plane.is_some_and(|plane| bodies.first().is_some_and(|b| b.1[0] == plane));
        let material = |body: &Body| &case.materials[body.material];
        if bodies
            .iter()
            .all(|(body, _)| finite_strain::Medium::of(material(body)).is_some())
        {
            return Ok(bars(&bodies, material, held));
        }
        two_plates(&bodies, material, held)
    }

    /// What the answer assumes, for the picture.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Bars(..) => "exact, linear elastic",
            Self::Plates(_) => "exact",
        }
    }

    /// The states at a time (s), where the material is then.
    pub fn profile(&self, time: f64) -> Result<Profile, PlotError> {
        match self {
            Self::Bars(row, shares) => Ok(bar_profile(row, shares, time)),
            Self::Plates([left, right]) => plates::profile([left, right], time).map_err(|past| {
                let since = 1e6 * past.since;
                let reason = format!("a shock has reached a free face at {since:.3} us; {KNOWN}");
                PlotError::Exact { reason }
            }),
        }
    }
}

fn bars<'a>(
    bodies: &[(&Body, [f64; 2])],
    material: impl Fn(&Body) -> &'a Material,
    held: bool,
) -> Exact {
    let bar = |(body, ends): &(&Body, [f64; 2])| Bar {
        modulus: material(body).p_wave_modulus(),
        density: material(body).reference_density,
        left: ends[0],
        length: ends[1] - ends[0],
        velocity: body.velocity.x,
    };
    let share = |(body, _): &(&Body, [f64; 2])| {
        let material = material(body);
        material.eos.bulk_modulus(material.reference_density) / material.p_wave_modulus()
    };
    let left = if held {
        End::Moved(vec![(0.0, 0.0)])
    } else {
        End::Free
    };
    let row = Row {
        bars: bodies.iter().map(bar).collect(),
        joints: vec![Joint::Contact; bodies.len() - 1],
        ends: [left, End::Free],
    };
    Exact::Bars(row, bodies.iter().map(share).collect())
}

fn two_plates<'a>(
    bodies: &[(&Body, [f64; 2])],
    material: impl Fn(&Body) -> &'a Material,
    held: bool,
) -> Result<Exact, String> {
    let plate = |(body, ends): &(&Body, [f64; 2])| {
        let material = material(body);
        let fluid = matches!(material.strength, Strength::None) && material.spall.is_none();
        let medium = Medium::of(material)
            .filter(|_| fluid)
            .ok_or_else(|| format!("the material of body \"{}\" has more than that", body.name))?;
        Ok(Plate {
            medium,
            left: ends[0],
            length: ends[1] - ends[0],
            velocity: body.velocity.x,
        })
    };
    let plates = bodies
        .iter()
        .map(plate)
        .collect::<Result<Vec<_>, String>>()?;
    match plates[..] {
        [left, right] if !held => Ok(Exact::Plates([left, right])),
        _ => Err("there are not two free plates".to_owned()),
    }
}

/// Elastic waves as states; lengths and densities to first order in the strain, as the waves.
fn bar_profile(row: &Row, shares: &[f64], time: f64) -> Profile {
    let waves = Waves::new(row, time);
    let mut lines = vec![Vec::new(); row.bars.len()];
    for piece in waves.profile(time) {
        let bar = &row.bars[piece.bar];
        let (stress, share) = (piece.state.stress, shares[piece.bar]);
        let strain = stress / bar.modulus;
        lines[piece.bar].extend([piece.from, piece.to].map(|x| Sample {
            position: x + waves.displacement(piece.bar, x - bar.left, time),
            velocity: piece.state.velocity,
            density: bar.density * (1.0 - strain),
            pressure: -stress * share,
            deviatoric_stress: stress * (1.0 - share),
            specific_energy: 0.5 * stress * strain / bar.density,
        }));
    }
    lines
}

/// The number of a sample that a field along x shows; `None` for fields without exact answer.
pub fn value(field: &str, sample: &Sample) -> Option<f64> {
    let deviator = sample.deviatoric_stress;
    Some(match field {
        "velocity.x" => sample.velocity,
        "velocity" | "velocity.magnitude" => sample.velocity.abs(),
        "density" => sample.density,
        "pressure" => sample.pressure,
        "specific_energy" => sample.specific_energy,
        "stress.xx" => sample.stress(),
        "stress.yy" | "stress.zz" => -0.5 * deviator - sample.pressure,
        "deviatoric_stress.xx" => deviator,
        "deviatoric_stress.yy" | "deviatoric_stress.zz" => -0.5 * deviator,
        "von_mises" | "deviatoric_stress.von_mises" | "von_mises_stress" => 1.5 * deviator.abs(),
        _ => return None,
    })
}
