//! Source files read as tokens: without comments, strings and unit tests, with `use` trees
//! unfolded into full paths.

use std::fs;
use std::path::{Path, PathBuf};

/// How rayon's iterators begin, and how they end in one value.
const PARALLEL: &[&str] = &["par_", "into_par_"];
const REDUCTIONS: &[&str] = &[
    "sum",
    "product",
    "reduce",
    "reduce_with",
    "try_reduce",
    "fold",
    "fold_with",
];

/// An identifier, a `::`, or one other character, with its line.
#[derive(Debug, Clone)]
pub struct Token {
    pub text: String,
    pub line: usize,
}

/// One file of `src/`.
pub struct Source {
    /// Path below `src/`.
    pub name: String,
    /// First folder of that path; empty for `lib.rs` and `main.rs`.
    pub module: String,
    pub text: String,
    /// Without comments, strings and unit tests.
    pub tokens: Vec<Token>,
}

/// A path as written, with `self` and `super` resolved.
#[derive(Debug)]
pub struct Reference {
    pub segments: Vec<String>,
    pub line: usize,
    /// What a `use` calls it in this file; empty for a path elsewhere.
    pub alias: String,
    /// Whether it stands in a `pub use`, of any visibility.
    pub passed_on: bool,
}

impl Reference {
    /// The path below the crate, `comm::Exchange`, or nothing for a path that leads elsewhere.
    pub fn named(&self) -> String {
        match self.segments[0].as_str() {
            "crate" | "whipple" => self.segments[1..].join("::"),
            _ => String::new(),
        }
    }

    pub fn names_module(&self, module: &str) -> bool {
        self.named().split("::").next() == Some(module)
    }

    pub fn is_of_crate(&self, name: &str) -> bool {
        self.segments[0] == name
    }
}

impl Source {
    pub fn read(path: &Path) -> Self {
        let name = path.strip_prefix(src()).expect("a file of src");
        let text = fs::read_to_string(path).expect("a source file is read");
        Self::new(&name.to_string_lossy(), text)
    }

    pub fn new(name: &str, text: String) -> Self {
        let module = name
            .split_once('/')
            .map_or("", |(module, _)| module)
            .to_owned();
        let tokens = without_unit_tests(&tokens(&text));
        Self {
            name: name.to_owned(),
            module,
            text,
            tokens,
        }
    }

    /// The modules that lead to this file: `["output", "h5"]` for `output/h5/mod.rs`.
    pub fn module(&self) -> Vec<String> {
        let stem = self.name.trim_end_matches(".rs");
        let mut module: Vec<String> = stem.split('/').map(str::to_owned).collect();
        if ["mod", "lib", "main"].contains(&module.last().map_or("", String::as_str)) {
            module.pop();
        }
        module
    }

    /// Every imported name, and every path of at least two segments elsewhere.
    pub fn paths(&self) -> Vec<Reference> {
        let mut found = Vec::new();
        let mut at = 0;
        while at < self.tokens.len() {
            if self.text_at(at) == "use" {
                let first = found.len();
                let passed_on = at > 0 && ["pub", ")"].contains(&self.text_at(at - 1));
                at = self.use_tree(at + 1, &[], &mut found);
                for reference in &mut found[first..] {
                    reference.passed_on = passed_on;
                }
            } else if is_name(self.text_at(at)) {
                let line = self.tokens[at].line;
                let mut segments = vec![self.text_at(at).to_owned()];
                let begins = !self.goes_on(at);
                at += 1;
                while self.text_at(at) == "::" && is_name(self.text_at(at + 1)) {
                    segments.push(self.text_at(at + 1).to_owned());
                    at += 2;
                }
                if begins && segments.len() > 1 {
                    found.push(Reference {
                        segments,
                        line,
                        alias: String::new(),
                        passed_on: false,
                    });
                }
            } else {
                at += 1;
            }
        }
        for reference in &mut found {
            self.resolve(reference);
        }
        found
    }

    /// Whether the name at `at` is the tail of a path that does not begin with a name,
    /// as in `Vec::<u8>::new`.
    fn goes_on(&self, at: usize) -> bool {
        at > 1 && self.text_at(at - 1) == "::" && self.text_at(at - 2) == ">"
    }

    /// Unfolds the `use` tree at `at` below `prefix`; returns the place of the `,`, `}` or `;`
    /// that ends it.
    fn use_tree(&self, mut at: usize, prefix: &[String], found: &mut Vec<Reference>) -> usize {
        let mut segments = prefix.to_vec();
        let mut alias = None;
        let line = self.tokens.get(at).map_or(0, |token| token.line);
        loop {
            match self.text_at(at) {
                "::" => {}
                "{" => {
                    while !["}", ""].contains(&self.text_at(at)) {
                        at = self.use_tree(at + 1, &segments, found);
                    }
                    return at + 1;
                }
                "as" => {
                    at += 1;
                    alias = Some(self.text_at(at).to_owned());
                }
                "," | "}" | ";" | "" => break,
                name => segments.push(name.to_owned()),
            }
            at += 1;
        }
        if segments.len() > prefix.len() {
            let last = segments.iter().rev().find(|segment| *segment != "self");
            found.push(Reference {
                alias: alias.or(last.cloned()).unwrap_or_default(),
                segments,
                line,
                passed_on: false,
            });
        }
        at
    }

    /// Replaces leading `self` and `super` by the path from the crate's root.
    fn resolve(&self, reference: &mut Reference) {
        let mut module = self.module();
        let segments = &mut reference.segments;
        let relative = segments
            .iter()
            .take_while(|s| ["self", "super"].contains(&s.as_str()));
        let count = relative.clone().count();
        let levels = relative.filter(|s| *s == "super").count();
        if count > 0 {
            module.truncate(module.len().saturating_sub(levels));
            let tail = segments.split_off(count);
            *segments = [vec!["crate".to_owned()], module, tail].concat();
        }
    }

    /// Every function with a body: its name, its first line and how many lines it has.
    pub fn functions(&self) -> Vec<(&str, usize, usize)> {
        let begins = |at: &usize| self.text_at(*at) == "fn" && is_name(self.text_at(at + 1));
        let starts = (0..self.tokens.len()).filter(begins);
        starts
            .filter_map(|start| {
                let (mut depth, mut brackets) = (0_i32, 0_i32);
                for token in &self.tokens[start..] {
                    match token.text.as_str() {
                        "{" => depth += 1,
                        "}" => depth -= 1,
                        "(" | "[" => brackets += 1,
                        ")" | "]" => brackets -= 1,
                        // Declared only, as in a trait; not the `;` of `[u8; 4]`.
                        ";" if depth == 0 && brackets == 0 => return None,
                        _ => continue,
                    }
                    if depth == 0 && token.text == "}" {
                        let first = self.tokens[start].line;
                        return Some((self.text_at(start + 1), first, token.line - first + 1));
                    }
                }
                None
            })
            .collect()
    }

    /// How often a name stands in the file.
    pub fn count(&self, name: &str) -> usize {
        self.tokens
            .iter()
            .filter(|token| token.text == name)
            .count()
    }

    /// Names called as methods, `.name(` or `.name::<T>(`.
    pub fn methods(&self) -> Vec<(usize, &str)> {
        self.tokens
            .windows(3)
            .filter(|w| {
                w[0].text == "." && is_name(&w[1].text) && ["(", "::"].contains(&w[2].text.as_str())
            })
            .map(|w| (w[1].line, w[1].text.as_str()))
            .collect()
    }

    /// Names taken from the type, `f64::name`.
    pub fn functions_of_f64(&self) -> Vec<(usize, &str)> {
        self.tokens
            .windows(3)
            .filter(|w| ["f64", "f32"].contains(&w[0].text.as_str()) && w[1].text == "::")
            .map(|w| (w[2].line, w[2].text.as_str()))
            .collect()
    }

    /// Reductions of rayon's iterators, whose order is that of the threads.
    pub fn parallel_reductions(&self) -> Vec<(usize, String)> {
        let parallel = |token: &Token| PARALLEL.iter().any(|start| token.text.starts_with(start));
        let mut found = Vec::new();
        for start in (0..self.tokens.len()).filter(|at| parallel(&self.tokens[*at])) {
            // What stands inside a closure of the chain is sequential: only depth 0 counts.
            let mut depth = 0_i32;
            for pair in self.tokens[start..].windows(2) {
                match pair[0].text.as_str() {
                    "(" | "{" | "[" => depth += 1,
                    ")" | "}" | "]" => depth -= 1,
                    "." if depth == 0 && REDUCTIONS.contains(&pair[1].text.as_str()) => {
                        found.push((pair[1].line, format!("parallel {}", pair[1].text)));
                    }
                    _ => {}
                }
                if depth < 0 || (depth == 0 && pair[0].text == ";") {
                    break;
                }
            }
        }
        found
    }

    /// Whether a comment on the line, or in the comment above it, has the words.
    pub fn says(&self, line: usize, words: &str) -> bool {
        let lines: Vec<&str> = self.text.lines().collect();
        let above = lines[..line - 1]
            .iter()
            .rev()
            .take_while(|text| text.trim_start().starts_with("//"));
        std::iter::once(&lines[line - 1]).chain(above).any(|text| {
            text.split_once("//")
                .is_some_and(|(_, comment)| comment.contains(words))
        })
    }

    /// Lines where one thread goes over all particles of a rank: `0..owned`, or an iterator over a field of the
    /// store, without rayon's.
    pub fn lone_loops(&self) -> Vec<usize> {
        let lines = self.tokens.chunk_by(|a, b| a.line == b.line);
        let is_lone = |line: &&[Token]| {
            let words: String = line.iter().map(|token| token.text.as_str()).collect();
            let counts = words.contains("0..owned") || words.contains("0..particles.owned()");
            let iterates = words.split("particles.").skip(1).any(|rest| {
                let field = |c: char| !c.is_alphanumeric() && c != '_';
                let after = rest.trim_start_matches(|c| !field(c));
                after.starts_with(".iter()") || after.starts_with(".iter_mut()")
            });
            (counts || iterates) && !words.contains("par_") && !words.contains("0..owned.div_ceil")
        };
        lines.filter(is_lone).map(|line| line[0].line).collect()
    }

    fn text_at(&self, at: usize) -> &str {
        self.tokens.get(at).map_or("", |token| token.text.as_str())
    }
}

/// Whether a token is an identifier that can stand in a path.
fn is_name(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Splits Rust source into tokens, leaving out comments, strings and character literals.
fn tokens(text: &str) -> Vec<Token> {
    let characters: Vec<char> = text.chars().collect();
    let (mut found, mut at, mut line) = (Vec::new(), 0, 1);
    while at < characters.len() {
        let rest = &characters[at..];
        let length = match rest {
            ['/', '/', ..] => rest.iter().position(|c| *c == '\n').unwrap_or(rest.len()),
            ['/', '*', ..] => block_comment(rest),
            ['"', ..] => string(rest),
            ['\'', ..] => character(rest),
            [c, ..] if c.is_alphanumeric() || *c == '_' => {
                let word = rest
                    .iter()
                    .take_while(|c| c.is_alphanumeric() || **c == '_')
                    .count();
                raw_string(rest, word).unwrap_or_else(|| {
                    found.push(Token {
                        text: rest[..word].iter().collect(),
                        line,
                    });
                    word
                })
            }
            [':', ':', ..] => {
                found.push(Token {
                    text: "::".to_owned(),
                    line,
                });
                2
            }
            [c, ..] => {
                if !c.is_whitespace() {
                    found.push(Token {
                        text: c.to_string(),
                        line,
                    });
                }
                1
            }
            [] => unreachable!("the loop ends before the text does"),
        };
        line += rest[..length].iter().filter(|c| **c == '\n').count();
        at += length;
    }
    found
}

/// Length of a `/* … */`, which may nest.
fn block_comment(rest: &[char]) -> usize {
    let (mut depth, mut at) = (0, 0);
    while at < rest.len() {
        match rest[at..] {
            ['/', '*', ..] => (depth, at) = (depth + 1, at + 2),
            ['*', '/', ..] => (depth, at) = (depth - 1, at + 2),
            _ => at += 1,
        }
        if depth == 0 {
            break;
        }
    }
    at
}

/// Length of a `"…"` with its escapes.
fn string(rest: &[char]) -> usize {
    let mut at = 1;
    while at < rest.len() && rest[at] != '"' {
        at += if rest[at] == '\\' { 2 } else { 1 };
    }
    (at + 1).min(rest.len())
}

/// Length of a raw string, if the word of length `word` begins one (`r"…"`, `br#"…"#`).
fn raw_string(rest: &[char], word: usize) -> Option<usize> {
    let prefix: String = rest[..word].iter().collect();
    if !["r", "br", "cr"].contains(&prefix.as_str()) {
        return None;
    }
    let hashes = rest[word..].iter().take_while(|c| **c == '#').count();
    let start = word + hashes;
    if rest.get(start) != Some(&'"') {
        return None;
    }
    let end: Vec<char> = std::iter::once('"')
        .chain(std::iter::repeat_n('#', hashes))
        .collect();
    let body = rest[start + 1..]
        .windows(end.len())
        .position(|w| w == end)?;
    Some(start + 1 + body + end.len())
}

/// Length of a character literal, or 1 for the quote of a lifetime.
fn character(rest: &[char]) -> usize {
    match rest {
        ['\'', '\\', _, tail @ ..] => tail
            .iter()
            .position(|c| *c == '\'')
            .map_or(rest.len(), |end| end + 4),
        ['\'', _, '\'', ..] => 3,
        _ => 1,
    }
}

/// Drops each item behind `#[cfg(test)]`, up to its closing brace or semicolon.
fn without_unit_tests(tokens: &[Token]) -> Vec<Token> {
    let mark = ["#", "[", "cfg", "(", "test", ")", "]"];
    let mut kept = Vec::new();
    let mut at = 0;
    while at < tokens.len() {
        let marked = tokens.len() - at >= mark.len()
            && tokens[at..]
                .iter()
                .zip(mark)
                .all(|(token, text)| token.text == text);
        if !marked {
            kept.push(tokens[at].clone());
            at += 1;
            continue;
        }
        let mut depth = 0_i32;
        at += mark.len();
        while at < tokens.len() {
            let text = tokens[at].text.as_str();
            depth += i32::from(text == "{") - i32::from(text == "}");
            at += 1;
            if depth == 0 && (text == "}" || text == ";") {
                break;
            }
        }
    }
    kept
}

pub fn src() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Every file of `src/` but those of unit tests (`tests.rs`, `tests/`), in the order of names.
pub fn sources() -> Vec<Source> {
    let (mut folders, mut files) = (vec![src()], Vec::new());
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder).expect("a folder of src is read") {
            let path = entry.expect("an entry of src").path();
            let unit_tests = path.file_stem().is_some_and(|stem| stem == "tests");
            if path.is_dir() && !unit_tests {
                folders.push(path);
            } else if !unit_tests && path.extension().is_some_and(|extension| extension == "rs") {
                files.push(path);
            }
        }
    }
    files.sort();
    files.iter().map(|path| Source::read(path)).collect()
}

#[cfg(test)]
mod tests {
    use super::Source;

    fn names(file: &str, text: &str) -> Vec<String> {
        let source = Source::new(file, text.to_owned());
        source
            .paths()
            .iter()
            .map(|path| path.segments.join("::"))
            .collect()
    }

    #[test]
    fn unfolds_use_trees_and_sees_paths_in_expressions() {
        let text = "use crate::{comm::{self, Exchange as E}, model::Case};\n\
                    pub use mpi;\n\
                    fn f() -> crate::step::Vote { println!(\"{}\", ::hdf5::version()) }";
        assert_eq!(
            names("sph/mod.rs", text),
            [
                "crate::comm::self",
                "crate::comm::Exchange",
                "crate::model::Case",
                "mpi",
                "crate::step::Vote",
                "hdf5::version",
            ]
        );
    }

    #[test]
    fn resolves_self_and_super() {
        assert_eq!(
            names("sph/pair/force.rs", "use super::super::super::comm::X;"),
            ["crate::comm::X"]
        );
        assert_eq!(
            names("sph/mod.rs", "use self::pair::y;"),
            ["crate::sph::pair::y"]
        );
    }

    #[test]
    fn leaves_out_comments_strings_and_unit_tests() {
        let text = "// crate::a::b\n/* /* crate::c */ crate::d */ const S: &str = r#\"crate::\"e\"#;\n\
                    const Q: char = '\"'; fn f<'a>(x: &'a str) { g(\"\\\"crate::f\") }\n\
                    #[cfg(test)]\nmod tests { use crate::comm::X; fn f() { if true {} } }\n\
                    use crate::kept;";
        assert_eq!(names("sph/mod.rs", text), ["crate::kept"]);
    }

    #[test]
    fn tells_parallel_reductions_from_sums_inside_a_closure() {
        let text = "let a: f64 = x.par_iter().map(|v| { let s = v.iter().sum::<f64>(); s }).collect();\n\
                    // the minimum has the same bits in any order\n\
                    let b = x.par_iter().copied().reduce(f64::NAN, min);\n\
                    let c = x\n    .into_par_iter()\n    .fold(zero, |a, b| { let c = a; c + b })\n    .sum::<f64>();";
        let source = Source::new("sph/mod.rs", text.to_owned());
        let found = source.parallel_reductions();
        assert_eq!(
            found.iter().map(|(line, _)| *line).collect::<Vec<_>>(),
            [3, 6, 7]
        );
        assert!(source.says(3, "same bits in any order"));
        assert!(!source.says(6, "same bits in any order"));
    }
}
