//! Analytic solutions, shared by tests and plots.

pub mod hugoniot;
