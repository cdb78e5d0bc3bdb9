//! Pair terms of the second sweep, each off unless a case asks for it: one file each, put together
//! here.
//!
//! Whether there are any is a constant of the sums' type, so that those of a case without terms hold no
//! trace of them. Which ones there are is asked pair by pair, always with the same answer.

pub mod artificial_stress;
pub mod balsara;
mod conduction;
mod xsph;

use super::neighbourhood::records;
use model::TermOptions;
use numerics::kernel::{PairKernel, PairScale};
use numerics::lanes::{LANES, Lanes};
use particles::Owner;

/// The terms that need the kernel's value.
const SHAPED: Owner = Owner::ARTIFICIAL_STRESS.union(Owner::XSPH);

/// Calls `$work` with whether a set has any terms as a constant.
macro_rules! with_terms {
    ($set:expr, $name:ident => $work:expr) => {
        if $set.is_empty() {
            const $name: bool = false;
            $work
        } else {
            const $name: bool = true;
            $work
        }
    };
}
pub(super) use with_terms;

/// Record of a particle for the terms that its neighbours read: one cache line.
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
    /// Record that changes nothing.
    pub const NEUTRAL: Self = Self {
        repulsion: [0.0; 6],
        half_limiter: 0.5,
        specific_energy: 0.0,
    };
}

/// Terms that there are, their coefficients, and the records of particles for them.
#[derive(Debug, Clone, Copy, Default)]
pub struct PairTerms<'a> {
    /// Set of the terms.
    pub set: Owner,
    /// Records of all particles and images; empty without terms.
    pub records: &'a [TermRecord],
    /// `1/w(Δp/h)`, with `w = W h^d/σ_d`.
    pub inverse_shape: f64,
    /// Coefficients.
    pub options: TermOptions,
}

impl PairTerms<'_> {
    /// Record of the particle or image at an index, if there are terms.
    #[inline(always)]
    pub(crate) fn record<const TERMS: bool>(&self, index: usize) -> &TermRecord {
        if TERMS {
            &self.records[index]
        } else {
            &TermRecord::NEUTRAL
        }
    }
}

/// The terms of eight receivers, of which those that are not of the set do nothing.
pub(crate) struct TermSums<V, const TERMS: bool> {
    set: Owner,
    artificial_stress: artificial_stress::Lane<V>,
    balsara: balsara::Lane<V>,
    conduction: conduction::Lane<V>,
    xsph: xsph::Lane<V>,
}

impl<V: Lanes, const TERMS: bool> TermSums<V, TERMS> {
    #[inline(always)]
    pub fn begin(terms: &PairTerms, indices: &[u32; LANES]) -> Self {
        let own = if TERMS {
            records(terms.records, indices)
        } else {
            [&TermRecord::NEUTRAL; LANES]
        };
        Self {
            set: terms.set,
            artificial_stress: artificial_stress::Lane::begin(&own, terms.inverse_shape),
            balsara: balsara::Lane::begin(&own),
            conduction: conduction::Lane::begin(&own, terms.options.conduction),
            xsph: xsph::Lane::begin(terms.options.xsph),
        }
    }

    /// True if one of these terms is of the set.
    #[inline(always)]
    fn has(&self, terms: Owner) -> bool {
        TERMS && self.set.intersects(terms)
    }

    /// True if one of the terms needs the kernel's value.
    #[inline(always)]
    pub fn need_shape(&self) -> bool {
        self.has(SHAPED)
    }

    /// True if one of the terms adds to the stress of pairs.
    #[inline(always)]
    pub fn repels(&self) -> bool {
        self.has(Owner::ARTIFICIAL_STRESS)
    }

    /// The viscosity's signal speed.
    #[inline(always)]
    pub fn limit(&self, signal: V, other: &TermRecord) -> V {
        if self.has(Owner::BALSARA) {
            self.balsara.limit(signal, other)
        } else {
            signal
        }
    }

    /// Adds to the stress of pairs of a `shape`.
    #[inline(always)]
    pub fn repel(&self, stress: &mut [V; 6], other: &TermRecord, shape: V) {
        if self.repels() {
            self.artificial_stress.repel(stress, other, shape);
        }
    }

    /// Sums `v_ij m_j W/(ρ_i + ρ_j)` of pairs of a `shape`, from `m_j` and `1/(ρ_i + ρ_j)`.
    #[inline(always)]
    pub fn follow<S: PairScale>(
        &mut self,
        v: &[V; 3],
        (scale, kernel, shape): (&S, &PairKernel<V>, V),
        (mass, inverse_density): (f64, V),
    ) {
        if self.has(Owner::XSPH) {
            let share = scale.value(kernel, shape).mul(V::splat(mass));
            self.xsph.follow(v, share.mul(inverse_density));
        }
    }

    /// Flow of conduction times speed (J/kg), added to `work` by `speed`.
    #[inline(always)]
    pub fn conduct(&self, work: V, other: &TermRecord, speed: impl FnOnce() -> V) -> V {
        if self.has(Owner::CONDUCTION) {
            self.conduction.flow(other).mul_add(speed(), work)
        } else {
            work
        }
    }

    /// Drift that XSPH adds (m/s).
    #[inline(always)]
    pub fn correction(&self) -> [V; 3] {
        self.xsph.correction()
    }
}
