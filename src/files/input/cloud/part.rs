//! Parts of a file by name or number.

use super::Fault;

/// Most parts of a file.
pub const MOST_PARTS: usize = 1_000_000;
/// Parts that a message lists.
const LISTED: usize = 20;

/// A part as the input calls it.
#[derive(Debug, Clone, PartialEq)]
pub enum Wanted {
    /// By name, or by number in quotes.
    Name(String),
    /// By number.
    Number(i64),
}

/// A part as the file calls it.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PartName {
    /// Its number, if it has one.
    pub number: Option<i64>,
    /// Its name; may be empty.
    pub name: String,
}

impl PartName {
    fn is(&self, wanted: &Wanted) -> bool {
        match wanted {
            Wanted::Number(number) => self.number == Some(*number),
            Wanted::Name(name) => {
                let number = self.number.map(|number| number.to_string());
                self.name == *name || (self.name.is_empty() && number.as_ref() == Some(name))
            }
        }
    }

    /// True of a name but for large and small letters.
    fn is_nearly(&self, wanted: &Wanted) -> bool {
        matches!(wanted, Wanted::Name(name) if self.name.eq_ignore_ascii_case(name))
    }

    fn words(&self) -> String {
        let name = self.name.chars().take(64).collect::<String>();
        match (self.number, name.is_empty()) {
            (Some(number), true) => number.to_string(),
            (Some(number), false) => format!("{number} (`{name}`)"),
            (None, _) => format!("`{name}`"),
        }
    }
}

/// Flags of the parts of a file that are wanted: of a file that has several, those that are named.
///
/// # Errors
/// If a part is not there, or none is named where there are several.
pub fn choose(parts: &[PartName], wanted: &[Wanted]) -> Result<Vec<bool>, Fault> {
    if wanted.is_empty() {
        if parts.len() > 1 {
            let words = format!(
                "it has several parts, {}: say with `part` of which the body is",
                list(parts)
            );
            return Err(Fault::from(words));
        }
        return Ok(vec![true; parts.len()]);
    }
    let mut chosen = vec![false; parts.len()];
    for one in wanted {
        let mut found: Vec<usize> = places(parts, |part| part.is(one));
        if found.is_empty() {
            // Large and small letters are the same to some programs.
            found = places(parts, |part| part.is_nearly(one));
            found.truncate(usize::from(found.len() == 1));
        }
        if found.is_empty() {
            let name = match one {
                Wanted::Name(name) => name.clone(),
                Wanted::Number(number) => number.to_string(),
            };
            let there = if parts.is_empty() {
                "it tells no parts".to_owned()
            } else {
                format!("there is {}", list(parts))
            };
            return Err(Fault::of(
                "part",
                format!("it has no part `{name}`: {there}"),
            ));
        }
        for place in found {
            chosen[place] = true;
        }
    }
    Ok(chosen)
}

fn places(parts: &[PartName], is_it: impl Fn(&PartName) -> bool) -> Vec<usize> {
    (0..parts.len())
        .filter(|&place| is_it(&parts[place]))
        .collect()
}

fn list(parts: &[PartName]) -> String {
    let mut names: Vec<String> = parts.iter().take(LISTED).map(PartName::words).collect();
    if parts.len() > LISTED {
        names.push("…".to_owned());
    }
    names.join(", ")
}
