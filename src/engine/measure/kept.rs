//! Memory of measures from step to step, and all that `measures.csv` holds.

use super::bodies::KeptBodies;
use super::figure::Findings;
use super::gauges::Gauges;
use super::matter::Matter;
use super::remains::Remains;
use super::revolved::Revolved;
use super::witness::Witnesses;
use super::{bar, debris, front, plate, target, whole, zone};
use crate::diagnose::Remembered;
use comm::Comm;
use model::{Case, MeasureKind, Slab};
use numerics::vector::dot;
use particles::ParticleStore;

/// Gauges, witness planes and figures of bodies: what is kept from step to step.
#[derive(Debug)]
pub struct Measures {
    /// Gauges.
    pub gauges: Gauges,
    /// Witness planes.
    pub witnesses: Witnesses,
    /// Of the rows of bodies.
    pub bodies: KeptBodies,
}

impl Measures {
    /// Those of a case.
    #[must_use]
    pub fn new(case: &Case) -> Self {
        Self {
            gauges: Gauges::new(case),
            witnesses: Witnesses::new(case),
            bodies: KeptBodies::default(),
        }
    }

    /// Bytes allocated.
    #[must_use]
    pub fn memory(&self) -> usize {
        self.gauges.memory() + self.witnesses.memory() + self.bodies.memory()
    }
}

/// Momentum (kg m/s) of all that begins before the struck face of a slab, towards that face. Collective.
fn impulse(slab: &Slab, matter: &Matter, comm: &Comm) -> f64 {
    let [sum] = matter.sums::<1>(comm, |i, sums| {
        let body = matter.body_of(i);
        if body != slab.body && slab.before.contains(&body) {
            sums.add(&[-matter.mass[i] * dot(&slab.normal, &matter.velocity[i])]);
        }
    });
    // A face that is its own mirror image is struck along symmetry planes.
    whole::Whole::new(&matter.mirrors).sum(sum)
}

/// Memory of measures of the start. Collective.
#[must_use]
pub fn remember(matter: &Matter, comm: &Comm) -> Vec<Remembered> {
    let revolved = Revolved::of(matter);
    let matter = &revolved.as_ref().map_or(*matter, Revolved::matter);
    let all = matter.case.measure.measures.iter();
    let of = |kind: &MeasureKind| match kind {
        MeasureKind::Plate(slab) | MeasureKind::Target(slab) => Some(impulse(slab, matter, comm)),
        _ => None,
    };
    all.map(|measure| Remembered {
        impulse: of(&measure.kind),
        front: None,
    })
    .collect()
}

/// Tells particles at the start in which moving regions they are.
pub fn mark_zones(case: &Case, particles: &mut ParticleStore) {
    for measure in &case.measure.measures {
        let MeasureKind::Zone(zone) = &measure.kind else {
            continue;
        };
        let Some(mark) = zone.mark else { continue };
        // At the start, not in every step.
        for i in 0..particles.owned() {
            let inside = zone.place.contains(&particles.position[i]);
            particles.measure_marks[i] |= u32::from(inside) << mark;
        }
    }
}

/// Findings of all measures of the case at a time (s), in their order; `particles` are those of
/// `matter`, which regions read: without them these find nothing. Collective.
#[must_use]
pub fn findings(
    time: f64,
    remembered: &mut Vec<Remembered>,
    particles: Option<&ParticleStore>,
    matter: &Matter,
    comm: &Comm,
) -> Vec<Findings> {
    let revolved = Revolved::of(matter);
    let (matter, particles) = match &revolved {
        Some(revolved) => (&revolved.matter(), None),
        None => (matter, particles),
    };
    let measures = &matter.case.measure.measures;
    // Of a run that was begun with others nothing is known.
    if remembered.len() != measures.len() {
        *remembered = vec![Remembered::default(); measures.len()];
    }
    let remains: Vec<Option<(&Slab, Remains)>> = measures
        .iter()
        .map(|measure| match &measure.kind {
            MeasureKind::Plate(slab) | MeasureKind::Target(slab) => {
                Some((slab, Remains::find(slab, matter, comm)))
            }
            _ => None,
        })
        .collect();
    let mut all = Vec::with_capacity(measures.len());
    for (k, measure) in measures.iter().enumerate() {
        let of = |k: usize| remains[k].as_ref().map(|(slab, remains)| (*slab, remains));
        all.push(match &measure.kind {
            MeasureKind::Plate(_) => of(k).map_or_else(Findings::default, |(slab, remains)| {
                plate::plate(slab, remains, matter, comm)
            }),
            MeasureKind::Target(_) => of(k).map_or_else(Findings::default, |(slab, remains)| {
                target::target(slab, remains, matter, comm)
            }),
            MeasureKind::Bar(bar) => bar::bar(bar, matter, comm),
            MeasureKind::Debris(debris) => {
                let left = debris.of.and_then(of);
                let outwards = left.filter(|(slab, _)| dot(&slab.normal, &debris.direction) > 0.0);
                let struck = outwards.and(debris.of);
                let impulse = struck.and_then(|k| remembered[k].impulse);
                debris::debris(debris, left, impulse, matter, comm)
            }
            MeasureKind::Zone(zone) => particles.map_or_else(Findings::default, |particles| {
                zone::zone(zone, particles, matter, comm)
            }),
            MeasureKind::Front(line) => {
                front::front(line, time, &mut remembered[k].front, matter, comm)
            }
        });
    }
    all
}
