//! Cases as texts.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};

use crate::random::Random;
use crate::{Budget, Met, folder, random};
use files::input::parse;
use files::preflight::{advice, approaches, beginning, warnings};

/// What stands between two texts in a file of texts.
const BETWEEN: &str = "\n#%%%%\n";
/// Longer texts are not changed further.
const LONGEST: usize = 2000;
/// A long run keeps so many of its new texts, the shortest.
const MOST_KEPT: usize = 20;
/// Cases with more particles are not looked at beyond their reading.
const MOST_PARTICLES: u64 = 100_000;

/// Words that mean something somewhere.
const WORDS: &[&str] = &[
    "0",
    "-1",
    "1e308",
    "-0.0",
    "nan",
    "inf",
    "-inf",
    "true",
    "{}",
    "[]",
    "\"\"",
    "\"none\"",
    "1979-05-27",
    "9223372036854775807",
    "0x7fffffff",
    "\"1 mm\"",
    "\"1e300 m\"",
    "\"-3 spacing\"",
    "\"1e308 spacing\"",
    "\"7 km/s\"",
    "\"1 m/(s\"",
    "\"((((((\"",
    "\"1e-320 us\"",
    "\"°\"",
    "\"20 °C\"",
    "\"1 km/s * (1 - (r / 5 mm)^2)\"",
    "\"1 m/s / (x - x0)\"",
    "\"-2^2^-x\"",
    "\"300 K + 5 K/mm * z\"",
    "\"sqrt(min(\"",
    "* exp(",
    "temperature = ",
    "plastic_strain = 0.1\n",
    "angular_velocity = { rate = [0, 0, \"1e4 rad/s\"], about = [0, 0, 0] }\n",
    "\"2 us\"",
    "\"1 g/cm^3\"",
    "\"1e12 GPa\"",
    "\"0 K\"",
    "\"+z\"",
    "\"-x\"",
    "[0, 0, 0]",
    "[0, 0]",
    "[0]",
    "[\"1 mm\", \"1 mm\", \"1 mm\"]",
    "dimension = 1\n",
    "dimension = 2\n",
    "spacing = \"1 mm\"\n",
    "[[body]]\n",
    "[[load]]\n",
    "[[plane]]\n",
    "[[symmetry]]\n",
    "[contact]\n",
    "[[contact.pair]]\n",
    "[sph]\n",
    "[material.metal]\n",
    "library = \"copper\"\n",
    "shape.sphere.radius = \"3 mm\"\n",
    "shape.box.size = [\"3 mm\", \"3 mm\"]\n",
    "particles = { file = \"tests/particles/hexes.msh\", unit = \"1 mm\" }\n",
    "touch = { body = \"a\", direction = \"-z\" }\n",
    "rigid = true\n",
    "material = \"metal\"\n",
    "name = \"a\"\n",
    "strength = \"none\"\n",
    "lattice = \"hexagonal\"\n",
    "velocity = { x = \"1 m/s\" }\n",
    "inner_radius = \"1 mm\"",
    "smoothing_length = \"variable\"\n",
    "mode = \"kernel\"\n",
    "mode = \"potential\"\n",
    "#",
    "\"",
    "'''",
    "\\u0000",
    "\u{feff}",
    "\r",
    "é",
];

fn seeds() -> Vec<String> {
    let project = crate::project::root();
    crate::project::enter();
    let mut seeds = vec![include_str!("../bad_inputs/case.toml").to_owned()];
    let mut cases: Vec<_> = fs::read_dir(project.join("inputs"))
        .unwrap()
        .map(|entry| entry.unwrap().path().join("case.toml"))
        .collect();
    cases.sort();
    seeds.extend(
        cases
            .iter()
            .filter_map(|path| fs::read_to_string(path).ok()),
    );
    for name in ["texts.txt", "panics.txt"] {
        let kept = fs::read_to_string(folder().join(name)).unwrap_or_default();
        seeds.extend(kept.split(BETWEEN).map(str::to_owned));
    }
    seeds
}

/// Reads a text as a case, and looks at it as `check` does; gives the message.
fn attempt(text: &str, overrides: &[String]) -> String {
    let case = match parse("case.toml", text, overrides) {
        Ok(case) => case,
        Err(error) => return error.to_string(),
    };
    let count = |body| populate::count(body, case.dimension, &case.symmetry, None);
    if case.bodies.iter().map(count).sum::<u64>() > MOST_PARTICLES {
        return "sound and large".to_owned();
    }
    let pairs = approaches(&case);
    let mut said = warnings(&case, &pairs);
    said.extend(advice(&case, &pairs));
    said.extend(pairs.iter().map(|pair| format!("gap {}", pair.gap)));
    said.extend(case.bodies.iter().filter_map(|body| {
        let begins = beginning(&case, body)?;
        begins.contains("NaN").then_some(begins)
    }));
    parse("resolved", &case.resolved, &[]).expect("a resolved case can be read again");
    format!("sound {}", "and doubtful ".repeat(said.len().min(3)))
}

fn word_at(text: &str, at: usize) -> std::ops::Range<usize> {
    let inside = |c: char| c.is_alphanumeric() || "_.-+^".contains(c);
    let begin = text[..at].rfind(|c| !inside(c)).map_or(0, |n| n + 1);
    let begin = (begin..=at)
        .find(|&n| text.is_char_boundary(n))
        .unwrap_or(at);
    let end = text[at..]
        .find(|c| !inside(c))
        .map_or(text.len(), |n| at + n);
    begin..end
}

fn place(text: &str, random: &mut Random) -> usize {
    let mut at = random.below(text.len() + 1);
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    at
}

/// A text with some places changed.
fn change(text: &str, other: &str, random: &mut Random) -> String {
    let mut text = text.to_owned();
    for _ in 0..=random.below(4) {
        let at = place(&text, random);
        let word = WORDS[random.below(WORDS.len())];
        match random.below(9) {
            0 => text.replace_range(word_at(&text, at), word),
            1 => text.insert_str(at, word),
            2 => {
                let end = text[at..].find('\n').map_or(text.len(), |n| at + n);
                text.replace_range(at..end, word);
            }
            3 | 4 => {
                // The value of a key.
                let Some(n) = text[at..].find("= ") else {
                    continue;
                };
                let begin = at + n + 2;
                let end = text[begin..].find(['\n', ',', '}', ']']);
                let end = end.map_or(text.len(), |n| begin + n);
                text.replace_range(begin..end, word);
            }
            5 => {
                // A digit.
                let Some(n) = text[at..].find(|c: char| c.is_ascii_digit()) else {
                    continue;
                };
                let digit = random.below(10).to_string();
                text.replace_range(at + n..=at + n, &digit);
            }
            6 => {
                // A line of another text.
                let from = place(other, random);
                let line = other[from..].lines().nth(1).unwrap_or_default();
                let end = text[at..].find('\n').map_or(text.len(), |n| at + n);
                text.insert_str(end, &format!("\n{line}"));
            }
            7 => {
                // A line less.
                let begin = text[..at].rfind('\n').map_or(0, |n| n + 1);
                let end = text[at..].find('\n').map_or(text.len(), |n| at + n + 1);
                text.replace_range(begin..end, "");
            }
            _ => {
                let end = place(&text, random);
                text.replace_range(at.min(end)..at.max(end).min(at.min(end)), "");
                if random.below(20) == 0 {
                    text.truncate(at.min(text.len()));
                }
            }
        }
    }
    text
}

#[test]
fn no_text_makes_the_reader_panic() {
    read(&Budget::new(300));
}

#[test]
#[ignore = "slow: more of the same"]
fn no_text_of_many_makes_the_reader_panic() {
    read(&Budget::new(10_000));
}

fn read(budget: &Budget) {
    let mut random = random(budget);
    let (mut met, mut seeds) = (Met::default(), seeds());
    let (begun, mut done) = (seeds.len(), 0);
    while done < begun || budget.allows(done) {
        let pick = random.below(seeds.len());
        let other = random.below(seeds.len());
        let (text, overrides) = if done < begun {
            (seeds[done].clone(), Vec::new())
        } else if random.below(8) == 0 {
            let line = seeds[other]
                .lines()
                .nth(random.below(40))
                .unwrap_or_default();
            let line = change(&line.replace(" = ", "="), &seeds[pick], &mut random);
            (seeds[pick].clone(), vec![line])
        } else {
            (change(&seeds[pick], &seeds[other], &mut random), Vec::new())
        };
        done += 1;
        let tried = catch_unwind(AssertUnwindSafe(|| attempt(&text, &overrides)));
        let Ok(message) = tried else {
            keep("panics.txt", &text);
            panic!("this text, kept in tests/fuzz/panics.txt, with {overrides:?}:\n{text}");
        };
        if met.is_new(&message) && done > begun && text.len() < LONGEST && overrides.is_empty() {
            seeds.push(text);
        }
    }
    if budget.keeps() {
        let new = &mut seeds[begun..];
        new.sort_by_key(String::len);
        for text in new.iter().take(MOST_KEPT) {
            keep("texts.txt", text);
        }
    }
    eprintln!(
        "{done} texts, {} messages, {begun} texts to begin with",
        met.count()
    );
}

/// Adds a text to a file of texts.
fn keep(name: &str, text: &str) {
    let path = folder().join(name);
    let old = fs::read_to_string(&path).unwrap_or_default();
    let between = if old.is_empty() { "" } else { BETWEEN };
    fs::write(path, old + between + text).unwrap();
}
