//! Bad inputs, each with the message that its author should get: the tables in `bad_inputs/`, one
//! mistake a line, and two mistakes that are made with every key of the schema.

use std::fs;
use std::path::{Path, PathBuf};

use crate::schema_keys::{Key, caret, key_at, keys};
use files::input::parse;

const SOUND: &str = include_str!("../bad_inputs/case.toml");

/// One line of a table: changes of the sound case in one of its sections, and what is said.
struct Mistake {
    /// Table and line.
    place: String,
    text: String,
    /// Numbers of the lines that are not those of the sound case.
    changed: Vec<usize>,
    said: String,
    /// What the line with the caret must contain, if it is not a changed one.
    at: Option<String>,
}

fn tables() -> Vec<PathBuf> {
    let folder = crate::project::root().join("tests/bad_inputs");
    let entries = fs::read_dir(folder).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "txt"));
    paths.sort();
    paths
}

fn mistakes() -> Vec<Mistake> {
    crate::project::enter();
    let mut found = Vec::new();
    for path in tables() {
        let table = fs::read_to_string(&path).unwrap();
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let mut section = "";
        for (n, line) in table.lines().enumerate() {
            let place = format!("{name}:{}", n + 1);
            if line.is_empty() || line.starts_with("# ") {
                continue;
            }
            match line.split_once("  ! ") {
                Some((changes, said)) => found.push(mistake(place, section, changes, said)),
                None => section = line,
            }
        }
    }
    found
}

/// The sound case with `changes` of a section: `key = value` for another value, `-key` for none,
/// `+line` for a line at the section's end; several with ` ;; ` between.
fn mistake(place: String, section: &str, changes: &str, said: &str) -> Mistake {
    let mut lines: Vec<String> = SOUND.lines().map(str::to_owned).collect();
    let begin = match section {
        "(top)" => Some(1),
        _ => lines.iter().position(|line| line == section),
    };
    let begin = begin.unwrap_or_else(|| panic!("{place}: no section {section}"));
    let mut changed = Vec::new();
    for change in changes.split(" ;; ").map(str::trim) {
        let is_end = |line: &String| line.is_empty();
        let end = lines[begin + 1..].iter().position(is_end);
        let end = end.map_or(lines.len(), |n| begin + 1 + n);
        let key = change.split([' ', '=']).next().unwrap();
        let key = key.strip_prefix('-').unwrap_or(key);
        let is_it = |line: &String| line.starts_with(&format!("{key} ="));
        let old = (begin + 1..end).find(|&n| is_it(&lines[n]));
        if let Some(line) = change.strip_prefix('+') {
            lines.insert(end, line.to_owned());
            changed.push(end);
        } else if change.starts_with('-') {
            let old = old.unwrap_or_else(|| panic!("{place}: no {key} to take away"));
            lines.remove(old);
            changed.push(begin);
        } else if let Some(old) = old {
            change.clone_into(&mut lines[old]);
            changed.push(old);
        } else {
            lines.insert(end, change.to_owned());
            changed.push(end);
        }
    }
    let (said, at) = match said.split_once("  ^ ") {
        Some((said, at)) => (said, Some(at.to_owned())),
        None => (said, None),
    };
    Mistake {
        place,
        text: lines.join("\n") + "\n",
        changed,
        said: said.to_owned(),
        at,
    }
}

#[test]
fn each_mistake_has_its_message_with_a_caret_at_it() {
    parse("case.toml", SOUND, &[]).unwrap_or_else(|error| panic!("{error}"));
    let mistakes = mistakes();
    assert!(mistakes.len() >= 150, "{}", mistakes.len());
    let mut wrong = Vec::new();
    for mistake in &mistakes {
        let place = &mistake.place;
        let Err(error) = parse("case.toml", &mistake.text, &[]) else {
            wrong.push(format!("{place}: passed for sound"));
            continue;
        };
        let message = error.to_string();
        let Some((line, column)) = caret(&message, "case.toml") else {
            wrong.push(format!("{place}: no place in:\n{message}"));
            continue;
        };
        let shown = mistake.text.lines().nth(line - 1).unwrap_or_default();
        let there = match &mistake.at {
            Some(text) => shown.contains(text.as_str()),
            None => mistake.changed.contains(&(line - 1)),
        };
        let begin = message.starts_with("error: ") && message.contains('^');
        if !(begin && there && column > 0 && message.contains(&mistake.said)) {
            wrong.push(format!("{place}: not `{}` in:\n{message}", mistake.said));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

#[test]
fn every_key_of_the_schema_has_a_mistake_of_its_own() {
    let mut met: Vec<String> = Vec::new();
    for mistake in mistakes() {
        let Err(error) = parse("case.toml", &mistake.text, &[]) else {
            continue;
        };
        if let Some(place) = caret(&error.to_string(), "case.toml") {
            met.extend(key_at(&mistake.text, place));
        }
    }
    let keys = keys();
    assert!(keys.len() > 120, "{}", keys.len());
    let lacking: Vec<&str> = keys
        .iter()
        .map(|key| key.path.as_str())
        .filter(|path| !met.iter().any(|met| met == path))
        .collect();
    assert!(
        lacking.is_empty(),
        "no line of tests/bad_inputs has its caret at: {}",
        lacking.join(", ")
    );
}

/// Lays one value over the sound case; gives the message.
fn overridden(key: &Key, value: &str) -> String {
    let path = key.path.replace('*', "metal");
    let path = path
        .replace("body.", "body.0.")
        .replace("contact.pair.", "contact.pair.0.")
        .replace("symmetry.", "symmetry.0.")
        .replace("load.", "load.0.")
        .replace("absorb.", "absorb.0.")
        .replace("pressure.", "pressure.0.")
        .replace("detonate.", "detonate.0.")
        .replace("plane.", "plane.0.")
        .replace("surface.", "surface.0.")
        .replace("output.snapshot.", "output.snapshot.0.")
        .replace("gauge.", "gauge.0.")
        .replace("witness.", "witness.0.");
    let measures = ["plate", "target", "bar", "debris", "region", "front"];
    let path = measures.iter().fold(path, |path, kind| {
        path.replace(&format!("measure.{kind}."), &format!("measure.{kind}.0."))
    });
    // Keys below `touch` and the like end with the same words.
    let path = path.replace("load.0.body.0.", "load.0.body.");
    let set = format!("{path}={value}");
    match parse("case.toml", SOUND, std::slice::from_ref(&set)) {
        Ok(_) => format!("{set}: passed for sound"),
        Err(error) => format!("{set}: {error}"),
    }
}

#[test]
fn a_value_of_another_type_or_unit_is_told_for_every_key() {
    let mut wrong = Vec::new();
    for key in keys() {
        let mut told = |value: &str, said: &[&str]| {
            let message = overridden(&key, value);
            let said = said.iter().any(|said| message.contains(said));
            let shown = message.contains(": error: ") && message.contains("--> --set:1:");
            if !(said && shown) || message.contains("struct ") {
                wrong.push(message);
            }
        };
        // No key takes a date, and none a table of its own making.
        told("1979-05-27", &["expected "]);
        told(
            "{ surely = { not = 1 } }",
            &[
                "expected ",
                "unknown key `surely`",
                "unknown choice `surely`",
            ],
        );
        if key.takes_quantity() {
            told(
                "\"1 furlong\"",
                &["unknown unit `furlong`", "expected an array"],
            );
            told("\"1 m^7\"", &["expected a"]);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// What is said of a file.
fn refusal(path: &Path) -> String {
    let error = files::input::load(path, &[]).expect_err("no case");
    let message = error.to_string();
    assert!(message.starts_with("error: "), "{message}");
    message
}

#[test]
fn a_file_that_is_no_text_is_told_before_it_is_read() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("case.toml");
    let message = refusal(&path);
    assert!(message.contains("cannot read the case"), "{message}");
    let message = refusal(place.path());
    assert!(message.contains("case.toml: No such file"), "{message}");
    let message = refusal(&path.join("case.toml"));
    assert!(message.contains("No such file") || message.contains("Not a directory"));

    fs::create_dir(&path).unwrap();
    let message = refusal(place.path());
    assert!(message.contains("cannot read the case"), "{message}");
    fs::remove_dir(&path).unwrap();

    let mut latin = SOUND.as_bytes().to_vec();
    let second = 1 + latin.iter().position(|byte| *byte == b'\n').unwrap();
    latin[second + 2] = 0xe9;
    fs::write(&path, latin).unwrap();
    let message = refusal(&path);
    assert!(
        message.contains("no UTF-8 text: the byte 0xe9 in line 2"),
        "{message}"
    );

    // Sparse: it takes no room, and time only if it were read.
    fs::File::create(&path)
        .unwrap()
        .set_len(100_000_000)
        .unwrap();
    let message = refusal(&path);
    assert!(
        message.contains("has 100 MB, more than the 16 MB"),
        "{message}"
    );
    let message = refusal(Path::new("/dev/zero"));
    assert!(message.contains("it is a device"), "{message}");
    // Nobody writes to the pipe, so that a reader would wait for ever.
    let pipe = place.path().join("pipe");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status();
    assert!(made.unwrap().success());
    let message = refusal(&pipe);
    assert!(
        message.contains("it is a pipe, not a regular file"),
        "{message}"
    );
    // So it is for the files that a case names.
    let surface = |file: &str| {
        let text = SOUND.replace(
            "shape.sphere = { centre = [\"99 mm\", \"99 mm\", \"99 mm\"], radius = \"1 mm\" }",
            &format!("shape.stl = {{ file = \"{file}\", unit = \"1 mm\" }}"),
        );
        let case = place.path().join("case.toml");
        parse(case.to_str().unwrap(), &text, &[])
            .unwrap_err()
            .to_string()
    };
    for (file, said) in [
        (
            "/dev/zero",
            "cannot take the surface `/dev/zero`: it is a device",
        ),
        ("pipe", "cannot take the surface `pipe`: it is a pipe"),
        (".", "cannot take the surface `.`: it is a folder"),
    ] {
        let message = surface(file);
        assert!(message.contains(said), "{message}");
        assert!(!message.contains("looked for at"), "{message}");
    }
    fs::write(place.path().join("punch.stl"), "").unwrap();
    let message = surface("pinch.stl");
    let there = format!(
        "it is looked for at {}",
        place.path().join("pinch.stl").display()
    );
    assert!(message.contains(&there), "{message}");
    assert!(message.contains("did you mean `punch.stl`?"), "{message}");

    fs::write(&path, "").unwrap();
    let message = refusal(&path);
    assert!(
        message.contains("the key `dimension` is missing"),
        "{message}"
    );
    fs::write(&path, [0; 1000]).unwrap();
    assert!(refusal(&path).contains("case.toml:1:1"));
}

#[test]
fn deep_nesting_is_told_and_not_followed() {
    let deep = |open: &str, inner: &str, close: &str| {
        [
            open.repeat(100_000),
            inner.to_owned(),
            close.repeat(100_000),
        ]
        .concat()
    };
    let keys = deep("a.", "a", "");
    let texts = [
        format!("a = {}", deep("[", "", "]")),
        format!("a = {}", deep("{ a = ", "1", " }")),
        format!("a = {}", "[".repeat(1_000_000)),
        format!("{keys} = 1"),
        format!("[{keys}]"),
        format!("[[{keys}]]"),
        format!("spacing = \"1 {}\"", deep("(", "m", ")")),
        SOUND.replace("-1 km/s", &format!("1{}", "/(".repeat(490))),
        SOUND.replace("-1 km/s", &deep("(", "x", ")")),
        "[a]\n".repeat(100_000),
        "a = 1\n".repeat(100_000),
    ];
    // A small stack, as threads have.
    let told = std::thread::Builder::new()
        .stack_size(1 << 20)
        .spawn(move || {
            for text in &texts {
                let error = parse("case.toml", text, &[]).expect_err("too deep");
                assert!(error.to_string().len() < 3_000_000);
                let error = parse("case.toml", SOUND, std::slice::from_ref(text));
                assert!(error.is_err());
            }
            let error = parse("case.toml", SOUND, &[format!("{keys}=1")]);
            assert!(error.is_err());
        });
    told.unwrap().join().unwrap();
}

/// Each table of the sound case once as an array of its values, which serde would take in the order
/// of the schema.
#[test]
fn an_array_is_no_table() {
    let sound = toml::Value::Table(SOUND.parse().unwrap());
    let mut tables = Vec::new();
    find_tables(&sound, &mut Vec::new(), &mut tables);
    assert!(tables.len() > 40, "{}", tables.len());
    for path in tables {
        let mut changed = sound.clone();
        let table = path.iter().fold(&mut changed, |value, step| match step {
            Step::Key(key) => &mut value[key.as_str()],
            Step::Element(n) => &mut value[*n],
        });
        let values = table.as_table().unwrap().values().cloned().collect();
        *table = toml::Value::Array(values);
        let text = toml::to_string(&changed).unwrap();
        let message = parse("case.toml", &text, &[]).unwrap_err().to_string();
        let title = message.lines().next().unwrap();
        assert!(title.contains("table"), "{path:?}: {message}");
        assert!(title.contains("found an array"), "{path:?}: {message}");
    }
}

#[derive(Debug, Clone)]
enum Step {
    Key(String),
    Element(usize),
}

fn find_tables(value: &toml::Value, path: &mut Vec<Step>, found: &mut Vec<Vec<Step>>) {
    let steps: Vec<(Step, &toml::Value)> = match value {
        toml::Value::Table(table) => {
            if !path.is_empty() {
                found.push(path.clone());
            }
            let keys = table.iter();
            keys.map(|(key, value)| (Step::Key(key.clone()), value))
                .collect()
        }
        toml::Value::Array(array) => {
            let elements = array.iter().enumerate();
            elements
                .map(|(n, value)| (Step::Element(n), value))
                .collect()
        }
        _ => return,
    };
    for (step, value) in steps {
        path.push(step);
        find_tables(value, path, found);
        path.pop();
    }
}
