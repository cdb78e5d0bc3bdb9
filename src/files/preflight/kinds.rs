//! Warnings that are alike, of which the first few stand for all.

use std::collections::HashMap;

/// Warnings of a kind that are shown.
const SHOWN: usize = 3;

/// The first few of each kind with the number of its others, kinds in the order of their first.
///
/// Two are alike if they differ in names and numbers alone.
#[must_use]
pub fn shortened(warnings: &[String]) -> Vec<String> {
    let mut kinds: Vec<Vec<&String>> = Vec::new();
    let mut known: HashMap<String, usize> = HashMap::new();
    for warning in warnings {
        let place = *known.entry(kind(warning)).or_insert(kinds.len());
        if place == kinds.len() {
            kinds.push(Vec::new());
        }
        kinds[place].push(warning);
    }
    let of_kind = |all: Vec<&String>| {
        let more = all.len().saturating_sub(SHOWN);
        let shown: Vec<String> = all.into_iter().take(SHOWN).cloned().collect();
        let rest = (more > 0)
            .then(|| format!("{more} more like the last: `whipple check --format json` tells all"));
        shown.into_iter().chain(rest)
    };
    kinds.into_iter().flat_map(of_kind).collect()
}

/// A warning without the names and numbers in it.
fn kind(warning: &str) -> String {
    let words = warning.split('`').step_by(2);
    let no_number = |c: char| !(c.is_ascii_digit() || ".-+ ".contains(c));
    words
        .flat_map(|word| word.chars().filter(|&c| no_number(c)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::shortened;

    #[test]
    fn what_differs_in_names_and_numbers_is_told_three_times() {
        let mut all: Vec<String> = (0..9).map(|k| format!("`b{k}` is {k}.5 wide")).collect();
        all.insert(4, "nothing meets".to_owned());
        let told = shortened(&all);
        assert_eq!(told.len(), 5, "{told:?}");
        assert_eq!(told[..3], all[..3]);
        assert!(told[3].starts_with("6 more like the last"), "{told:?}");
        assert_eq!(told[4], "nothing meets");
    }
}
