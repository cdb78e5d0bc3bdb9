//! `whipple generate`: what shells, man and editors need to know of the program and of its cases.

mod materials;
mod reference;

use std::fs;
use std::path::{Path, PathBuf};

use clap::Subcommand;
use clap_complete::Shell;

use crate::input;
use crate::run::exit::EXIT_INPUT;
use crate::run::say::{say, warn};

/// Write shell completions, man pages, the JSON schema of cases, or pages of the book
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple generate completions bash > ~/.local/share/bash-completion/completions/whipple
  whipple generate man ~/.local/share/man/man1
  whipple generate schema > whipple.schema.json
  whipple generate reference > input-reference.md
  whipple generate materials > materials.md

An editor completes and checks a case whose first line names the schema, with the extension
\"Even Better TOML\" of VS Code or with Taplo:
  #:schema ./whipple.schema.json")]
pub struct GenerateArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Completions for a shell, to the standard output
    Completions {
        /// Shell
        shell: Shell,
    },
    /// A man page for each command, into a folder
    Man {
        /// Folder, which is made if it is not there
        folder: PathBuf,
    },
    /// The JSON schema of cases, to the standard output
    Schema,
    /// A page in Markdown of all tables and keys of cases, to the standard output
    Reference,
    /// A page in Markdown of the material library, to the standard output
    Materials,
}

/// Runs the command, given that of the whole program; returns the exit code.
pub fn run(args: &GenerateArgs, program: clap::Command) -> u8 {
    match &args.what {
        What::Completions { shell } => {
            let mut text = Vec::new();
            let mut program = program;
            clap_complete::generate(*shell, &mut program, "whipple", &mut text);
            say(String::from_utf8_lossy(&text).trim_end());
            0
        }
        What::Man { folder } => match write_pages(program, folder) {
            Ok(()) => 0,
            Err(error) => {
                warn(&format!(
                    "error: cannot write {}: {error}",
                    folder.display()
                ));
                EXIT_INPUT
            }
        },
        What::Schema => {
            say(&format!("{:#}", input::schema()));
            0
        }
        What::Reference => {
            say(reference::page(&input::schema()).trim_end());
            0
        }
        What::Materials => {
            say(materials::page().trim_end());
            0
        }
    }
}

fn write_pages(program: clap::Command, folder: &Path) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    clap_mangen::generate_to(program, folder)
}
