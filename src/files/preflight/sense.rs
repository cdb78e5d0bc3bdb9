//! Values that are allowed but make no sense in a run.

use super::approach::{Approach, flies_straight};
use super::steps::expected_step;
use material::AfterSpall;
use model::readable::{short, shown};
use model::{Body, Case, ContactMode, LatticeKind, Resistance, Shape, SphForm};
use populate;

/// Dry rubber has about 1, clean metals in vacuum some 2 before they weld.
const MOST_FRICTION: f64 = 2.0;
/// Viscosity is 1 or 2 in most publications, and shortens the step in proportion.
const MOST_VISCOSITY: f64 = 10.0;
/// Spacings of two bodies in contact over each other: at 3 the mean smoothing length is .87 of the
/// wider spacing (h = 1.3 Δp), and sums over the wide particles begin to show each of them.
const MOST_RATIO: f64 = 3.0;
/// More steps than any run takes.
const MOST_STEPS: f64 = 1e9;
/// A box may miss a whole number of spacings by rounding (spacings).
const ROUNDING: f64 = 0.01;
/// Bodies nearer to each other begin in touch (mean spacings).
const TOUCH: f64 = 0.1;

/// Faster spheres (m/s) burst at plates.
const BURSTS: f64 = 2e3;

/// A relaxation that leaves more than this of vibrations is too short.
const MOST_LEFT: f64 = 0.02;

/// One line for each.
pub fn warnings(case: &Case, approaches: &[Approach], messages: &mut Vec<String>) {
    unused_materials(case, messages);
    unbearing_materials(case, messages);
    for body in &case.bodies {
        messages.extend(box_size(body, case));
    }
    pairs(case, approaches, messages);
    coefficients(case, messages);
    weight_on_zones(case, messages);
    relaxation(case, messages);
    viscosity_for_step(case, messages);
    times(case, messages);
    messages.extend(cloud_of_rings(case));
    let fragments = case.fragments.as_ref();
    messages.extend(fragments.and_then(|options| options.doubt(case.dimension)));
}

fn unused_materials(case: &Case, messages: &mut Vec<String>) {
    for (index, material) in case.materials.iter().enumerate() {
        if !case.bodies.iter().any(|body| body.material == index) {
            messages.push(format!("no body is of the material `{}`", material.name));
        }
    }
}

/// Particles that fly apart are rings, which meet the axis all round.
fn cloud_of_rings(case: &Case) -> Option<String> {
    let soft = || case.bodies.iter().filter(|body| body.rigid.is_none());
    let fastest = soft().map(|body| body.velocity.norm()).fold(0.0, f64::max);
    let bursts = case.axisymmetric && soft().count() > 2 && fastest > BURSTS;
    bursts.then(|| {
        "a cloud of fragments that is axisymmetric is one of rings, which drill the axis of what they meet: take a quarter \
         in three dimensions for walls behind a plate"
            .to_owned()
    })
}

/// Materials that noise destroys.
fn unbearing_materials(case: &Case, messages: &mut Vec<String>) {
    for material in &case.materials {
        let spall = material.failure.spall;
        if spall.is_some_and(|s| s.pressure == 0.0 && s.after == AfterSpall::Failed) {
            messages.push(format!(
                "`{}` bears no tension and fails for good at the first of it: give `failure.spall.pressure` \
                 what it bears, or `failure.spall.after` as \"recompacts\" or \"hold\"",
                material.name
            ));
        }
    }
}

/// A warning if the particles of a box give it another size.
fn box_size(body: &Body, case: &Case) -> Option<String> {
    let Shape::Box { lower, upper } = &body.shape else {
        return None;
    };
    // The layers of other lattices are no whole number of spacings apart.
    let lattice = &body.lattice;
    if lattice.kind != LatticeKind::Cubic || lattice.angle != 0.0 || lattice.fit {
        return None;
    }
    let (first, last) = populate::bounds(body, case.dimension)?;
    let axes = 0..case.dimension;
    let wanted: Vec<f64> = axes.clone().map(|a| upper[a] - lower[a]).collect();
    let got: Vec<f64> = axes.map(|a| last[a] - first[a] + lattice.spacing).collect();
    let differs = |(a, b): (&f64, &f64)| (a - b).abs() > ROUNDING * lattice.spacing;
    let unit = &case.length_unit;
    wanted.iter().zip(&got).any(differs).then(|| {
        format!(
            "the box of `{}` is no whole number of spacings of {}: in place of {} it gets {}; \
             `lattice = {{ kind = \"cubic\", fit = true }}` stretches the lattice to fill it",
            body.name,
            unit.text(lattice.spacing),
            unit.vector(&wanted),
            unit.vector(&got)
        )
    })
}

/// Absorbing zones that would have to bear a body's weight.
fn weight_on_zones(case: &Case, messages: &mut Vec<String>) {
    for absorber in case
        .loads
        .absorbers
        .iter()
        .filter(|_| case.loads.has_gravity())
    {
        messages.push(format!(
            "under gravity `{}` sinks through its absorbing zone, which bears no weight",
            case.bodies[absorber.body].name
        ));
    }
}

/// A relaxation that ends before bodies are at rest.
fn relaxation(case: &Case, messages: &mut Vec<String>) {
    let Some(relaxation) = &case.loads.relaxation else {
        return;
    };
    let rate = relaxation.rates.iter().fold(0.0_f64, |a, &b| a.max(b));
    let left = libm::exp(-0.5 * rate * relaxation.until);
    if left > MOST_LEFT {
        messages.push(format!(
            "the relaxation leaves {:.0} % of vibrations: its rate is {}, and it ends at {}",
            100.0 * left,
            shown(rate, "1/s"),
            shown(relaxation.until, "s")
        ));
    }
}

/// Bodies in contact with very different spacings, and bodies that separate from touching ones.
fn pairs(case: &Case, approaches: &[Approach], messages: &mut Vec<String>) {
    for pair in approaches.iter().filter(|pair| pushes(case, pair.bodies)) {
        let [body, other] = pair.bodies.map(|body| &case.bodies[body]);
        if pair.time < case.run.end_time {
            messages.extend(ratio(body, other));
        }
        if pair.gap < TOUCH {
            messages.extend(leaving(body, other, case.dimension));
        }
    }
    let [body, other] = unforeseen(case).map(|body| &case.bodies[body]);
    messages.extend(ratio(body, other));
}

/// True if two bodies have contact that is not of one continuum, as bodies joined by the kernel are.
fn pushes(case: &Case, bodies: [usize; 2]) -> bool {
    let driven = (bodies.iter()).all(|&body| case.bodies[body].driven().is_some());
    let [a, b] = bodies;
    !driven && case.contact_between(a, b).class().is_some()
}

/// The pair of bodies with the most different spacings that may meet at a time that is not foreseen; the first body
/// twice if there is none.
fn unforeseen(case: &Case) -> [usize; 2] {
    let bodies = 0..case.bodies.len();
    let bends: Vec<bool> = bodies
        .clone()
        .map(|body| !flies_straight(case, body))
        .collect();
    let mut farthest = ([0; 2], MOST_RATIO);
    let pairs = case.contacts.iter().map(|pair| &pair.mode);
    let mut modes = pairs.chain([&case.default_contact]);
    if !bends.contains(&true) || !modes.any(|mode| mode.class().is_some()) {
        return farthest.0;
    }
    let spacing = |body: usize| case.bodies[body].lattice.spacing;
    let mut order: Vec<usize> = bodies.collect();
    order.sort_by(|&a, &b| spacing(a).total_cmp(&spacing(b)));
    for &fine in &order {
        for &wide in order.iter().rev() {
            let ratio = spacing(wide) / spacing(fine);
            if ratio <= farthest.1 {
                break;
            }
            if (bends[fine] || bends[wide]) && pushes(case, [fine, wide]) {
                farthest = ([fine, wide], ratio);
            }
        }
    }
    farthest.0
}

fn ratio(body: &Body, other: &Body) -> Option<String> {
    let finer = |a: &Body, b: &Body| a.lattice.spacing < b.lattice.spacing;
    let [fine, wide] = if finer(body, other) {
        [body, other]
    } else {
        [other, body]
    };
    let ratio = wide.lattice.spacing / fine.lattice.spacing;
    let mean = 0.5 * (fine.smoothing_length + wide.smoothing_length);
    (ratio > MOST_RATIO).then(|| {
        format!(
            "the spacing of `{}` is {} times that of `{}`: their contact has a mean smoothing length of \
             {:.2} of the wider spacing, and the finer particles feel each of the wider ones; keep \
             the ratio below {MOST_RATIO}",
            wide.name,
            short(ratio),
            fine.name,
            mean / wide.lattice.spacing,
        )
    })
}

/// Bodies that begin in touch and fly apart.
fn leaving(body: &Body, other: &Body, dimension: usize) -> Option<String> {
    let (lower, upper) = populate::bounds(body, dimension)?;
    let (other_lower, other_upper) = populate::bounds(other, dimension)?;
    // The side on which the other body lies, and by how much.
    let sides = (0..dimension).flat_map(|a| {
        [
            (a, 1.0, other_lower[a] - upper[a]),
            (a, -1.0, lower[a] - other_upper[a]),
        ]
    });
    let (axis, sign, room) = sides.max_by(|a, b| a.2.total_cmp(&b.2))?;
    let closing = sign * (body.velocity - other.velocity)[axis];
    let apart = room > 0.25 * (body.lattice.spacing + other.lattice.spacing);
    (apart && closing < 0.0).then(|| {
        format!(
            "`{}` and `{}` begin in touch and fly apart at {}: is a `velocity` or a `touch` the \
             wrong way round?",
            body.name,
            other.name,
            shown(-closing, "m/s")
        )
    })
}

/// Friction and viscosity beyond known values.
fn coefficients(case: &Case, messages: &mut Vec<String>) {
    let of_mode = |mode: &ContactMode| mode.resistance().copied();
    let pairs = case.contacts.iter().map(|pair| &pair.mode);
    let modes = std::iter::once(&case.default_contact).chain(pairs);
    let surfaces = case.loads.surfaces.iter().map(|surface| surface.resistance);
    let all = modes.filter_map(of_mode).chain(surfaces);
    let largest = |r: Resistance| r.static_friction.max(r.kinetic_friction);
    let friction = all.map(largest).fold(0.0, f64::max);
    if friction > MOST_FRICTION {
        messages.push(format!(
            "`friction` is {}: dry rubber has about 1, and clean metals in vacuum weld beyond \
             {MOST_FRICTION}",
            short(friction)
        ));
    }
    for (key, value) in [("alpha", case.sph.alpha), ("beta", case.sph.beta)] {
        if value > MOST_VISCOSITY {
            messages.push(format!(
                "`{key}` is {}: with more than {MOST_VISCOSITY} artificial viscosity outweighs the \
                 pressure, and steps are as many times shorter",
                short(value)
            ));
        }
    }
}

/// Steps in which short waves grow by more than the viscosity takes from them.
fn viscosity_for_step(case: &Case, messages: &mut Vec<String>) {
    let longest = case.sph.longest_courant();
    let deforms = case.bodies.iter().any(|body| body.rigid.is_none());
    let corrected = case.sph.form == SphForm::Corrected;
    if deforms && corrected && case.time_step.courant > longest {
        messages.push(format!(
            "`alpha` is {}: so little viscosity leaves short waves to grow, and energy with them, in steps \
             of `courant` = {}; take {longest:.2}",
            short(case.sph.alpha),
            short(case.time_step.courant)
        ));
    }
}

/// More steps than any run takes, and output at each of them.
fn times(case: &Case, messages: &mut Vec<String>) {
    let Some(step) = expected_step(case) else {
        return;
    };
    let end = case.run.end_time;
    let steps = end / step;
    let bounded = case.run.max_steps.is_some();
    if steps > MOST_STEPS && !bounded {
        messages.push(format!(
            "`end_time` is {}, {} steps of about {}: no run takes so many; check its unit",
            shown(end, "s"),
            short(steps),
            shown(step, "s")
        ));
    }
    let own = case.output.snapshots.iter();
    let own = own.map(|schedule| (format!("every` of `{}", schedule.name), schedule.every));
    let defaults = [
        ("snapshot_every".to_owned(), case.output.snapshot_every),
        ("checkpoint_every".to_owned(), case.output.checkpoint_every),
    ];
    for (key, every) in defaults.into_iter().chain(own) {
        if let Some(every) = every.filter(|every| *every < step) {
            messages.push(format!(
                "`{key}` is {}, less than a step of about {}: every step writes one",
                shown(every, "s"),
                shown(step, "s")
            ));
        }
    }
}
