//! `whipple generate`: what shells, man and editors need to know of the program and of its cases.

mod materials;
mod reference;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use clap::builder::PossibleValuesParser;
use clap::{Command, Subcommand};
use clap_complete::Shell;

use crate::input;
use crate::run::exit::EXIT_INPUT;
use crate::run::say::{say, warn};

/// Write shell completions, man pages, the JSON schema of cases, or pages of the book
#[derive(Debug, clap::Args)]
#[command(after_help = "Examples:
  whipple generate completions bash \\
      > ~/.local/share/bash-completion/completions/whipple
  whipple generate man ~/.local/share/man/man1
  whipple generate schema > whipple.schema.json
  whipple generate reference > input-reference.md
  whipple generate materials > materials.md

An editor completes and checks a case whose first line names the schema, with
the extension \"Even Better TOML\" of VS Code or with Taplo:
  #:schema ./whipple.schema.json")]
pub struct GenerateArgs {
    #[command(subcommand)]
    what: What,
}

#[derive(Debug, Subcommand)]
enum What {
    /// Completions for a shell, to the standard output, with the keys of cases for `--set`
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
pub fn run(args: &GenerateArgs, program: Command) -> u8 {
    match &args.what {
        What::Completions { shell } => {
            let mut text = Vec::new();
            let mut program = with_keys(program);
            clap_complete::generate(*shell, &mut program, "whipple", &mut text);
            let text = String::from_utf8_lossy(&text);
            let text = match shell {
                Shell::Bash => without_spaces(&text),
                _ => text.into_owned(),
            };
            say(text.trim_end());
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
            say(reference::page(&input::described()).trim_end());
            0
        }
        What::Materials => {
            say(materials::page().trim_end());
            0
        }
    }
}

/// The program whose `--set` takes keys of the schema and nothing else, for shells to complete them.
fn with_keys(program: Command) -> Command {
    let words = |keys: BTreeSet<String>| {
        // They last as long as the program, which ends once the script is written.
        let words = keys.into_iter().map(|key| &*format!("{key}=").leak());
        PossibleValuesParser::new(words.collect::<Vec<&'static str>>())
    };
    let (all, few) = (words(input::keys()), words(input::restartable_keys()));
    program.mut_subcommands(|command| {
        if command
            .get_arguments()
            .all(|argument| argument.get_id() != "set")
        {
            return command;
        }
        let keys = match command.get_name() {
            "restart" => few.clone(),
            _ => all.clone(),
        };
        command.mut_arg("set", |argument| argument.value_parser(keys))
    })
}

/// A script for bash in which no space follows the `=` of a key.
fn without_spaces(script: &str) -> String {
    let mut lines = Vec::new();
    for line in script.lines() {
        let words = line.trim_start();
        if words.starts_with("COMPREPLY=") && words.contains("run.end_time=") {
            let indent = &line[..line.len() - words.len()];
            lines.push(format!("{indent}compopt -o nospace"));
        }
        lines.push(line.to_owned());
    }
    lines.join("\n")
}

fn write_pages(program: Command, folder: &Path) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    clap_mangen::generate_to(program, folder)
}
