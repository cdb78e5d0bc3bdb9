//! Where the project is.

use std::path::Path;
use std::sync::LazyLock;

static ROOT: LazyLock<&Path> = LazyLock::new(|| {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let is_root = |folder: &&Path| folder.join("Cargo.lock").exists();
    let root = package.ancestors().find(is_root);
    root.expect("a folder with Cargo.lock above the package")
});

/// The folder of the whole project, whatever package the test belongs to.
pub fn root() -> &'static Path {
    *ROOT
}

/// Makes the project's folder the current one, from which cases in tests name files.
pub fn enter() {
    std::env::set_current_dir(root()).expect("the project's folder");
}
