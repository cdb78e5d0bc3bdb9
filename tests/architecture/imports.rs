//! Which file of `src/` imports which, and the circles among them.

use std::collections::{BTreeMap, BTreeSet};

use super::source::{Reference, Source};

/// For each file the files whose names it takes, each with one line where it does so.
pub type Imports = BTreeMap<String, BTreeMap<String, usize>>;

/// Files by their modules: `["output", "h5"]` for `output/h5/mod.rs`.
type Files<'a> = BTreeMap<Vec<String>, (&'a Source, Vec<Reference>)>;

/// Reads who imports whom. An import leads to the file that declares the name: what a file passes
/// on (`pub use`) is followed, and is an import of that file only if the file itself uses the name.
/// What a parent takes from the files in its own folder does not count.
pub fn imports(sources: &[Source]) -> Imports {
    let files: Files = sources
        .iter()
        .filter(|source| source.name != "main.rs")
        .map(|source| (source.module(), (source, source.paths())))
        .collect();
    let mut imports = Imports::new();
    for (module, (source, references)) in &files {
        let taken = imports.entry(source.name.clone()).or_default();
        for reference in references {
            let idle = reference.passed_on && source.count(&reference.alias) == 1;
            if let Some(file) = declaring(&files, &path(&files, module, reference), 0)
                && !file.starts_with(&folder(source))
                && file != source.name
                && !idle
            {
                taken.entry(file.to_owned()).or_insert(reference.line);
            }
        }
    }
    imports
}

/// Where the children of a file stand.
fn folder(source: &Source) -> String {
    let module = source.module();
    let ends = if module.is_empty() { "" } else { "/" };
    format!("{}{ends}", module.join("/"))
}

/// The path from the crate's root, or nothing for one that leads elsewhere.
fn path(files: &Files, module: &[String], reference: &Reference) -> Vec<String> {
    let below = [module, &reference.segments[..1]].concat();
    match reference.segments[0].as_str() {
        "crate" => reference.segments[1..].to_vec(),
        _ if files.contains_key(&below) => [module, &reference.segments].concat(),
        _ => Vec::new(),
    }
}

/// The file that declares what a path names.
fn declaring<'a>(files: &Files<'a>, path: &[String], depth: usize) -> Option<&'a str> {
    let known = (1..=path.len())
        .rev()
        .find(|n| files.contains_key(&path[..*n]))?;
    let (module, rest) = path.split_at(known);
    let (source, references) = &files[module];
    // A name that the file itself imports lies farther on; names that go round end here.
    let farther = rest.first().filter(|_| depth < 8).and_then(|name| {
        let same = |reference: &&Reference| reference.alias == *name;
        let reference = references.iter().find(same)?;
        let onward = [&self::path(files, module, reference), &rest[1..]].concat();
        declaring(files, &onward, depth + 1)
    });
    farther.or(Some(&source.name))
}

/// The sets of files that lead to each other.
pub fn circles(imports: &Imports) -> BTreeSet<BTreeSet<&str>> {
    let reached: BTreeMap<&str, BTreeSet<&str>> = imports
        .keys()
        .map(|file| (file.as_str(), reach(imports, file)))
        .collect();
    let circle = |file: &str| -> BTreeSet<&str> {
        let back = |other: &&str| reached[other].contains(file);
        reached[file].iter().copied().filter(back).collect()
    };
    let circles = imports.keys().map(|file| circle(file));
    circles.filter(|circle| !circle.is_empty()).collect()
}

/// All files to which a file leads.
fn reach<'a>(imports: &'a Imports, file: &str) -> BTreeSet<&'a str> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<&str> = imports[file].keys().map(String::as_str).collect();
    while let Some(next) = open.pop() {
        if reached.insert(next) {
            open.extend(imports[next].keys().map(String::as_str));
        }
    }
    reached
}

#[cfg(test)]
mod tests {
    use super::{circles, imports};
    use crate::source::Source;

    fn found(files: &[(&str, &str)]) -> Vec<Vec<String>> {
        let read = |(name, text): &(&str, &str)| Source::new(name, (*text).to_owned());
        let sources: Vec<Source> = files.iter().map(read).collect();
        let owned = |circle: &std::collections::BTreeSet<&str>| {
            circle.iter().map(|file| (*file).to_owned()).collect()
        };
        circles(&imports(&sources)).iter().map(owned).collect()
    }

    #[test]
    fn finds_a_circle_through_the_name_that_a_parent_passes_on() {
        let files = [
            ("a/mod.rs", "pub use b::B; pub use c::C; mod b; mod c;"),
            ("a/b.rs", "use super::C; pub struct B(C);"),
            (
                "a/c.rs",
                "use crate::a::B as Other; pub struct C(Vec<Other>);",
            ),
        ];
        assert_eq!(found(&files), [["a/b.rs", "a/c.rs"]]);
    }

    #[test]
    fn what_is_passed_on_but_not_used_is_no_import() {
        let idle = ("a.rs", "pub use crate::b::B; pub struct A;");
        let busy = ("a.rs", "pub use crate::b::B; pub struct A(B);");
        let other = ("b.rs", "use super::a::A; pub struct B;");
        assert!(found(&[idle, other]).is_empty());
        assert_eq!(found(&[busy, other]), [["a.rs", "b.rs"]]);
    }

    #[test]
    fn a_parent_may_gather_what_its_children_declare() {
        let parent = ("a/mod.rs", "mod b; pub enum A { B(b::B) } pub trait Law {}");
        let child = ("a/b.rs", "use super::Law; pub struct B; impl Law for B {}");
        assert!(found(&[parent, child]).is_empty());
    }
}
