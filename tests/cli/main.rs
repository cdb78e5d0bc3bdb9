//! The program as a user starts it, the book, the clients in Python.

#[path = "../common/program.rs"]
mod program;
#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/project.rs"]
mod project;
#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/sentinel.rs"]
mod sentinel;
#[allow(dead_code, reason = "rooms share it, and each uses a part")]
#[path = "../common/stored.rs"]
mod stored;

mod bench;
mod book;
mod book_tasks;
mod check;
mod clients;
mod explain;
mod export;
mod fault;
mod folder;
mod fork;
mod input;
mod instructions;
mod jobs;
mod json;
mod keep;
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
mod kill;
mod limit;
mod measure;
mod memory;
mod new;
mod pages;
mod plan;
mod python;
mod python_package;
mod replay;
mod report;
mod restart;
mod run;
mod serial;
mod slurm;
mod stop;
mod sweep;
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
#[allow(
    clippy::cast_possible_truncation,
    clippy::cast_possible_wrap,
    clippy::cast_sign_loss,
    reason = "registers hold what they hold"
)]
mod system_calls;
mod trouble;
mod watch;
