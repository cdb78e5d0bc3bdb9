//! `whipple --version`: what the program is made of.

use std::ffi::OsString;

use clap::error::ErrorKind;

use files::output::{VERSION, commit, h5};
use numerics::dispatch::{Instructions, available, instructions};

/// The long form, if the command line asks for it; `-V` is the short one.
pub fn asked(error: &clap::Error) -> Option<String> {
    let is_long = |word: OsString| word == "--version";
    let asked = error.kind() == ErrorKind::DisplayVersion && std::env::args_os().any(is_long);
    asked.then(long)
}

/// Version and commit, the libraries that it runs with, and vector instructions: those in use, and those that
/// the processor has. MPI is asked without being started.
fn long() -> String {
    let sets: Vec<&str> = available().into_iter().map(Instructions::name).collect();
    format!(
        "whipple {VERSION}\n\
         commit        {}\n\
         MPI           {}\n\
         HDF5          {}\n\
         instructions  {} (this processor has {})",
        commit(),
        comm::library(),
        h5::library(),
        instructions().name(),
        sets.join(", ")
    )
}
