//! The `whipple` program: hands the command line to [`app`] and exits with its code.

fn main() -> std::process::ExitCode {
    app::main(option_env!("WHIPPLE_COMMIT").unwrap_or("unknown"))
}
