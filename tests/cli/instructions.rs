//! Vector instructions of the program stand inside its kernels.

/// Kernels are compiled for an instruction set only where all of them lands inside one function: a closure,
/// or what an array method calls, may be compiled apart, and then each operation on vectors is a call.
#[test]
fn no_vector_instruction_is_called_as_a_function() {
    let listed = std::process::Command::new("nm")
        .args(["--demangle", env!("CARGO_BIN_EXE_whipple")])
        .output()
        .expect("nm, which comes with the linker");
    assert!(listed.status.success(), "{listed:?}");
    let symbols = String::from_utf8_lossy(&listed.stdout);
    assert!(symbols.contains("engine::"), "a program without symbols");
    // Those of doubles, which kernels have; libraries call others.
    let called: Vec<&str> = symbols
        .lines()
        .filter(|line| line.contains("core_arch::") && line.ends_with("_pd"))
        .collect();
    assert!(called.is_empty(), "{}", called.join("\n"));
}
