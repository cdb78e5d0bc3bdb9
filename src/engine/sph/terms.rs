//! Pair terms of the second sweep, each off unless a case asks for it: one file each, put together
//! here.
//!
//! A set of terms is a constant of the sums' type, so that those of a case without terms hold no
//! trace of them.

pub mod artificial_stress;
pub mod balsara;
mod conduction;
mod xsph;

use rayon::prelude::*;

use super::neighbourhood::records;
use super::records::NormalisedRecord;
use super::step::Side;
use crate::loads::Loads;
use model::{Case, SphOptions};
use numerics::kernel::Kernel;
use numerics::lanes::{LANES, Lanes};
use particles::neighbours::Lists;
use particles::{GRAIN, ParticleStore, resize};

/// Artificial stress: [`artificial_stress`].
pub const ARTIFICIAL_STRESS: u8 = 1;
/// The Balsara switch on artificial viscosity: [`balsara`].
pub const BALSARA: u8 = 2;
/// Artificial conduction between approaching particles.
pub const CONDUCTION: u8 = 4;
/// XSPH.
pub const XSPH: u8 = 8;
/// Stress along corrected gradients: [`super::normalised`].
pub const NORMALISED: u8 = 16;

/// The terms that need the kernel's value.
pub(super) const SHAPED: u8 = ARTIFICIAL_STRESS | XSPH | NORMALISED;
/// The terms for which particles show a [`TermRecord`].
pub const RECORDED: u8 = ARTIFICIAL_STRESS | BALSARA | CONDUCTION;
/// The terms of solids and of shocks, which [`with_terms`] puts together.
pub(super) const SOLIDS: u8 = ARTIFICIAL_STRESS | XSPH;
pub(super) const SHOCKS: u8 = BALSARA | CONDUCTION;

/// Calls `$work` with a set of terms as a constant: none, or those of solids, of shocks, or all,
/// whichever has all that are wanted. The others then have neutral data. The normalised form has
/// none or all.
macro_rules! with_terms {
    ($wanted:expr, $name:ident => $work:expr) => {
        $crate::sph::terms::with_terms!(@ $wanted, $name => $work,
            { 0 } { SOLIDS } { SHOCKS } { SOLIDS | SHOCKS }
            { NORMALISED } { NORMALISED | SOLIDS | SHOCKS })
    };
    (@ $wanted:expr, $name:ident => $work:expr, $({ $set:expr })+) => {{
        use $crate::sph::terms::{NORMALISED, SHOCKS, SOLIDS};
        let wanted: u8 = $wanted;
        $(if wanted & !($set) == 0 && (wanted ^ ($set)) & NORMALISED == 0 {
            const $name: u8 = $set;
            $work
        } else)+ {
            unreachable!("the last set has all terms")
        }
    }};
}
pub(super) use with_terms;

/// What a particle shows to its neighbours for the terms: one cache line.
#[derive(Debug, Clone, Copy, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C, align(64))]
pub struct TermRecord {
    /// `R`, components xx, yy, zz, xy, xz, yz (Pa m⁶/kg²).
    pub repulsion: [f64; 6],
    /// Half the factor of the Balsara switch.
    pub half_limiter: f64,
    /// Specific internal energy (J/kg).
    pub specific_energy: f64,
}

impl TermRecord {
    /// What changes nothing.
    pub const NEUTRAL: Self = Self {
        repulsion: [0.0; 6],
        half_limiter: 0.5,
        specific_energy: 0.0,
    };
}

/// Coefficients of the terms, and what particles show for them.
#[derive(Debug, Clone, Copy)]
pub struct PairTerms<'a> {
    /// Records of all particles and images; empty without terms that show any.
    pub records: &'a [TermRecord],
    /// Stresses with corrections of all particles and images; empty without [`NORMALISED`].
    pub normalised: &'a [NormalisedRecord],
    /// `1/w(Δp/h)`, with `w = W h^d/σ_d`.
    pub inverse_shape: f64,
    /// Coefficient `α_u` of the conduction.
    pub conduction: f64,
    /// Factor ε of XSPH.
    pub xsph: f64,
}

impl PairTerms<'_> {
    /// No terms.
    pub const NONE: Self = Self {
        records: &[],
        normalised: &[],
        inverse_shape: 0.0,
        conduction: 0.0,
        xsph: 0.0,
    };

    /// What the particle or image at an index shows for a set of terms.
    #[inline(always)]
    pub(super) fn record<const TERMS: u8>(&self, index: usize) -> &TermRecord {
        if TERMS & RECORDED == 0 {
            &TermRecord::NEUTRAL
        } else {
            &self.records[index]
        }
    }

    /// The same of [`NORMALISED`].
    #[inline(always)]
    pub(super) fn normalised<const TERMS: u8>(&self, index: usize) -> &NormalisedRecord {
        if TERMS & NORMALISED == 0 {
            &NormalisedRecord::FREE
        } else {
            &self.normalised[index]
        }
    }
}

/// The terms of eight receivers, of which those that are not of the set do nothing.
pub(super) struct TermSums<V, const TERMS: u8> {
    artificial_stress: artificial_stress::Lane<V>,
    balsara: balsara::Lane<V>,
    conduction: conduction::Lane<V>,
    xsph: xsph::Lane<V>,
}

impl<V: Lanes, const TERMS: u8> TermSums<V, TERMS> {
    #[inline(always)]
    pub fn begin(terms: &PairTerms, indices: &[u32; LANES]) -> Self {
        let own = if TERMS & RECORDED == 0 {
            [&TermRecord::NEUTRAL; LANES]
        } else {
            records(terms.records, indices)
        };
        Self {
            artificial_stress: artificial_stress::Lane::begin(&own, terms.inverse_shape),
            balsara: balsara::Lane::begin(&own),
            conduction: conduction::Lane::begin(&own, terms.conduction),
            xsph: xsph::Lane::begin(terms.xsph),
        }
    }

    /// The viscosity's signal speed.
    #[inline(always)]
    pub fn limit(&self, signal: V, other: &TermRecord) -> V {
        if TERMS & BALSARA == 0 {
            return signal;
        }
        self.balsara.limit(signal, other)
    }

    /// Adds to the stress of pairs of a `shape`.
    #[inline(always)]
    pub fn repel(&self, stress: &mut [V; 6], other: &TermRecord, shape: V) {
        if TERMS & ARTIFICIAL_STRESS != 0 {
            self.artificial_stress.repel(stress, other, shape);
        }
    }

    /// Sums `v_ij` times the `share` `m_j W/(ρ_i + ρ_j)`.
    #[inline(always)]
    pub fn follow(&mut self, v: &[V; 3], share: V) {
        if TERMS & XSPH != 0 {
            self.xsph.follow(v, share);
        }
    }

    /// What conduction lets flow times speed (J/kg), added to `work` by `speed`.
    #[inline(always)]
    pub fn conduct(&self, work: V, other: &TermRecord, speed: impl FnOnce() -> V) -> V {
        if TERMS & CONDUCTION == 0 {
            return work;
        }
        self.conduction.flow(other).mul_add(speed(), work)
    }

    /// What XSPH adds to the drift (m/s).
    #[inline(always)]
    pub fn correction(&self) -> [V; 3] {
        self.xsph.correction()
    }
}

/// The pair terms of a case, and what particles and images show for them.
pub(super) struct Terms {
    set: u8,
    records: Vec<TermRecord>,
    inverse_shape: f64,
    sph: SphOptions,
}

/// The set of pair terms of a case.
fn set_of(sph: &SphOptions) -> u8 {
    let wanted = [
        (ARTIFICIAL_STRESS, sph.artificial_stress > 0.0),
        (BALSARA, sph.balsara),
        (CONDUCTION, sph.conduction > 0.0),
        (XSPH, sph.xsph > 0.0),
    ];
    let wanted = wanted.into_iter().filter(|(_, wanted)| *wanted);
    wanted.fold(0, |set, (term, _)| set | term)
}

/// Bytes of what each particle and image shows for the pair terms of a case.
pub(super) fn bytes_of_records(sph: &SphOptions) -> usize {
    if set_of(sph) == 0 {
        0
    } else {
        size_of::<TermRecord>()
    }
}

impl Terms {
    pub fn new(case: &Case, kernel: &Kernel) -> Self {
        // All bodies of a case have the same h/Δp.
        let body = case.bodies.first();
        let ratio = body.map_or(1.0, |b| b.lattice.spacing / b.smoothing_length);
        Self {
            set: set_of(&case.sph),
            records: Vec::new(),
            inverse_shape: kernel.normalisation() / kernel.value(ratio, 1.0),
            sph: case.sph,
        }
    }

    /// Which terms there are.
    pub fn set(&self) -> u8 {
        self.set
    }

    /// What the sums need; with stresses along corrected gradients, if any.
    pub fn of_sums<'a>(&'a self, normalised: &'a [NormalisedRecord]) -> PairTerms<'a> {
        PairTerms {
            records: &self.records,
            normalised,
            inverse_shape: self.inverse_shape,
            conduction: self.sph.conduction,
            xsph: self.sph.xsph,
        }
    }

    pub fn memory(&self) -> usize {
        self.records.capacity() * size_of::<TermRecord>()
    }

    /// What this rank's particles show to others, after the first sweep of a step `dt` (s).
    pub fn prepare(&self, particles: &mut ParticleStore, dt: f64) {
        if self.set & BALSARA != 0 {
            balsara::prepare(particles);
        }
        if self.set & CONDUCTION != 0 {
            conduction::prepare(particles, dt);
        }
    }

    /// Records of halo particles and their images, or of this rank's particles and theirs.
    pub fn show(&mut self, particles: &ParticleStore, lists: &Lists, side: Side) {
        let set = self.set;
        // A compiled set may have more terms than the case: then they show neutral data.
        if set == 0 {
            return;
        }
        let images = lists.images();
        let epsilon = self.sph.artificial_stress;
        resize(&mut self.records, images.len());
        let records = self.records.par_iter_mut().zip(images);
        records.with_min_len(GRAIN).for_each(|(record, &image)| {
            let i = image.base();
            if !side.takes(i >= particles.owned()) {
                return;
            }
            *record = TermRecord::NEUTRAL;
            if set & ARTIFICIAL_STRESS != 0 {
                record.repulsion = artificial_stress::shown(particles, image, epsilon);
            }
            if set & BALSARA != 0 {
                record.half_limiter = 0.5 * particles.viscosity_limiter[i];
            }
            if set & CONDUCTION != 0 {
                record.specific_energy = particles.predicted_energy[i];
            }
        });
    }

    /// The rest of the drift of a step `dt` (s).
    pub fn drift(&self, particles: &mut ParticleStore, loads: &Loads, dt: f64) {
        if self.set & XSPH != 0 {
            xsph::drift(particles, loads, dt);
        }
    }
}
