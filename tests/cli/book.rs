//! The book: pages that the program writes are what it writes, commands are what the program takes,
//! and links lead somewhere. None of it needs the network.

use std::fmt::Write as _;
use std::fs;

use crate::pages::{Page, commands, messages, pages, said};
use crate::program::{WHIPPLE, command, end, project};

/// What each page is written by, and where it stands.
const WRITTEN: [(&str, &str); 2] = [
    ("reference", "docs/src/guide/input-reference.md"),
    ("materials", "docs/src/guide/materials.md"),
];

#[test]
fn pages_are_what_the_program_writes() {
    for (what, page) in WRITTEN {
        let written = end(command(WHIPPLE).args(["generate", what]))
            .with_code(0)
            .stdout;
        let committed = fs::read_to_string(project(page)).expect("the page is there");
        assert!(
            written == committed,
            "{page} is an old one: target/release/whipple generate {what} > {page}"
        );
    }
}

/// Each command of a block `sh`, or in the text, is read by the program as far as `--help`, which it
/// prints in place of doing anything: no command has an option or a word that the program lacks.
#[test]
fn the_program_takes_all_commands() {
    let mut wrong = String::new();
    let mut tried = 0;
    for page in pages() {
        for words in commands(&page.text) {
            let told = end(command(WHIPPLE).args(&words).arg("--help"));
            tried += 1;
            if told.code != Some(0) {
                let line = words.join(" ");
                let _ = writeln!(wrong, "{}: whipple {line}\n{}", page.name, told.stderr);
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
    assert!(tried > 60, "{tried} commands");
}

#[test]
fn links_lead_somewhere() {
    let pages = pages();
    let mut wrong = String::new();
    let mut followed = 0;
    for page in &pages {
        for link in page.links() {
            if link.contains("://") {
                continue;
            }
            followed += 1;
            let (path, anchor) = link.split_once('#').unwrap_or((&link, ""));
            let target = page.resolve(path);
            let found = pages.iter().find(|other| other.path == target);
            let broken = match found {
                Some(_) if anchor.is_empty() => false,
                Some(other) => !other.anchors().iter().any(|known| known == anchor),
                None => !target.exists() || !anchor.is_empty(),
            };
            if broken {
                let _ = writeln!(wrong, "{}: {link}", page.name);
            }
        }
    }
    assert!(wrong.is_empty(), "broken links:\n{wrong}");
    assert!(followed > 200, "{followed} links");
}

#[test]
fn the_summary_has_all_pages() {
    let summary = fs::read_to_string(project("docs/src/SUMMARY.md")).expect("a summary");
    for Page { name, .. } in pages() {
        let inside = name.strip_prefix("docs/src/");
        let Some(inside) = inside.filter(|inside| *inside != "SUMMARY.md") else {
            continue;
        };
        assert!(
            summary.contains(&format!("({inside})")),
            "{inside} is in no chapter"
        );
    }
}

/// What `when-it-says.md` quotes is said somewhere in the source, piece by piece between ellipses.
#[test]
fn the_program_says_what_the_book_explains() {
    let page = project("docs/src/guide/when-it-says.md");
    let text = fs::read_to_string(page).expect("the page is there");
    let said = said();
    let messages = messages(&text);
    let unsaid = |message: &&String| {
        let pieces = message.split('…').map(str::trim);
        let mut pieces = pieces.filter(|piece| !piece.is_empty());
        pieces.any(|piece| !said.contains(piece))
    };
    let wrong: Vec<&String> = messages.iter().filter(unsaid).collect();
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert!(messages.len() > 50, "{} messages", messages.len());
}
