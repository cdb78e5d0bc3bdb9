//! The `whipple` program: hands the command line to [`whipple::app`] and exits with its code.

fn main() -> std::process::ExitCode {
    whipple::app::main()
}
