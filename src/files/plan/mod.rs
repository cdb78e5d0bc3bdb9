//! Predicted costs of a case on any number of ranks, by one process: particles and messages of each rank,
//! time of a step, and files.

mod files;
mod layout;
mod machine;
mod model;
mod outlook;
mod particles;
mod rough;
mod row;
mod sharing;
mod tables;
mod weak;

pub use files::Files;
pub use layout::{Layout, Load, loads, loads_of, slabs_at_start, slabs_of};
pub use machine::{CONSTANTS, Constant, Machine};
pub use model::{StepTime, Terms, computing, step_time};
pub use outlook::{Outlook, expected_steps, share_of_work, work_of_unequal};
pub use particles::Particles;
pub use rough::rough_step;
pub use row::Row;
pub use sharing::Sharing;
pub use weak::{Weak, refined};
