//! Tells the program which commit it is built from, for its results: `WHIPPLE_COMMIT` of the
//! environment, else what git says in a clone of this project, else nothing.
//!
//! Only optimised builds ask git: it changes with every commit, and with it all would be built
//! and linked anew before each run of the tests.

use std::path::Path;
use std::process::Command;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed=WHIPPLE_COMMIT");
    // Set already, it reaches the compiler by itself.
    if std::env::var_os("WHIPPLE_COMMIT").is_some()
        || std::env::var("PROFILE").as_deref() != Ok("release")
    {
        return;
    }
    // A prefix means that the repository is another one, which only contains this folder.
    if git(&["rev-parse", "--show-prefix"]).as_deref() != Some("") {
        return;
    }
    let Some(commit) = git(&["rev-parse", "--short=12", "HEAD"]) else {
        return;
    };
    println!("cargo::rustc-env=WHIPPLE_COMMIT={commit}");
    // The log of HEAD grows with each commit and checkout; where there is none, HEAD and its
    // branch change. A path that does not exist would run this script on every build.
    let branch = git(&["symbolic-ref", "-q", "HEAD"]);
    for name in ["logs/HEAD", "HEAD", "packed-refs"]
        .into_iter()
        .chain(branch.as_deref())
    {
        if let Some(path) = git(&["rev-parse", "--git-path", name])
            && Path::new(&path).exists()
        {
            println!("cargo::rerun-if-changed={path}");
        }
    }
}

/// What git prints, without the line end; nothing if there is no git or no repository.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim_end().to_owned())
}
