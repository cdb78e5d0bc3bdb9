//! Room diagnose.

pub mod exact_sum;
