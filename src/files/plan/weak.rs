//! Weak scaling: the same model with finer particles, so that each rank has as many as on fewer ranks.

use super::layout::Load;
use super::machine::Machine;
use super::model::{StepTime, step_time};
use super::sharing::Sharing;
use comm::Traffic;
use engine::domain::Tally;

/// A step of a refined model.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Weak {
    /// Number of ranks.
    pub ranks: usize,
    /// Levels of their slabs.
    pub levels: usize,
    /// Mean number of particles of another rank over its own.
    pub halo: f64,
    /// Time of a step.
    pub time: StepTime,
    /// Time of one core with a core's particles alone over that of a step.
    pub efficiency: f64,
}

impl Weak {
    /// Of ranks with these loads in slabs of `levels` levels, refined to `each` particles a rank.
    #[must_use]
    pub fn new(
        loads: &[Load],
        levels: usize,
        each: f64,
        machine: &Machine,
        sharing: Sharing,
    ) -> Self {
        let fine = refined(loads, levels, each);
        Self {
            levels,
            ..Self::of_refined(&fine, each, machine, sharing)
        }
    }

    /// Of loads that are refined to `each` particles a rank already.
    #[must_use]
    #[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
    pub fn of_refined(fine: &[Load], each: f64, machine: &Machine, sharing: Sharing) -> Self {
        let time = step_time(fine, machine, sharing);
        let halo: u64 = fine.iter().map(|load| load.tally.halo).sum();
        Self {
            ranks: fine.len(),
            levels: 0,
            halo: halo as f64 / (each * fine.len() as f64),
            time,
            efficiency: each * machine.particle_time / (time.all * sharing.threads as f64),
        }
    }
}

/// The loads of a model with finer particles, of which ranks have `each` in the mean.
///
/// Shares are uneven by whole layers of particles, which become thinner. A halo of r times as many particles is taken for that
/// of a box which is cut along as many axes as there are levels, `1 + r = (1 + u)^levels`, of which u shrinks as the
/// particles do.
#[must_use]
#[allow(clippy::cast_precision_loss, reason = "counts are far below 2^52")]
pub fn refined(loads: &[Load], levels: usize, each: f64) -> Vec<Load> {
    let owned: u64 = loads.iter().map(|load| load.tally.owned).sum();
    let mean = owned as f64 / loads.len() as f64;
    // Of a body of three dimensions; lengths of others shrink faster, and their halos too.
    let (shorter, power) = (1.0 / libm::cbrt(each / mean), levels as f64);
    let fine = |load: &Load| {
        let before = load.tally.owned as f64;
        let owned = each * (1.0 + (before / mean - 1.0) * shorter);
        // Growth of a number of particles of others.
        let growth = |others: u64| {
            if others == 0 {
                return 1.0;
            }
            let u = libm::pow(1.0 + others as f64 / before, 1.0 / power) - 1.0;
            owned * (libm::pow(1.0 + u * shorter, power) - 1.0) / others as f64
        };
        let (halo, images) = (growth(load.tally.halo), growth(load.tally.images));
        let traffic = |traffic: Traffic| Traffic {
            messages: traffic.messages,
            bytes: scaled(traffic.bytes, halo),
        };
        Load {
            tally: Tally {
                owned: scaled(1, owned.max(0.0)),
                halo: scaled(load.tally.halo, halo),
                images: scaled(load.tally.images, images),
                peers: load.tally.peers,
            },
            sent: traffic(load.sent),
            beyond: traffic(load.beyond),
            late: scaled(load.late, halo),
        }
    };
    loads.iter().map(fine).collect()
}

#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "counts"
)]
fn scaled(count: u64, by: f64) -> u64 {
    (count as f64 * by).round() as u64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box of 20 layers whose halo is 2.6 layers wide, refined to 40 layers.
    #[test]
    fn halos_of_boxes_are_those_of_finer_boxes() {
        let halo = |b: f64| (b + 5.2).powi(3) - b.powi(3);
        let load = |b: f64| Load {
            tally: Tally {
                owned: scaled(1, b.powi(3)),
                halo: scaled(1, halo(b)),
                images: scaled(1, halo(b)),
                peers: 26,
            },
            sent: Traffic {
                messages: 78,
                bytes: scaled(100, halo(b)),
            },
            beyond: Traffic::default(),
            late: scaled(60, halo(b)),
        };
        let fine = refined(&[load(20.0)], 3, 64_000.0)[0];
        let exact = load(40.0);
        let near = |a: u64, b: u64| a.abs_diff(b) * 1000 < b;
        assert_eq!(fine.tally.owned, exact.tally.owned);
        assert!(near(fine.tally.halo, exact.tally.halo), "{fine:?}");
        assert!(near(fine.sent.bytes, exact.sent.bytes), "{fine:?}");
        assert!(near(fine.late, exact.late), "{fine:?}");
    }
}
