//! Exit codes of the program.

/// The run failed.
pub const EXIT_FAILED: u8 = 1;
/// The case, an option or a file that the user named is wrong.
pub const EXIT_INPUT: u8 = 2;
/// The run was asked to stop and has written a checkpoint.
pub const EXIT_STOPPED: u8 = 75;
/// A second Ctrl-C ended the process, by the convention of shells.
pub const EXIT_INTERRUPTED: i32 = 130;
