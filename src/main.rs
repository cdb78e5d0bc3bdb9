//! The `whipple` program: hands the command line to [`app`] and exits with its code.

#[global_allocator]
static MEMORY: app::memory::Memory = app::memory::Memory;

fn main() -> std::process::ExitCode {
    app::main(option_env!("WHIPPLE_COMMIT").unwrap_or("unknown"))
}
