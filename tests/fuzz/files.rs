//! Checkpoints, snapshots and tables that are sound as HDF5 files and as their digests say, with content
//! that no run writes: other types and shapes, links, filters, other files, values.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

use clap::Parser;
use serde::{Deserialize, Serialize};

use crate::changes::{self, Change, Kind, Shape, Store};
use crate::guard;
use crate::random::Random;
use crate::{Budget, Met, folder, random};
use app::fragments::{self, FragmentsArgs};
use app::plot::PlotArgs;
use app::{compare::compare, info::describe, plot};
use comm::Comm;
use engine::step::{RunState, Simulation};
use files::input::parse;
use files::output::binary_table::{self, BinaryTable, Cells};
use files::output::{Column, ResultExtents, Rows, checkpoint, snapshot};
use particles::ParticleStore;

const CASE: &str = r#"
dimension = 2
spacing = "1 mm"
run.end_time = "1 us"
material.metal.library = "copper"
body = [
    { name = "a", material = "metal", shape.box.size = ["4 mm", "4 mm"], velocity = [0, "1 m/s"] },
    { name = "b", material = "metal", shape.box = { lower = ["-2 mm", "3 mm"], upper = ["2 mm", "5 mm"] } },
]
load = [{ body = "b", above.y = "4.5 mm", velocity = { y = 0 } }]
"#;

/// What is changed.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Which {
    Checkpoint,
    Snapshot,
    Table,
}

/// A file as a line.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Recipe {
    pub file: Which,
    pub changes: Vec<Change>,
}

/// Recipes that found something, and the shortest that reach a message each.
const KEPT: &str = "files.txt";
/// A long run keeps so many of its new recipes.
const MOST_KEPT: usize = 20;
/// Changes of one file, at most.
const MOST_CHANGES: usize = 5;

/// A sound file of each kind, and room for a changed one.
pub struct Bench {
    place: tempfile::TempDir,
    sound: PathBuf,
    /// Particles in each.
    pub rows: usize,
    /// Datasets and groups of each kind of file.
    places: [Vec<String>; 3],
}

impl Bench {
    pub fn new() -> Self {
        let place = tempfile::tempdir().unwrap();
        let (comm, case) = (Comm::solo(), parse("case", CASE, &[]).unwrap());
        let input = case.resolved.clone();
        let mut simulation = Simulation::start(case, &comm).unwrap();
        simulation.advance(&comm).unwrap();
        let (state, particles) = (&simulation.state, &simulation.particles);
        let meta = checkpoint::Meta {
            run: None,
            step: state.step,
            time: state.time,
            state: &serde_json::to_string(state).unwrap(),
            input: &input,
            results: &ResultExtents::default(),
        };
        let mut rows = Rows::default();
        let sound = checkpoint::write(&comm, place.path(), particles, &meta, 1, &mut rows).unwrap();
        let meta = snapshot::Meta {
            run: None,
            case: &simulation.case,
            step: state.step,
            time: state.time,
            threads: 1,
            wall_seconds: 0.0,
            fragments: &[],
        };
        let path = place.path().join("sound.vtkhdf");
        let fields = snapshot::quantities(&[]).unwrap();
        snapshot::write(
            &comm,
            &path,
            particles,
            &meta,
            &snapshot::SnapshotFormat::of(&fields),
            &mut rows,
        )
        .unwrap();
        let state = checkpoint::state_file(&sound);
        let table = place.path().join("sound.h5");
        write_table(&table, particles.owned());
        let places = [state.as_path(), &path, &table].map(places);
        fs::create_dir(place.path().join("changed")).unwrap();
        fs::copy(&state, place.path().join("changed/other.h5")).unwrap();
        Self {
            rows: particles.owned(),
            place,
            sound,
            places,
        }
    }

    /// A place for a changed file.
    pub fn changed(&self, name: &str) -> PathBuf {
        self.place.path().join("changed").join(name)
    }

    /// The state file of the sound checkpoint.
    pub fn sound_state(&self) -> PathBuf {
        checkpoint::state_file(&self.sound)
    }

    /// Makes a file and lets all commands read it; gives their messages.
    pub fn attempt(&self, recipe: &Recipe) -> (Vec<String>, usize) {
        let (name, sound) = match recipe.file {
            Which::Checkpoint => ("state.h5", checkpoint::state_file(&self.sound)),
            Which::Snapshot => ("state.vtkhdf", self.place.path().join("sound.vtkhdf")),
            Which::Table => ("table.h5", self.place.path().join("sound.h5")),
        };
        let path = self.changed(name);
        fs::copy(&sound, &path).unwrap();
        let manifest = self.changed("manifest.json");
        let _ = fs::remove_file(&manifest);
        if recipe.file == Which::Checkpoint {
            fs::copy(self.sound.join("manifest.json"), manifest).unwrap();
        }
        let refused = changes::apply(&recipe.changes, &path);
        let line = serde_json::to_string(recipe).unwrap();
        let _watch = guard::watch(&line);
        let said = |result: Result<String, String>| result.unwrap_or_else(|error| error);
        if recipe.file == Which::Table {
            return (vec![said(read_table(&path))], refused);
        }
        let mut messages = vec![
            said(
                describe(&path)
                    .map_err(|e| e.to_string())
                    .map(|_| "told".to_owned()),
            ),
            said(
                compare(&sound, &path)
                    .map_err(|e| e.to_string())
                    .map(|r| r.lines.join(" ")),
            ),
            said(
                compare(&path, &path)
                    .map_err(|e| e.to_string())
                    .map(|r| r.lines.join(" ")),
            ),
        ];
        messages.push(match recipe.file {
            Which::Checkpoint => restart(path.parent().unwrap()),
            _ => said(draw(&path).map(|()| "drawn".to_owned())),
        });
        if recipe.file == Which::Snapshot {
            messages.push(said(tell_fragments(&path)));
            messages.push(begin(&path));
        }
        (messages, refused)
    }

    /// A random change.
    fn change(&self, which: Which, random: &mut Random) -> Change {
        let places = &self.places[which as usize];
        let at = places[random.below(places.len())].clone();
        let other = places[random.below(places.len())].clone();
        let (groups, texts, notes): (&[&str], &[&str], &[(&str, &str)]) = match which {
            Which::Checkpoint => (
                &["/", "/fields"],
                &["/state", "/input"],
                &[("/", "step"), ("/", "time"), ("/", "format")],
            ),
            Which::Snapshot => (
                &["/VTKHDF/PointData", "/VTKHDF", "/whipple"],
                &["/whipple/input"],
                &[
                    ("/whipple", "title"),
                    ("/whipple", "bodies"),
                    ("/whipple", "spacings"),
                    ("/whipple", "rigid"),
                    ("/whipple", "symmetry"),
                    ("/whipple", "step"),
                    ("/run", "threads"),
                ],
            ),
            Which::Table => (
                &["/", "/table"],
                &["/columns", "/words"],
                &[("/table/pressure", "unit")],
            ),
        };
        let mut pick = |list: &[&str]| list[random.below(list.len())].to_owned();
        let (group, text) = (pick(groups), pick(texts));
        let note = if random.below(2) == 0 {
            (at.clone(), "unit".to_owned())
        } else {
            let (at, name) = notes[random.below(notes.len())];
            (at.to_owned(), name.to_owned())
        };
        match random.below(20) {
            0..=2 => Change::Note(note.0, note.1, kind(random), self.shape(random)),
            3 => {
                let said = SAID[random.below(SAID.len())];
                Change::Say(note.0, note.1, said.to_owned())
            }
            4 => Change::Silence(note.0, note.1),
            5..=8 => Change::Data(at, kind(random), self.shape(random), store(random)),
            9 => Change::Group(at),
            10 => Change::Unlink(at),
            11 => Change::Rename(at, other),
            12 => match random.below(3) {
                0 => Change::Soft(at, other),
                1 => Change::Hard(at, if random.below(2) == 0 { group } else { other }),
                _ => {
                    let outside = ["other.h5", "/dev/zero", "state.h5"][random.below(3)];
                    Change::Outside(at, outside.to_owned())
                }
            },
            13 => Change::Crowd(group, [1, 20, 300][random.below(3)]),
            14 | 15 => Change::Value(at, random.below(200), odd(random)),
            16 | 17 => {
                let by = PIECES[random.below(PIECES.len())].to_owned();
                Change::Text(text, random.below(1 << 20), random.below(12), by)
            }
            18 => match which {
                Which::Snapshot | Which::Table => Change::Value(at, random.below(200), odd(random)),
                Which::Checkpoint if random.below(6) == 0 => Change::Cut(random.below(400)),
                Which::Checkpoint => {
                    let value = VALUES[random.below(VALUES.len())];
                    let key = KEYS[random.below(KEYS.len())].to_owned();
                    Change::Manifest(key, serde_json::from_str(value).unwrap())
                }
            },
            _ => Change::Length([0, 100, 4096, 1 << 16, 1 << 18][random.below(5)]),
        }
    }

    fn shape(&self, random: &mut Random) -> Shape {
        let n = self.rows;
        let rows = [n, n, 0, 1, n + 1, 4096, 1 << 40, 1 << 50, 1 << 63][random.below(9)];
        let wide = [1, 3, 6, 9, 0, 2, 1 << 10, 1 << 40][random.below(8)];
        match random.below(6) {
            0 => Shape::Null,
            1 => Shape::Scalar,
            2 | 3 => Shape::Of(vec![rows]),
            4 => Shape::Of(vec![rows, wide]),
            _ => Shape::Of(vec![rows, wide, 2]),
        }
    }
}

const SAID: [&str; 9] = [
    "",
    "\u{1b}]0;x\u{7}\u{1b}[2J",
    "[]",
    "[\"a\"]",
    "[0.001, 0.001, 0.001]",
    "[1e-300, 1e300]",
    "[-1, 0]",
    "[[\"x\", 1e300]]",
    "[true, true]",
];
const PIECES: [&str; 12] = [
    "0",
    "1",
    "9999999999999999999",
    "-",
    "e308",
    ".",
    "\"",
    "{",
    "[]",
    ",",
    "\u{ff}",
    "\n",
];
const KEYS: [&str; 10] = [
    "format",
    "step",
    "time",
    "particles",
    "ranks",
    "size",
    "block",
    "leaf",
    "sha256",
    "x",
];
const VALUES: [&str; 10] = [
    "0",
    "1",
    "-1",
    "40",
    "1e300",
    "18446744073709551615",
    "null",
    "\"\"",
    "[]",
    "{}",
];

fn kind(random: &mut Random) -> Kind {
    let length = [1, 3, 8, 8, 100, 1 << 16, 1 << 20][random.below(7)];
    match random.below(16) {
        0..=3 => Kind::F64,
        4 => Kind::I64,
        5 => Kind::U64,
        6 => Kind::U32,
        7 => Kind::U8,
        8 => Kind::F32,
        9 => Kind::I16,
        10 => Kind::Bool,
        11 => Kind::Text(length),
        12 => Kind::Ascii(length),
        13 if random.below(2) == 0 => Kind::LooseText,
        13 => Kind::LooseList,
        14 => Kind::Array(length),
        _ => Kind::Record([1, 2, 100][random.below(3)]),
    }
}

fn store(random: &mut Random) -> Store {
    match random.below(12) {
        0..=4 => Store::Plain,
        5 => Store::Empty,
        6 => Store::Compact,
        7 => Store::Chunked,
        8 | 9 => Store::Packed,
        10 => Store::External,
        _ => Store::Virtual,
    }
}

fn odd(random: &mut Random) -> u64 {
    let odd = [
        0,
        u64::MAX,
        1,
        f64::NAN.to_bits(),
        f64::INFINITY.to_bits(),
        (-1.0_f64).to_bits(),
        1e308_f64.to_bits(),
        1e-300_f64.to_bits(),
        random.bits(),
    ];
    odd[random.below(odd.len())]
}

/// All objects of a file.
fn places(path: &Path) -> Vec<String> {
    fn walk(group: &hdf5::Group, path: &str, found: &mut Vec<String>) {
        for name in group.member_names().unwrap() {
            let path = format!("{path}/{name}");
            if let Ok(inner) = group.group(&name) {
                walk(&inner, &path, found);
            }
            found.push(path);
        }
    }
    let mut found = Vec::new();
    walk(&hdf5::File::open(path).unwrap(), "", &mut found);
    found
}

/// Reads a checkpoint as `restart` does, and takes a step; gives the message.
fn restart(path: &Path) -> String {
    let comm = Comm::solo();
    let mut particles = ParticleStore::default();
    let restored = match checkpoint::read(&comm, path, &mut particles) {
        Ok(restored) => restored,
        Err(error) => return error.to_string(),
    };
    let case = match parse("saved", &restored.input, &[]) {
        Ok(case) => case,
        Err(error) => return error.to_string(),
    };
    let state: RunState = match serde_json::from_str(&restored.state) {
        Ok(state) => state,
        Err(error) => return error.to_string(),
    };
    let mut simulation = match Simulation::resume(case, &comm, state, particles) {
        Ok(simulation) => simulation,
        Err(error) => return error.to_string(),
    };
    match simulation.advance(&comm) {
        Ok(()) => "sound".to_owned(),
        Err(error) => error.to_string(),
    }
}

/// Reads a snapshot as the beginning of a body; gives the message.
fn begin(path: &Path) -> String {
    let text = format!(
        "dimension = 2\nrun.end_time = \"1 us\"\nmaterial.metal.library = \"copper\"\n\
         [[body]]\nname = \"it\"\nmaterial = \"metal\"\n\
         particles = {{ file = \"{}\", part = \"a\" }}\n",
        path.display()
    );
    match parse("case", &text, &[]) {
        Ok(_) => "begun".to_owned(),
        Err(error) => error.to_string(),
    }
}

/// A table of what two gauges have read.
fn write_table(path: &Path, rows: usize) {
    let columns = [("step", ""), ("gauge", ""), ("pressure", "Pa")];
    let columns = columns.map(|(name, unit)| Column::new(name, unit));
    let cells = [
        Cells::Counts((0..rows as u64).collect()),
        Cells::Words((0..rows).map(|row| u32::from(row % 2 == 1)).collect()),
        Cells::Reals(vec![0.5; rows]),
    ];
    let words = ["front", "rear"].map(str::to_owned);
    binary_table::write(path, &columns, &cells, &words).unwrap();
}

/// Reads all of a table; gives the message.
fn read_table(path: &Path) -> Result<String, String> {
    let table = BinaryTable::open(path).map_err(|e| e.to_string())?;
    let sheet = table.sheet(0..table.rows(), None);
    sheet.map_err(|e| e.to_string()).map(|_| "read".to_owned())
}

#[derive(Parser)]
struct FragmentsCli {
    #[command(flatten)]
    args: FragmentsArgs,
}

/// Tells the fragments of a snapshot; gives the message.
fn tell_fragments(path: &Path) -> Result<String, String> {
    let words = ["fragments", path.to_str().unwrap()];
    let cli = FragmentsCli::try_parse_from(words).map_err(|e| e.to_string())?;
    let told = fragments::evaluate(&cli.args);
    told.map_err(|e| e.to_string()).map(|_| "told".to_owned())
}

#[derive(Parser)]
struct Cli {
    #[command(flatten)]
    args: PlotArgs,
}

/// Draws a snapshot by body.
fn draw(path: &Path) -> Result<(), String> {
    let text = path.to_str().unwrap();
    let picture = path.with_extension("png");
    let words = [
        "plot",
        text,
        "--width",
        "400",
        "--out",
        picture.to_str().unwrap(),
    ];
    let cli = Cli::try_parse_from(words).map_err(|e| e.to_string())?;
    plot::run(&cli.args).map_err(|e| e.to_string())
}

fn kept() -> Vec<Recipe> {
    let text = fs::read_to_string(folder().join(KEPT)).unwrap_or_default();
    let lines = text.lines().filter(|line| !line.starts_with('#'));
    lines
        .map(|line| serde_json::from_str(line).expect("a recipe"))
        .collect()
}

fn keep(recipe: &Recipe) {
    let path = folder().join(KEPT);
    let old = fs::read_to_string(&path).unwrap_or_default();
    let line = serde_json::to_string(recipe).unwrap();
    fs::write(path, format!("{old}{line}\n")).unwrap();
}

#[test]
fn no_file_makes_a_reader_panic() {
    let budget = Budget::new(300);
    let mut random = random(&budget);
    let bench = Bench::new();
    for file in [Which::Checkpoint, Which::Snapshot] {
        let changes = Vec::new();
        let (messages, _) = bench.attempt(&Recipe { file, changes });
        let ends = ["told", "sound", "drawn"];
        assert!(ends.contains(&&*messages[0]), "{messages:?}");
        assert!(ends.contains(&&*messages[3]), "{messages:?}");
    }
    let sound = Recipe {
        file: Which::Table,
        changes: Vec::new(),
    };
    assert_eq!(bench.attempt(&sound).0, ["read"]);
    let mut seeds = kept();
    let (begun, mut done, mut refused, mut met) = (seeds.len(), 0, 0, Met::default());
    while done < begun || budget.allows(done) {
        let recipe = if done < begun {
            seeds[done].clone()
        } else {
            bench.vary(&seeds, &mut random)
        };
        done += 1;
        let tried = catch_unwind(AssertUnwindSafe(|| bench.attempt(&recipe)));
        let Ok((messages, not_made)) = tried else {
            if !seeds.contains(&recipe) {
                keep(&recipe);
            }
            panic!("this file, kept in tests/fuzz/{KEPT}: {recipe:?}");
        };
        refused += not_made;
        let new = messages
            .iter()
            .filter(|message| met.is_new(message))
            .count();
        if new > 0 && not_made == 0 && done > begun {
            seeds.push(recipe);
        }
    }
    if budget.keeps() {
        let new = &mut seeds[begun..];
        new.sort_by_key(|recipe| serde_json::to_string(recipe).unwrap().len());
        new.iter().take(MOST_KEPT).for_each(keep);
    }
    eprintln!(
        "{done} files, {} messages, {refused} changes refused by HDF5, {begun} files to begin with",
        met.count()
    );
}

impl Bench {
    /// Another recipe: a known one with a change less or more, or a new one.
    fn vary(&self, seeds: &[Recipe], random: &mut Random) -> Recipe {
        let fresh = Recipe {
            file: [Which::Checkpoint, Which::Snapshot, Which::Table][random.below(3)],
            changes: Vec::new(),
        };
        let mut recipe = match seeds {
            [] => fresh,
            _ if random.below(2) == 0 => fresh,
            _ => seeds[random.below(seeds.len())].clone(),
        };
        if !recipe.changes.is_empty() && random.below(3) == 0 {
            recipe.changes.remove(random.below(recipe.changes.len()));
        }
        for _ in 0..=random.below(2) {
            if recipe.changes.len() < MOST_CHANGES {
                recipe.changes.push(self.change(recipe.file, random));
            }
        }
        recipe
    }
}
