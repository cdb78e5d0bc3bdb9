//! Physical mistakes of a case as a whole.

use super::approach::{Approach, flies_straight};
use model::readable::shown;
use model::{Body, Case, ContactMode};

/// Fewer particles than this across the thinnest section resolve no bending and no wave.
const ACROSS: f64 = 6.0;
/// Layers of yarns or walls, and those of a mass for their area, bend without waves.
const ACROSS_LAYER: f64 = 3.0;
/// Fewer than this across what strikes in three dimensions give rough figures.
const ACROSS_PROJECTILE: f64 = 10.0;
/// A stiffness of contact this many times above or below its default is a mistake.
const FAR: f64 = 10.0;

/// Bodies that meet without contact, and a run that ends before anything meets.
pub fn meetings(case: &Case, approaches: &[Approach], messages: &mut Vec<String>) {
    let end = case.run.end_time;
    let names = |pair: &Approach| pair.bodies.map(|body| case.bodies[body].name.as_str());
    for pair in approaches.iter().filter(|pair| pair.time < end) {
        let [a, b] = pair.bodies;
        if matches!(case.contact_between(a, b), ContactMode::None) {
            let [a, b] = names(pair);
            messages.push(format!(
                "`{a}` and `{b}` meet at {} and have contact of mode \"none\": they pass through \
                 each other",
                seconds(pair.time)
            ));
        }
    }
    let late = approaches
        .iter()
        .filter(|pair| pair.time.is_finite() && pair.time >= end);
    let last = late.max_by(|a, b| a.time.total_cmp(&b.time));
    if let Some(pair) = last.filter(|_| approaches.iter().any(|pair| pair.time < end)) {
        let [a, b] = names(pair);
        messages.push(format!(
            "`run.end_time` is {}, before `{a}` can reach `{b}` at {}: a verdict on what is struck comes later",
            seconds(end),
            seconds(pair.time)
        ));
    }
    // Bodies that are driven, fall or meet their mirror images move without an impact.
    let free = case.bodies.iter().filter(|body| body.is_free()).count();
    let acting = case.load_names().count() - case.loads.absorbers.len() - free;
    let driven = acting > 0;
    let straight = (0..case.bodies.len()).all(|body| flies_straight(case, body));
    let towards_mirror = case.symmetry.iter().any(|plane| {
        let bodies = case.bodies.iter();
        bodies
            .into_iter()
            .any(|body| body.velocity[plane.axis.index()] < 0.0)
    });
    // What deforms differs in velocity from another body if any two do.
    let mut velocities = case.bodies.iter().map(|body| body.velocity);
    let first = velocities.next();
    let moves = velocities.any(|velocity| Some(velocity) != first)
        && case.bodies.iter().any(|body| body.driven().is_none());
    if driven || !straight || towards_mirror || !moves {
        return;
    }
    let first = approaches
        .iter()
        .min_by(|a, b| a.time.total_cmp(&b.time))
        .filter(|pair| pair.time.is_finite());
    let Some(pair) = first else {
        messages.push("nothing meets: no body flies towards another".to_owned());
        return;
    };
    if pair.time >= end {
        let [a, b] = names(pair);
        messages.push(format!(
            "nothing meets: `{a}` reaches `{b}`, {:.1} spacings away, at {}, after the end at {}",
            pair.gap,
            seconds(pair.time),
            seconds(end)
        ));
    }
}

/// Particles across the thinnest part of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Across {
    /// The body's index.
    pub body: usize,
    /// Particles across its thinnest part.
    pub particles: f64,
    /// The least that its figures need.
    pub least: f64,
}

impl Across {
    /// True if there are too few; rounding may add or remove a layer.
    #[must_use]
    pub fn is_thin(&self) -> bool {
        self.particles < self.least - 0.01
    }
}

/// Particles across each body that deforms.
#[must_use]
pub fn across(case: &Case, approaches: &[Approach]) -> Vec<Across> {
    let mut meets = vec![false; case.bodies.len()];
    for pair in approaches
        .iter()
        .filter(|pair| pair.time < case.run.end_time)
    {
        for body in pair.bodies {
            meets[body] = true;
        }
    }
    // In the total form few particles bend as many do.
    let strikes = |index: usize, body: &Body| {
        case.dimension == 3 && meets[index] && !body.total && body.velocity.norm() > 0.0
    };
    let bodies = case.bodies.iter().enumerate();
    bodies
        .filter(|(_, body)| body.rigid.is_none())
        .map(|(index, body)| Across {
            body: index,
            particles: thickness(body, case) / body.lattice.spacing,
            least: if body.layer || case.materials[body.material].has_members() {
                ACROSS_LAYER
            } else if strikes(index, body) {
                ACROSS_PROJECTILE
            } else {
                ACROSS
            },
        })
        .collect()
}

/// Bodies with too few particles across.
pub fn thin_sections(case: &Case, approaches: &[Approach], messages: &mut Vec<String>) {
    for across in across(case, approaches)
        .iter()
        .filter(|across| across.is_thin())
    {
        let reason = if across.least > ACROSS {
            "of what strikes give rough figures"
        } else {
            "resolve neither waves nor bending"
        };
        messages.push(format!(
            "`{}` has {:.1} particles across its thinnest part; fewer than {} {reason}: make its spacing finer",
            case.bodies[across.body].name, across.particles, across.least
        ));
    }
}

/// Thickness of the thinnest section (m), mirror images behind symmetry planes included.
pub(super) fn thickness(body: &Body, case: &Case) -> f64 {
    let mut shape = body.shape.clone();
    if let model::Shape::Box { lower, upper } = &mut shape {
        for plane in &case.symmetry {
            let a = plane.axis.index();
            if lower[a] <= plane.position + 0.5 * body.lattice.spacing {
                lower[a] = 2.0 * plane.position - upper[a];
            }
        }
    }
    shape.thickness(case.dimension)
}

/// Contact far stiffer or softer than the materials.
pub fn stiffness(case: &Case, messages: &mut Vec<String>) {
    let modes = std::iter::once(&case.default_contact).chain(case.contacts.iter().map(|p| &p.mode));
    let defaults = ContactMode::with_forces();
    let mut reported: Vec<(&str, f64)> = Vec::new();
    for mode in modes {
        let default = mode.class().map(|class| &defaults[class as usize]);
        let (Some(law), Some(default)) = (mode.law(), default.and_then(ContactMode::law)) else {
            continue;
        };
        let (stiffness, default_stiffness) = (law.stiffness(), default.stiffness());
        let name = mode.name();
        if (default_stiffness / FAR..=default_stiffness * FAR).contains(&stiffness)
            || reported.contains(&(name, stiffness))
        {
            continue;
        }
        reported.push((name, stiffness));
        let what = if stiffness > default_stiffness {
            "stiffer than the materials, and small steps are its price"
        } else {
            "softer than the materials, so that bodies sink into each other"
        };
        messages.push(format!(
            "`contact.{name}.stiffness` is {stiffness}, {:.0} times {}its default of {default_stiffness}: contact \
             is {what}",
            (stiffness / default_stiffness).max(default_stiffness / stiffness),
            if stiffness > default_stiffness { "" } else { "below " },
        ));
    }
}

/// Gases without any pressure by which rigid surfaces could push them.
pub fn soft_gases(case: &Case, messages: &mut Vec<String>) {
    for (index, body) in case.bodies.iter().enumerate() {
        let is_held = case
            .loads
            .surfaces
            .iter()
            .any(|surface| surface.bodies[index]);
        if is_held && body.driven().is_none() && case.contact_modulus(body) <= 0.0 {
            messages.push(format!(
                "`{}` is a gas without pressure, and rigid surfaces push with a gas's modulus at its reference pressure or \
                 that of the start: it passes through them; give its `eos.ideal_gas` a `reference_pressure`",
                body.name
            ));
        }
    }
}

fn seconds(time: f64) -> String {
    shown(time, "s")
}
