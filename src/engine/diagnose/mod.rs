//! Conserved sums and ledgers of a run, and what tells that it goes wrong.

mod instability;
mod ledger;
mod limits;
mod meetings;
mod post_mortem;
mod reason;
mod remembered;
mod step_sums;
mod taken_out;
mod totals;

pub(crate) use instability::{fastest, is_explained};
pub use ledger::{LoadState, NearestPair, PairState, Passed, RunState, Tear, Torn, Totals, Worst};
pub use limits::NumericalFailure;
pub(crate) use limits::{Limits, Moved};
pub(crate) use post_mortem::PAST_STEPS;
pub use post_mortem::{PastStep, PostMortem};
pub use reason::Reason;
pub use remembered::Remembered;
pub(crate) use step_sums::{Booked, StepSums, Votes};
pub use taken_out::{Leave, Removed};
pub use totals::failed_mass;
pub(crate) use totals::{KeptTotals, angular_momentum_scale};
