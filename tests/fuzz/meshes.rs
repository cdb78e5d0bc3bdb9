//! Files of triangles.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use crate::guard;
use crate::random::Random;
use crate::{Budget, Met, folder, random};
use files::input::parse;
use files::preflight::{approaches, warnings};

/// Longer files are not changed further.
const LONGEST: usize = 20_000;
/// Longest file that repetitions make (bytes).
const LONGEST_CHANGED: usize = 200_000;

/// What may stand in a text.
const WORDS: &[&str] = &[
    "v ",
    "f ",
    "vt ",
    "surf ",
    "l 1 2 3\n",
    "f 1 2 3 4 5 6 7 8\n",
    "f -1 -2 -3\n",
    "v 0 0 0\n",
    "v 1e308 -1e308 1e-308\n",
    "v nan 0 inf\n",
    "\\\n",
    "#",
    "/",
    "//",
    "-9223372036854775808",
    "0",
    "1e400",
    "solid",
    "facet normal 0 0 1\n",
    "outer loop\n",
    "vertex 0 0 0\n",
    "endloop\n",
    "endfacet\n",
    "endsolid\n",
    "\n",
    "\r\n",
    "\u{feff}",
    "é",
    "-0.0",
    ".5",
    "4.0000001",
];

/// Sound files of both formats, the first kept changes among them.
fn seeds() -> Vec<(&'static str, Vec<u8>)> {
    let project = crate::project::root();
    let hook = fs::read(project.join("tests/common/hook.stl")).unwrap();
    let cube = fs::read(project.join("tests/common/cube.obj")).unwrap();
    let text = String::from_utf8(hook.clone()).unwrap();
    let numbers: Vec<f32> = text
        .lines()
        .filter_map(|line| line.trim().strip_prefix("vertex "))
        .flat_map(|line| line.split_whitespace().map(|word| word.parse().unwrap()))
        .collect();
    let mut binary = vec![0; 80];
    let count = u32::try_from(numbers.len() / 9).unwrap();
    binary.extend(count.to_le_bytes());
    for triangle in numbers.chunks(9) {
        binary.extend([0; 12]);
        binary.extend(triangle.iter().flat_map(|x| x.to_le_bytes()));
        binary.extend([0; 2]);
    }
    let kept = ["stl", "obj"].into_iter().filter_map(|format| {
        let path = folder().join(format!("panic.{format}"));
        Some((format, fs::read(path).ok()?))
    });
    let seeds = vec![("stl", hook), ("stl", binary), ("obj", cube)];
    seeds.into_iter().chain(kept).collect()
}

/// Reads a file as a rigid surface and looks at it as `check` does; gives the message.
fn attempt(folder: &Path, format: &str, bytes: &[u8]) -> String {
    let file = folder.join(format!("part.{format}"));
    fs::write(&file, bytes).unwrap();
    let most = 32 * bytes.len() + (64 << 20);
    let _watch = guard::watch_within(&format!("part.{format}"), most);
    let text = format!(
        "dimension = 3\nspacing = \"0.5 mm\"\nrun.end_time = \"1 us\"\n\
         material.metal.library = \"copper\"\n[[body]]\nname = \"block\"\nmaterial = \"metal\"\n\
         shape.box.size = [\"2 mm\", \"2 mm\", \"2 mm\"]\n\
         [[surface]]\nshape.{format} = {{ file = \"{}\", unit = \"1 mm\", at = [0, 0, \"20 mm\"] }}\n",
        file.display()
    );
    let case = match parse("case.toml", &text, &[]) {
        Ok(case) => case,
        Err(error) => return error.to_string(),
    };
    let told = warnings(&case, &approaches(&case)).join("; ");
    for (_, mesh) in case.meshes() {
        assert!(mesh.volume().is_finite());
        assert!(!mesh.distance(&[0.0; 3]).is_nan());
        let mut faces = 0;
        mesh.faces(&[0.001, 0.001, 0.0215], 0.002, &mut |depth, _| {
            assert!(!depth.is_nan());
            faces += 1;
        });
    }
    parse("resolved", &case.resolved, &[]).expect("a resolved case can be read again");
    format!("sound: {told}")
}

fn change(bytes: &[u8], other: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(4) {
        if bytes.is_empty() {
            break;
        }
        let at = random.below(bytes.len());
        let end = (at + random.below(120)).min(bytes.len());
        match random.below(9) {
            8 => {
                // A part again and again.
                let part = bytes[at..end].repeat(1 << random.below(11));
                drop(bytes.splice(at..at, part));
                bytes.truncate(LONGEST_CHANGED);
            }
            0 => bytes[at] = u8::try_from(random.below(256)).unwrap(),
            1 => bytes[at] ^= 1 << random.below(8),
            2 => drop(bytes.splice(at..at, WORDS[random.below(WORDS.len())].bytes())),
            3 => {
                let word = WORDS[random.below(WORDS.len())];
                drop(bytes.splice(at..end.min(at + 4), word.bytes()));
            }
            4 => drop(bytes.drain(at..end)),
            5 => {
                let part = bytes[at..end].to_vec();
                drop(bytes.splice(at..at, part));
            }
            6 => {
                // Another digit.
                let digit = bytes[at..].iter().position(u8::is_ascii_digit);
                if let Some(n) = digit {
                    bytes[at + n] = b'0' + u8::try_from(random.below(10)).unwrap();
                }
            }
            _ => {
                let from = random.below(other.len().max(1)).min(other.len());
                let end = (from + random.below(200)).min(other.len());
                drop(bytes.splice(at..at, other[from..end].iter().copied()));
            }
        }
    }
    bytes
}

#[test]
fn no_surface_makes_the_reader_panic() {
    read(&Budget::new(1500));
}

#[test]
#[ignore = "slow: more of the same"]
fn no_surface_of_many_makes_the_reader_panic() {
    read(&Budget::new(20_000));
}

fn read(budget: &Budget) {
    let mut random = random(budget);
    let place = tempfile::tempdir().unwrap();
    let (mut met, mut seeds) = (Met::default(), seeds());
    let (begun, mut done, mut sound) = (seeds.len(), 0, 0);
    while done < begun || budget.allows(done) {
        let (pick, other) = (random.below(seeds.len()), random.below(seeds.len()));
        let (format, bytes) = if done < begun {
            seeds[done].clone()
        } else {
            (
                seeds[pick].0,
                change(&seeds[pick].1, &seeds[other].1, &mut random),
            )
        };
        done += 1;
        let tried = catch_unwind(AssertUnwindSafe(|| attempt(place.path(), format, &bytes)));
        let Ok(message) = tried else {
            let path = folder().join(format!("panic.{format}"));
            fs::write(&path, &bytes).unwrap();
            panic!("this file, kept as {}", path.display());
        };
        sound += usize::from(message.starts_with("sound"));
        if met.is_new(&message) && done > begun && bytes.len() < LONGEST {
            seeds.push((format, bytes));
        }
    }
    eprintln!(
        "{done} surfaces, {sound} of them sound, {} messages",
        met.count()
    );
    assert!(sound > 0 && met.count() > 10);
}
