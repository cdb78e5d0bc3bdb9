//! Chooses the widest vector instructions of the processor once; all choices give the same bits.

use std::sync::OnceLock;

#[cfg(not(all(target_arch = "x86_64", not(target_feature = "fma"))))]
use super::lanes::F64x8 as Fallback;
use super::lanes::Lanes;
#[cfg(all(target_arch = "x86_64", not(target_feature = "fma")))]
use super::lanes::portable::Portable as Fallback;
#[cfg(target_arch = "x86_64")]
use super::lanes::{avx2, avx512};

/// An instruction set that the pair sweeps are compiled for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Instructions {
    /// 512-bit vectors.
    Avx512,
    /// 256-bit vectors with fused multiply-add.
    Avx2,
    /// Whatever the build's target offers; slow where fused multiply-add is emulated.
    Portable,
}

/// The instruction set in use: the widest one here, or the one that the environment variable
/// `WHIPPLE_SIMD` names (`avx512`, `avx2`, `portable`) if this processor has it.
#[must_use]
pub fn instructions() -> Instructions {
    static CHOICE: OnceLock<Instructions> = OnceLock::new();
    *CHOICE.get_or_init(|| {
        let request = std::env::var("WHIPPLE_SIMD").unwrap_or_default();
        let available = available();
        available
            .iter()
            .copied()
            .find(|set| set.name() == request)
            .unwrap_or(available[0])
    })
}

/// The instruction sets of this processor, widest first.
#[must_use]
pub fn available() -> Vec<Instructions> {
    let mut sets = Vec::new();
    #[cfg(target_arch = "x86_64")]
    {
        let avx2 = is_x86_feature_detected!("avx2")
            && is_x86_feature_detected!("fma")
            && is_x86_feature_detected!("bmi1")
            && is_x86_feature_detected!("bmi2")
            && is_x86_feature_detected!("popcnt");
        let avx512 = is_x86_feature_detected!("avx512f")
            && is_x86_feature_detected!("avx512vl")
            && is_x86_feature_detected!("avx512dq");
        if avx2 && avx512 {
            sets.push(Instructions::Avx512);
        }
        if avx2 {
            sets.push(Instructions::Avx2);
        }
    }
    sets.push(Instructions::Portable);
    sets
}

impl Instructions {
    /// Name for reports and `WHIPPLE_SIMD`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Avx512 => "avx512",
            Self::Avx2 => "avx2",
            Self::Portable => "portable",
        }
    }

    /// Runs `work` compiled for this instruction set.
    #[inline]
    pub fn run<W: Vectorised>(self, work: W) -> W::Output {
        #[cfg(target_arch = "x86_64")]
        match self {
            // SAFETY: `available` found these features on this processor.
            Self::Avx512 => return unsafe { run_avx512(work) },
            // SAFETY: as above.
            Self::Avx2 => return unsafe { run_avx2(work) },
            Self::Portable => {}
        }
        run_portable(work)
    }
}

/// Work that is compiled once for each instruction set.
pub trait Vectorised {
    /// Result of the work.
    type Output;
    /// The work on vectors `V`; mark the implementation `#[inline(always)]`.
    fn run<V: Lanes>(self) -> Self::Output;
}

/// A function of its own: each of its fused multiply-adds may be a call.
#[inline(never)]
fn run_portable<W: Vectorised>(work: W) -> W::Output {
    work.run::<Fallback>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx2,fma,bmi1,bmi2,popcnt")]
fn run_avx512<W: Vectorised>(work: W) -> W::Output {
    work.run::<avx512::Vector>()
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,fma,bmi1,bmi2,popcnt")]
fn run_avx2<W: Vectorised>(work: W) -> W::Output {
    work.run::<avx2::Vector>()
}
