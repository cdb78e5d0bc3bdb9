//! What is told of a case before it runs grows as its bodies do, not as their pairs.

use std::fmt::Write as _;

use comm::Comm;
use files::input::parse;
use files::plan::{Files, expected_steps, share_of_work};
use files::preflight::{Approach, approaches, memory, warnings};
use model::Case;
use populate::visits;

/// Discs in so many rows and columns, 2.6 radii apart, each with a velocity of its own or at rest.
fn discs(rows: u32, moves: bool) -> String {
    let mut text = "
        dimension = 2
        spacing = \"0.25 mm\"
        run.end_time = \"2 us\"
        material.metal.library = \"copper\"
    "
    .to_owned();
    for k in 0..rows * rows {
        let [x, y] = [k % rows, k / rows].map(|n| 2.6 * f64::from(n));
        let speed = |factor: u32| if moves { factor * k % 61 } else { 0 };
        let [u, v] = [7, 11].map(|factor| f64::from(speed(factor)) - 30.0);
        let _ = write!(
            text,
            "
            [[body]]
            name = \"disc-{k}\"
            material = \"metal\"
            shape.sphere = {{ centre = [\"{x} mm\", \"{y} mm\"], radius = \"1 mm\" }}
            velocity = [\"{u} m/s\", \"{v} m/s\"]
            "
        );
    }
    text
}

fn read(text: &str) -> Case {
    parse("bodies", text, &[]).unwrap_or_else(|error| panic!("{error}"))
}

/// Rows of lattices that all that `check` tells of a case looks at.
fn visits_of(text: &str) -> u64 {
    let mut found = Vec::new();
    let case = read(text);
    let of_approaches = visits::of(|| found = approaches(&case));
    of_approaches + visits_besides(text, &found)
}

/// Sites, rows and blocks that are looked at besides those of approaches.
fn visits_besides(text: &str, approaches: &[Approach]) -> u64 {
    visits::of(|| {
        let case = read(text);
        let steps = expected_steps(&case, approaches, 0.0).unwrap();
        (
            warnings(&case, approaches),
            share_of_work(&case, approaches),
            memory::of_rank(&case, &Comm::solo(), 1),
            Files::new(&case, approaches, 1e4, steps).unwrap(),
        )
    })
}

#[test]
fn four_times_as_many_bodies_take_four_times_the_work() {
    for moves in [false, true] {
        let [few, many] = [22, 44].map(|rows| visits_of(&discs(rows, moves)));
        assert!(many < 5 * few, "{moves}: {few} {many}");
    }
}

/// Balls of glass in so many rows, columns and layers, of which one in five flies.
fn balls(rows: u32) -> String {
    let mut text = "
        dimension = 3
        spacing = \"0.2 mm\"
        run.end_time = \"5 us\"
        material.metal.library = \"copper\"
    "
    .to_owned();
    for k in 0..rows.pow(3) {
        let [x, y, z] = [k % rows, k / rows % rows, k / rows.pow(2)].map(|n| 1.3 * f64::from(n));
        let speed = if k % 5 == 0 { -300 } else { 0 };
        let _ = write!(
            text,
            "
            [[body]]
            name = \"ball-{k}\"
            material = \"metal\"
            shape.sphere = {{ centre = [\"{x} mm\", \"{y} mm\", \"{z} mm\"], radius = \"0.5 mm\" }}
            velocity = [0, 0, \"{speed} m/s\"]
            "
        );
    }
    text
}

/// Bricks of glass in so many rows, columns and layers, laid face to face.
fn bricks(rows: u32) -> String {
    let sphere = "shape.sphere = { centre = [";
    let mut text = String::new();
    for line in balls(rows).replace("-300 m/s", "0 m/s").lines() {
        match line.trim().strip_prefix(sphere) {
            Some(rest) => {
                let centre = rest.split(']').next().unwrap_or_default();
                let _ = writeln!(
                    text,
                    "shape.box = {{ size = [\"1.3 mm\", \"1.3 mm\", \"1.3 mm\"], centre = [{centre}] }}"
                );
            }
            None => {
                let _ = writeln!(text, "{line}");
            }
        }
    }
    text
}

#[test]
fn a_wall_of_bricks_takes_its_share_of_each_brick() {
    let [few, many] = [3, 6].map(|rows| {
        let text = bricks(rows);
        let read = visits_besides(&text, &approaches(&read(&text)));
        read / u64::from(rows.pow(3))
    });
    assert!(many < 2 * few, "{few} {many}");
}

/// Tables have rows of pairs that meet alone.
#[test]
fn bodies_that_rest_side_by_side_take_no_rows_of_contact() {
    let tables = |text: &str, known: bool| {
        let case = read(text);
        let pairs = approaches(&case);
        let pairs = if known { pairs.as_slice() } else { &[] };
        Files::new(&case, pairs, 1e4, 100.0).unwrap().tables
    };
    let flying = balls(4);
    let still = flying.replace("-300 m/s", "0 m/s");
    assert!((tables(&still, true) / tables(&still, false) - 1.0).abs() < 1e-12);
    assert!(tables(&flying, true) > 1.05 * tables(&flying, false));
}

/// The sites of a body are counted once, for all that asks for them: the rest is the search for what is close to it.
#[test]
fn bodies_of_glass_are_counted_once() {
    let of_each = [3, 6].map(|rows: u32| {
        let text = balls(rows);
        let all = visits_besides(&text, &approaches(&read(&text))) / u64::from(rows.pow(3));
        let mut case = read(&text);
        case.bodies.iter_mut().for_each(|body| body.filled = None);
        let once = visits::of(|| populate::fill(&mut case.bodies, 3, &[]));
        println!("{all} and {} of each body", once / u64::from(rows.pow(3)));
        [all, once / u64::from(rows.pow(3))]
    });
    for [all, once] in of_each {
        assert!(all < 6 * once, "{of_each:?}");
    }
}

/// Of few bodies all approaches are foretold, of very many those by the end of the run.
#[test]
fn approaches_of_many_bodies_are_those_of_pairs() {
    let few = read(&discs(3, true));
    let of_few = approaches(&few);
    let end = of_few.iter().map(|pair| pair.time);
    assert!(end.filter(|time| time.is_finite()).count() > 2);
    // The first disc, and one that it meets in 6 us.
    let mut text = discs(30, true).replace("end_time = \"2 us\"", "end_time = \"20 us\"");
    text = text.replacen("\"-30 m/s\", \"-30 m/s\"", "\"110 m/s\", \"-23 m/s\"", 1);
    let many = read(&text);
    let all = approaches(&many);
    assert!(all.is_sorted_by(|a, b| a.bodies < b.bodies));
    let pair = all.iter().find(|pair| pair.bodies == [0, 1]).unwrap();
    assert!(pair.time < 20e-6, "{pair:?}");
}

/// Each body touches the one that follows it in the file.
#[test]
fn a_long_chain_of_bodies_in_touch_is_laid() {
    const COUNT: u32 = 3000;
    let mut text = "
        dimension = 1
        spacing = \"1 mm\"
        run.end_time = \"1 us\"
        material.a.library = \"copper\"
    "
    .to_owned();
    for k in 0..COUNT {
        let touch = match k + 1 {
            COUNT => String::new(),
            next => format!("touch = {{ body = \"b{next}\", direction = \"-x\" }}"),
        };
        let _ = write!(
            text,
            "
            [[body]]
            name = \"b{k}\"
            material = \"a\"
            shape.box.size = [\"2 mm\"]
            {touch}
            "
        );
    }
    let case = read(&text);
    let [first, last] = [0, COUNT as usize - 1].map(|body| {
        let (lower, _) = populate::bounds(&case.bodies[body], 1).unwrap();
        lower[0]
    });
    assert!((first - last - 2e-3 * f64::from(COUNT - 1)).abs() < 1e-9);
}

/// Each of two plates rests on the body below, and all bodies differ in their spacings: the most different pair is told.
#[test]
fn bodies_that_fall_are_warned_of_their_most_different_spacings() {
    let body = |k: u32, spacing: &str| {
        format!(
            "
            [[body]]
            name = \"b{k}\"
            material = \"metal\"
            spacing = \"{spacing} mm\"
            shape.box = {{ lower = [0, \"{low} mm\"], upper = [\"8 mm\", \"{high} mm\"] }}
            ",
            low = 20 * k,
            high = 20 * k + 8
        )
    };
    let head = "
        dimension = 2
        run.end_time = \"2 us\"
        gravity = [0, \"-9.81 m/s^2\"]
        material.metal.library = \"copper\"
    ";
    let bodies: String = (0..)
        .zip(["0.4", "1", "0.2", "0.1"])
        .map(|(k, spacing)| body(k, spacing))
        .collect();
    let case = read(&format!("{head}{bodies}"));
    let told = warnings(&case, &approaches(&case));
    assert_eq!(told.len(), 1, "{told:?}");
    assert!(
        told[0].starts_with("the spacing of `b1` is 10 times that of `b3`"),
        "{told:?}"
    );
}
