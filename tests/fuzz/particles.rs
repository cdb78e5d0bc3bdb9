//! Files of particles, as other programs write them, with some bytes changed.

use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use crate::guard;
use crate::random::Random;
use crate::{Budget, Met, random};
use files::input::parse;

/// What takes the place of some bytes.
const PIECES: &[&str] = &[
    "0",
    "1",
    "-1",
    "9",
    "99999999999",
    "1e308",
    "-1e-308",
    "nan",
    "inf",
    ".",
    ",",
    "\n",
    "\"",
    "<",
    ">",
    "=",
    "*",
    "$",
    "*NODE\n",
    "*PART\n",
    "*ELEMENT_SOLID\n",
    "*Element, type=C3D8\n",
    "\u{ff}",
    "*Instance, name=a, part=b\n",
    "*Elset, elset=a, generate\n",
    "$Elements\n",
    "$Nodes\n",
    "_",
    "binary",
    "ascii",
    "UInt8",
    "Float32",
    "Int64",
    "\0",
];
const TABLE: &str = "# units: mm,mm,mm,km/s,mg,-,J/kg\nx,y,z,vz,mass,body,specific_energy\n\
    0,0,0,1,8.9,a,5\n1,0,0,1,8.9,b,5\n0,1,0,1,8.9,a,5\n";

const DUMP: &str = "ITEM: UNITS\nsi\nITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n2\n\
    ITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\nITEM: ATOMS id type x y z vx mass\n\
    1 1 0 0 0 7 1\n2 2 1 0 0 7 1\n";
const XYZ: &str = "2\nProperties=species:S:1:pos:R:3:mass:R:1 units=\"position: m, mass: g\"\n\
    a 0 0 0 1\nb 1 0 0 1\n";
const DECK: &str = "*KEYWORD I10=Y\n*PARAMETER\nR len,1.0\n*INCLUDE\nhexes.key\n*NODE\n101,&len,9,9\n\
    102,9,-&len,9\n*ELEMENT_SPH\n101,7,1.0,102\n*ELEMENT_SHELL_THICKNESS\n9,8,101,102,3,3\n1,1,1\n\
    *PART_MOVE\n1,1,1,1\n*END\n";
/// Lines in which a word of the file, or a file beside it, stands for `@`: it names itself, others, or
/// itself within others.
const REFERENCES: &[&str] = &[
    "*Elset, elset=@\n@, @\n",
    "*Elset, elset=@, generate\n1, 999999999, 1\n",
    "*Instance, name=@, part=@\n1,2,3\n*End Instance\n",
    "*Part, name=@\n*End Part\n",
    "*Node, input=@\n",
    "*INCLUDE\n@\n",
    "*PARAMETER\nR@,&@\n",
    "*PART_MOVE\n@,1,1,1\n",
    "*ELEMENT_SPH\n1,@,1.0,@\n",
    "*PART\n@\n@\n",
    "<a @=\"@\">",
    "</a>",
    "<DataArray Name=\"mass\" type=\"Float64\" format=\"appended\" offset=\"0\"/>",
    "@ @ @ @ @\n",
    "@,",
];
/// Longest file that repetitions make (bytes).
const LONGEST: usize = 200_000;

/// Names and contents of sound files.
fn sound() -> Vec<(String, Vec<u8>)> {
    let folder = crate::project::root().join("tests/particles");
    let texts = [
        ("table.csv", TABLE),
        ("dump.lammpstrj", DUMP),
        ("atoms.xyz", XYZ),
        ("deck.k", DECK),
    ];
    let own = texts.map(|(name, text)| (name.to_owned(), text.as_bytes().to_vec()));
    let mut found = own.to_vec();
    let mut paths: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|entry| entry.unwrap().path())
        .collect();
    paths.sort();
    // HDF5 has a fuzz of its own.
    for path in paths
        .iter()
        .filter(|path| path.extension().is_some_and(|e| e != "h5"))
    {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        found.push((name, fs::read(path).unwrap()));
    }
    found
}

fn change(bytes: &mut Vec<u8>, random: &mut Random) {
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len() + 1);
        let end = (at + random.below(12)).min(bytes.len());
        match random.below(10) {
            8 => {
                // A line again and again.
                let line = bytes.split_inclusive(|b| *b == b'\n').nth(random.below(40));
                let line = line.unwrap_or_default().to_vec();
                repeat(bytes, at, &line, random);
            }
            9 => {
                let mut words = bytes.split(|b| !b.is_ascii_alphanumeric() && *b != b'.');
                let word = words.nth(random.below(60)).unwrap_or_default();
                let word = String::from_utf8_lossy(word).into_owned();
                let line = REFERENCES[random.below(REFERENCES.len())].replace('@', &word);
                repeat(bytes, at, line.as_bytes(), random);
            }
            0..=2 => {
                let piece = PIECES[random.below(PIECES.len())].bytes();
                bytes.splice(at..end, piece);
            }
            3 => {
                // A digit.
                let digit = bytes[at..].iter().position(u8::is_ascii_digit);
                if let Some(n) = digit {
                    bytes[at + n] = b'0' + u8::try_from(random.below(10)).unwrap();
                }
            }
            4 => {
                // A number.
                let digit = bytes[at..].iter().position(u8::is_ascii_digit);
                let begin = digit.map_or(at, |n| at + n);
                let length = bytes[begin..]
                    .iter()
                    .take_while(|b| b.is_ascii_digit())
                    .count();
                let piece = PIECES[random.below(8)].bytes();
                bytes.splice(begin..begin + length, piece);
            }
            5 if at < bytes.len() => bytes[at] ^= 1 << random.below(8),
            6 => {
                // A line again, elsewhere.
                let line = bytes.split(|b| *b == b'\n').nth(random.below(40));
                let line = line.unwrap_or_default().to_vec();
                bytes.splice(at..at, line);
            }
            _ if random.below(8) == 0 => bytes.truncate(at),
            _ => {
                bytes.drain(at..end);
            }
        }
    }
}

/// Puts a piece in, up to some thousand times.
fn repeat(bytes: &mut Vec<u8>, at: usize, piece: &[u8], random: &mut Random) {
    let times = 1 << random.below(13);
    let most = LONGEST / (piece.len() + 1);
    bytes.splice(at..at, piece.repeat(times.min(most)));
    bytes.truncate(2 * LONGEST);
}

/// Reads a file as the particles of a body; gives the message.
fn attempt(place: &Path, name: &str, bytes: &[u8], take: &str, part: &str) -> String {
    let path = place.join(name);
    fs::write(&path, bytes).unwrap();
    let text = format!(
        "dimension = 3\nrun.end_time = \"1 us\"\nmaterial.metal.library = \"copper\"\n\
         [[body]]\nname = \"it\"\nmaterial = \"metal\"\n\
         particles = {{ file = \"{}\", unit = \"1 mm\", mass_unit = \"1 g\", time_unit = \"1 us\"{take}{part} }}\n",
        path.display()
    );
    let most = 32 * bytes.len() + (64 << 20);
    let _watch = guard::watch_within(&format!("{name} {take}{part}"), most);
    match parse("case.toml", &text, &[]) {
        Ok(case) => format!(
            "sound, {} quantities",
            case.bodies[0].cloud().unwrap().0.quantities().count()
        ),
        Err(error) => error.to_string(),
    }
}

#[test]
fn no_file_of_particles_makes_a_reader_panic() {
    let budget = Budget::new(1500);
    let mut random = random(&budget);
    let place = tempfile::tempdir().unwrap();
    let (sound, mut met, mut done) = (sound(), Met::default(), 0);
    let mut seeds = sound.clone();
    fs::copy(
        crate::project::root().join("tests/particles/hexes.key"),
        place.path().join("hexes.key"),
    )
    .unwrap();
    while done < sound.len() || budget.allows(done) {
        let (name, mut bytes) = if done < sound.len() {
            sound[done].clone()
        } else {
            seeds[random.below(seeds.len())].clone()
        };
        if done >= sound.len() {
            change(&mut bytes, &mut random);
        }
        let is_mesh = !name.ends_with("csv");
        let take = if is_mesh && random.below(3) == 0 {
            ", take = \"nodes\""
        } else {
            ""
        };
        let part = ["", ", part = 0", ", part = [0, 1]", ", part = \"a\""][random.below(4)];
        done += 1;
        let read = || attempt(place.path(), &name, &bytes, take, part);
        let Ok(message) = catch_unwind(AssertUnwindSafe(read)) else {
            let kept = Path::new(env!("CARGO_TARGET_TMPDIR")).join(&name);
            fs::write(&kept, &bytes).unwrap();
            panic!("this file, kept in {}, {take}{part}", kept.display());
        };
        // What is wrong stands behind the name of the file.
        let said = message.split("`: ").nth(1).unwrap_or(&message).to_owned();
        if met.is_new(&said) && bytes.len() < 10_000 {
            seeds.push((name, bytes));
        }
    }
    eprintln!("{done} files of particles, {} messages", met.count());
    assert!(met.count() > 30, "{}", met.count());
}
