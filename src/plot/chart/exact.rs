//! The cases with an exact answer, recognised in the resolved input of a run.
//!
//! To add another case: a variant of [`Exact`], a way to recognise it in [`Exact::of`], its
//! [`Profile`], and a word in [`KNOWN`] and in the guide.

use std::path::Path;

use crate::PlotError;
use exact::bars::{Bar, End, Row, Waves};
use exact::hugoniot::Medium;
use exact::plates::{self, Plate};
use exact::riemann::{Gas, Riemann};
use exact::{Profile, Sample, finite_strain};
use material::{Eos, Material, Strength};
use model::{Body, Case, ContactMode, Motion, Shape, VelocityLoad};
use results::Opener;

/// The cases with an answer.
const KNOWN: &str = "an exact answer is known for one-dimensional runs of linear elastic bars \
    that meet, whose outer ends may be moved at steps of velocity, and of two plates of \
    Mie-Grüneisen materials with strength = \"none\" until a shock reaches a free face, and of two \
    bodies of one ideal gas in touch, or one at a symmetry plane, until their waves meet those of \
    the ends";

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
    /// Elastic bars in a row.
    Bars(Row),
    /// Two plates, left and right.
    Plates([Plate; 2]),
    /// Two bodies of gas: where they touch (m), and their far ends and whether these are held.
    Gas(Riemann, f64, [(f64, bool); 2]),
    /// Gas above a symmetry plane (m), which is half of the same with its mirror image.
    GasAtWall(Riemann, f64, [(f64, bool); 2]),
}

/// A body as a stretch of the x axis.
#[derive(Clone, Copy)]
struct Segment<'a> {
    body: &'a Body,
    /// Index of the body.
    index: usize,
    /// Initial density (kg/m³).
    density: f64,
    /// Initial specific energy (J/kg).
    energy: f64,
    material: &'a Material,
    /// Smallest and largest coordinate (m).
    ends: [f64; 2],
}

impl Exact {
    /// The answer for the run that wrote a snapshot, from the `case.toml` of its folder.
    pub fn of_run(opener: &dyn Opener, snapshot: &Path) -> Result<Self, PlotError> {
        let folder = snapshot.parent().and_then(Path::parent);
        let path = folder.unwrap_or(Path::new(".")).join("case.toml");
        let unknown = |reason: String| PlotError::Exact { reason };
        let case = opener.case(&path).map_err(unknown)?;
        Self::of(&case).map_err(|reason| unknown(format!("{reason}; {KNOWN}")))
    }

    /// The answer for a case, or what it has that no answer covers.
    fn of(case: &Case) -> Result<Self, String> {
        let mut segments = segments(case)?;
        if case.loads.has_gravity() || !case.loads.surfaces.is_empty() {
            return Err("there is gravity or a rigid surface".to_owned());
        }
        if !case.loads.pressures.is_empty() || case.loads.relaxation.is_some() {
            return Err("there is a pressure on a face or a relaxation".to_owned());
        }
        if case
            .bodies
            .iter()
            .any(|body| body.initial.loading.is_some())
        {
            return Err("a body begins under a stress".to_owned());
        }
        if !case.loads.absorbers.is_empty() {
            return Err("there is an absorbing zone".to_owned());
        }
        let ends = outer_ends(case, &mut segments)?;
        if let Some(bars) = segments.iter().map(bar).collect() {
            return Ok(Self::Bars(Row { bars, ends }));
        }
        if let Some(gases) = segments.iter().map(gas).collect::<Option<Vec<_>>>() {
            return two_gases(&segments, &gases, &ends);
        }
        if ends.iter().any(|end| *end != End::Free) {
            return Err("plates are held or moved".to_owned());
        }
        let plates = segments.iter().map(plate).collect::<Result<Vec<_>, _>>()?;
        match plates[..] {
            [left, right] => Ok(Self::Plates([left, right])),
            _ => Err(format!("there are {} plates", plates.len())),
        }
    }

    /// The states at a time (s), where the material is then.
    pub fn profile(&self, time: f64) -> Result<Profile, PlotError> {
        match self {
            Self::Bars(row) => Ok(Waves::new(row, time).profile()),
            Self::Plates([left, right]) => plates::profile([left, right], time).map_err(|past| {
                let since = 1e6 * past.since;
                let reason = format!("a shock has reached a free face at {since:.3} us; {KNOWN}");
                PlotError::Exact { reason }
            }),
            Self::Gas(riemann, origin, ends) => {
                gas_profile(riemann, *origin, *ends, f64::NEG_INFINITY, time)
            }
            Self::GasAtWall(riemann, wall, ends) => gas_profile(riemann, *wall, *ends, *wall, time),
        }
    }
}

/// Two bodies of one gas in touch, their far ends free or moved as the gas there moves.
fn two_gases(segments: &[Segment], gases: &[(f64, Gas)], ends: &[End; 2]) -> Result<Exact, String> {
    if let (&[segment], &[(gamma, gas)]) = (segments, gases) {
        return gas_at_wall(&segment, gamma, gas, ends);
    }
    let (&[left, right], &[(gamma, a), (other, b)]) = (segments, gases) else {
        return Err(format!("there are {} bodies of gas", segments.len()));
    };
    let gap = right.ends[0] - left.ends[1];
    if gap.abs() > 1e-6 * left.body.lattice.spacing || gamma != other {
        return Err("the bodies are of two gases or not in touch".to_owned());
    }
    let riemann = Riemann::new(gamma, a, b).ok_or("a vacuum opens between the gases")?;
    let held = |k: usize| match &ends[k] {
        End::Free => Ok(false),
        End::Moved(steps) if steps[..] == [(0.0, Some(riemann.sides[k].velocity))] => Ok(true),
        End::Moved(_) => Err("an end of the gas moves unlike the gas"),
    };
    let far = [(left.ends[0], held(0)?), (right.ends[1], held(1)?)];
    Ok(Exact::Gas(riemann, left.ends[1], far))
}

/// Gas whose near end is at a symmetry plane and whose far end is free.
fn gas_at_wall(segment: &Segment, gamma: f64, gas: Gas, ends: &[End; 2]) -> Result<Exact, String> {
    let at_rest = End::Moved(vec![(0.0, Some(0.0))]);
    if *ends != [at_rest, End::Free] {
        return Err("the gas has no wall, or its far end is held".to_owned());
    }
    let image = Gas {
        velocity: -gas.velocity,
        ..gas
    };
    let riemann = Riemann::new(gamma, image, gas).ok_or("a vacuum opens at the wall")?;
    let [wall, far] = segment.ends;
    let ends = [(2.0 * wall - far, false), (far, false)];
    Ok(Exact::GasAtWall(riemann, wall, ends))
}

/// The ratio of specific heats and the initial state of an ideal gas.
fn gas(segment: &Segment) -> Option<(f64, Gas)> {
    let Eos::IdealGas(eos) = &segment.material.eos else {
        return None;
    };
    let inviscid = matches!(segment.material.strength, Strength::None);
    let ideal = eos.stiffening_pressure == 0.0 && segment.material.failure.is_none();
    let gas = Gas {
        density: segment.density,
        velocity: segment.body.velocity.x,
        pressure: eos.response(segment.density, segment.energy).pressure,
    };
    (inviscid && ideal).then_some((eos.gamma, gas))
}

/// The states of two gases until their waves meet the far ends, or the waves from free ones; those
/// have the speed of sound, and nothing is drawn behind them; from a position (m) on.
fn gas_profile(
    riemann: &Riemann,
    origin: f64,
    ends: [(f64, bool); 2],
    from: f64,
    time: f64,
) -> Result<Profile, PlotError> {
    let undisturbed = |k: usize, sign: f64| {
        let (gas, (end, held)) = (&riemann.sides[k], ends[k]);
        let sound = (riemann.gamma * gas.pressure / gas.density).sqrt();
        end + (gas.velocity + if held { 0.0 } else { sign * sound }) * time
    };
    let span = [undisturbed(0, 1.0), undisturbed(1, -1.0)];
    let waves = riemann.waves().map(|wave| origin + wave[0] * time);
    let apart = span[0] <= waves[0] && waves[1] <= span[1];
    if apart {
        let visible = [span[0].max(from), span[1]];
        return Ok(vec![riemann.profile(origin, time, visible)]);
    }
    let reason = format!("a wave has met an end or what comes from there; {KNOWN}");
    Err(PlotError::Exact { reason })
}

/// The bodies of a one-dimensional case from left to right, if each sees all others.
fn segments(case: &Case) -> Result<Vec<Segment<'_>>, String> {
    if case.dimension != 1 {
        return Err(format!("the case has {} dimensions", case.dimension));
    }
    let mut segments = Vec::new();
    for (index, body) in case.bodies.iter().enumerate() {
        let Shape::Box { lower, upper } = &body.shape else {
            return Err(format!("body \"{}\" is no box", body.name));
        };
        if body.rigid.is_some() {
            return Err(format!("body \"{}\" is rigid", body.name));
        }
        let unseen = |other: usize| *case.contact_between(index, other) == ContactMode::None;
        if (0..index).any(unseen) {
            return Err("bodies do not see each other".to_owned());
        }
        segments.push(Segment {
            body,
            index,
            density: case.initial_density(body),
            energy: case.initial_energy(body),
            material: &case.materials[body.material],
            ends: [lower.x, upper.x],
        });
    }
    segments.sort_by(|a, b| a.ends[0].total_cmp(&b.ends[0]));
    Ok(segments)
}

/// The supports of the outer ends; cuts the segments at a symmetry plane and at moved particles.
fn outer_ends(case: &Case, segments: &mut [Segment]) -> Result<[End; 2], String> {
    let mut ends = [End::Free, End::Free];
    let last = segments.len() - 1;
    if let Some(plane) = case.symmetry.first().map(|plane| plane.position)
        && plane >= segments[0].ends[0]
    {
        segments[0].ends[0] = plane;
        ends[0] = End::Moved(vec![(0.0, Some(0.0))]);
    }
    for load in case.loads.velocities.iter().filter(|l| l.motion.has(0)) {
        let steps = End::Moved(steps(load)?);
        let [first, second] = [&segments[0], &segments[last]].map(|segment| moved(segment, load));
        match (first, second) {
            (Some([None, Some(edge)]), _) => (segments[0].ends[0], ends[0]) = (edge, steps),
            (_, Some([Some(edge), None])) => (segments[last].ends[1], ends[1]) = (edge, steps),
            _ => {
                return Err(format!(
                    "load \"{}\" moves more than an outer end",
                    load.name
                ));
            }
        }
    }
    Ok(ends)
}

/// A linear elastic bar.
fn bar(segment: &Segment) -> Option<Bar> {
    let medium = finite_strain::Medium::of(segment.material)?;
    (segment.density == medium.reference_density).then_some(Bar {
        medium,
        left: segment.ends[0],
        length: segment.ends[1] - segment.ends[0],
        velocity: segment.body.velocity.x,
    })
}

/// The outermost particles (m) that a load moves in a part, left and right; absent on a side
/// where these are the part's own outermost. Nothing if the load moves none. A bar with a moved
/// end begins at the last particle that is moved.
fn moved(segment: &Segment, load: &VelocityLoad) -> Option<[Option<f64>; 2]> {
    if load.body != segment.index {
        return None;
    }
    let spacing = segment.body.lattice.spacing;
    let first = segment.ends[0] + 0.5 * spacing;
    let count = ((segment.ends[1] - segment.ends[0]) / spacing).round();
    let position = |k: f64| first + k * spacing;
    let low = ((load.region.above[0] - first) / spacing - 1e-6)
        .ceil()
        .max(0.0);
    let high = ((load.region.below[0] - first) / spacing + 1e-6)
        .floor()
        .min(count - 1.0);
    let low_end = (low > 0.0).then(|| position(low));
    let high_end = (high < count - 1.0).then(|| position(high));
    (low <= high).then_some([low_end, high_end])
}

/// The velocity of a load as steps of time.
fn steps(load: &VelocityLoad) -> Result<Vec<(f64, Option<f64>)>, String> {
    let motion: &Motion = &load.motion;
    let values = motion.velocities[0].as_deref().unwrap_or_default();
    let mut steps = vec![(0.0, Some(motion.velocity(0, 0.0)))];
    for (times, pair) in motion.times.windows(2).zip(values.windows(2)) {
        if pair[0] == pair[1] {
            continue;
        }
        if times[0] < times[1] {
            return Err(format!("the velocity of load \"{}\" has a ramp", load.name));
        }
        if times[0] > 0.0 {
            steps.push((times[0], Some(pair[1])));
        }
    }
    steps.retain(|step| step.0 < load.until);
    if load.until.is_finite() {
        steps.push((load.until, None));
    }
    Ok(steps)
}

fn plate(segment: &Segment) -> Result<Plate, String> {
    let fluid =
        matches!(segment.material.strength, Strength::None) && segment.material.failure.is_none();
    let medium = Medium::of(segment.material).filter(|_| fluid);
    let unknown = || {
        format!(
            "the material of body \"{}\" has more than that",
            segment.body.name
        )
    };
    Ok(Plate {
        medium: medium.ok_or_else(unknown)?,
        left: segment.ends[0],
        length: segment.ends[1] - segment.ends[0],
        velocity: segment.body.velocity.x,
    })
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
