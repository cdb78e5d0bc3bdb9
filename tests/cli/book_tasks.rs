//! What pages of the book let one type is done as they say: each block, in turn, in one folder.

use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::Path;

use crate::pages::{Block, blocks};
use crate::program::{Ended, WHIPPLE, command, end, project};

/// A folder with the program on the path.
struct Desk {
    place: tempfile::TempDir,
}

impl Desk {
    fn new() -> Self {
        let place = tempfile::tempdir().unwrap();
        // The package is read where it stands; `python_package` installs it.
        fs::create_dir(place.path().join("bin")).unwrap();
        symlink(WHIPPLE, place.path().join("bin/whipple")).unwrap();
        Self { place }
    }

    /// The same, on which runs and sweeps end after a few steps.
    fn of_few_steps() -> Self {
        let desk = Self::new();
        let program = desk.place.path().join("bin/whipple");
        let script = format!(
            "#!/bin/sh\ncase $1 in run|sweep) set -- \"$@\" --set run.max_steps=4;; esac\nexec '{WHIPPLE}' \"$@\"\n"
        );
        fs::remove_file(&program).unwrap();
        fs::write(&program, script).unwrap();
        fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).unwrap();
        desk
    }

    fn run(&self, program: impl AsRef<Path>, flags: &[&str], text: &str) -> Ended {
        let mut command = command(program.as_ref().to_str().unwrap());
        let path = std::env::var("PATH").unwrap();
        let bin = self.place.path().join("bin");
        command.env("PATH", format!("{}:{path}", bin.display()));
        command.env("PYTHONPATH", project("python/src"));
        command.args(flags).arg(text);
        end(command.current_dir(self.place.path()))
    }

    fn shell(&self, text: &str) {
        for line in text.lines() {
            self.run("bash", &["-c"], line).with_code(0);
        }
    }

    fn case(&self) -> std::path::PathBuf {
        self.place.path().join("impact/case.toml")
    }

    /// A part of a case: a table goes to its end, a shape in the place of the sphere's.
    fn edit(&self, part: &str) {
        let mut text = fs::read_to_string(self.case()).unwrap();
        if part.starts_with("shape.") {
            let old = text.lines().find(|line| line.starts_with("shape.sphere"));
            text = text.replace(old.expect("a sphere"), part.trim());
        } else {
            text.push_str(part);
        }
        fs::write(self.case(), text).unwrap();
    }
}

#[test]
#[ignore = "slow"]
fn ten_first_tasks_are_done_as_the_page_says() {
    do_first_tasks(&Desk::of_few_steps());
}

#[test]
#[ignore = "slow: cases to their ends"]
fn ten_first_tasks_are_done_to_their_ends() {
    do_first_tasks(&Desk::new());
}

fn do_first_tasks(desk: &Desk) {
    let page = fs::read_to_string(project("docs/src/guide/tasks.md")).unwrap();
    let python = crate::python::python();
    let mut original = None;
    let mut tasks = 0;
    for section in page.split("\n## ") {
        // Each task begins with the case as it was.
        if let Some(original) = &original {
            fs::write(desk.case(), original).unwrap();
            tasks += 1;
        }
        for Block { kind, text } in blocks(section) {
            match kind.as_str() {
                "sh" if text.starts_with("pip ") => {}
                "sh" => desk.shell(&text),
                "toml" => desk.edit(&text),
                "python" => {
                    let Some(python) = &python else { continue };
                    let told = desk.run(python, &["-c"], &text).with_code(0);
                    assert!(told.stdout.ends_with("m/s\n"), "{told:#?}");
                }
                other => panic!("a block of {other}"),
            }
        }
        original = original.or_else(|| Some(fs::read_to_string(desk.case()).unwrap()));
    }
    assert_eq!(tasks, 10);
    let left = |name: &str| desk.place.path().join(name);
    for name in [
        "model.png",
        "part.png",
        "impact.gif",
        "view.apng",
        "spacings.html",
        "runs/impact/export/snapshots.xyz",
        "impact.job",
    ] {
        assert!(left(name).exists(), "{name}");
    }
}

fn page(name: &str) -> Vec<Block> {
    blocks(&fs::read_to_string(project(&format!("docs/src/guide/{name}.md"))).unwrap())
}

#[test]
#[ignore = "slow: ready cases at their own spacings"]
fn recipes_are_commands_that_run() {
    let desk = Desk::of_few_steps();
    for Block { text, .. } in page("recipes") {
        // In so few steps nothing gets to a wall or behind a plate.
        let later = ["--distributions", "--bisect", "--sweep"];
        let lines = text
            .lines()
            .filter(|line| !later.iter().any(|word| line.contains(word)));
        desk.shell(&lines.collect::<Vec<_>>().join("\n"));
    }
}

#[test]
#[ignore = "slow: a case at its own spacing"]
fn a_case_of_ones_own_is_built_as_the_page_says() {
    let desk = Desk::of_few_steps();
    let all = page("build-a-case");
    let case: String = all
        .iter()
        .filter(|block| block.kind == "toml")
        .map(|block| &*block.text)
        .collect();
    for Block { kind, text } in &all {
        if kind == "sh" {
            desk.shell(text);
        } else {
            fs::write(desk.place.path().join("my-plate/case.toml"), &case).unwrap();
        }
    }
}
