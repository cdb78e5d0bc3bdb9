//! Debris: what is of no body's largest piece.

use serde_json::{Value, json};

use super::loaded::Loaded;
use engine::fragments::{Census, Fragment};

/// Debris of a body, of the whole model.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Debris {
    /// Index of the body.
    pub body: usize,
    /// Mass (kg; by length or area in models of fewer dimensions).
    pub mass: f64,
    /// The same over the mass of the body.
    pub share: f64,
    /// Number of its fragments, which are mostly of the body.
    pub fragments: u64,
    /// Mass in fragments (kg).
    pub in_fragments: f64,
    /// Mass that belongs to no fragment by its state (kg).
    pub failed: f64,
    /// Mean velocity by mass (m/s).
    pub velocity: [f64; 3],
}

impl Debris {
    /// As JSON, with the names of bodies.
    pub fn document(&self, bodies: &[String]) -> Value {
        json!({
            "body": bodies[self.body],
            "mass": self.mass,
            "share": self.share,
            "fragments": self.fragments,
            "in_fragments": self.in_fragments,
            "failed": self.failed,
            "velocity": self.velocity,
        })
    }
}

/// The body that a fragment is mostly of.
pub fn main_body(fragment: &Fragment) -> usize {
    most(fragment.mass_of.iter().copied()).map_or(0, |(body, _)| body)
}

/// The largest of some masses and its place, the first of equals.
fn most(masses: impl ExactSizeIterator<Item = f64> + DoubleEndedIterator) -> Option<(usize, f64)> {
    let all = masses.enumerate().rev();
    all.max_by(|(_, a), (_, b)| a.total_cmp(b))
}

/// True of each fragment that is the largest piece of a body.
pub fn largest_pieces(census: &Census, bodies: usize) -> Vec<bool> {
    let mut is_largest = vec![false; census.fragments.len()];
    for body in 0..bodies {
        let all = census.fragments.iter();
        let own = most(all.map(|fragment| fragment.mass_of[body]));
        if let Some((place, _)) = own.filter(|(_, mass)| *mass > 0.0) {
            is_largest[place] = true;
        }
    }
    is_largest
}

/// The debris of all bodies that have any, given the fragments that are largest pieces.
pub fn of_bodies(
    loaded: &Loaded,
    (census, is_largest): (&Census, &[bool]),
    included: &[bool],
) -> Vec<Debris> {
    let fold = f64::from(1_u32 << loaded.symmetry.len());
    let mut pieces: Vec<u64> = Vec::new();
    let mut others: Vec<u64> = Vec::new();
    let mut all: Vec<Debris> = (0..loaded.bodies.len())
        .map(|body| Debris {
            body,
            ..Debris::default()
        })
        .collect();
    for (fragment, is_largest) in census.fragments.iter().zip(is_largest) {
        if *is_largest {
            pieces.push(fragment.label);
        } else {
            others.push(fragment.label);
            all[main_body(fragment)].fragments += fragment.copies;
        }
    }
    pieces.sort_unstable();
    others.sort_unstable();
    let mut whole = vec![0.0; all.len()];
    let matter = loaded.matter().zip(&census.labels).zip(included);
    for ((particle, label), included) in matter {
        let Some((body, mass, velocity)) = particle else {
            continue;
        };
        let mass = fold * mass;
        whole[body] += mass;
        if *included && pieces.binary_search(label).is_ok() {
            continue;
        }
        let debris = &mut all[body];
        debris.mass += mass;
        if !included {
            debris.failed += mass;
        } else if others.binary_search(label).is_ok() {
            debris.in_fragments += mass;
        }
        for (sum, v) in debris.velocity.iter_mut().zip(velocity) {
            *sum += mass * v;
        }
    }
    all.retain(|debris| debris.mass > 0.0);
    for debris in &mut all {
        debris.share = debris.mass / whole[debris.body];
        debris.velocity = debris.velocity.map(|momentum| momentum / debris.mass);
        // Images behind planes fly the other way.
        for plane in &loaded.symmetry {
            debris.velocity[plane.axis.index()] = 0.0;
        }
    }
    all
}
