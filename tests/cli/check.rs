//! The picture of `whipple check`: what it shows of the particles that a case begins with.

use std::path::Path;
use std::process::Command;

use crate::program::{WHIPPLE, command, end, project, quarter_impact};
use resvg::tiny_skia::Pixmap;

/// Colours of the first two bodies, of symmetry planes, rigid surfaces and the box of interest.
const FIRST: [u8; 3] = [0, 114, 178];
const SECOND: [u8; 3] = [230, 159, 0];
const SYMMETRY: [u8; 3] = [0, 130, 130];
const SURFACE: [u8; 3] = [110, 60, 20];
const KEEP: [u8; 3] = [200, 0, 0];

fn check(case: &str, picture: &Path, more: &[&str]) -> Command {
    let mut check = command(WHIPPLE);
    check
        .args(["check", case, "--picture"])
        .arg(picture)
        .args(more);
    check
}

fn draw(case: &str, picture: &Path, more: &[&str]) -> Pixmap {
    let ended = end(&mut check(case, picture, more)).with_code(0);
    assert!(ended.stdout.contains("wrote "), "{ended:#?}");
    Pixmap::load_png(picture).unwrap()
}

/// Pixels below the legend of a colour, or nearly so: large discs are darker about their rims.
fn near(picture: &Pixmap, colour: [u8; 3], by: u8) -> usize {
    let pixels = picture.pixels().iter();
    let pixels = pixels.skip(130 * picture.width() as usize);
    let is = |p: [u8; 3]| p.iter().zip(colour).all(|(p, c)| p.abs_diff(c) <= by);
    pixels
        .filter(|p| is([p.red(), p.green(), p.blue()]))
        .count()
}

fn of_body(picture: &Pixmap, colour: [u8; 3]) -> usize {
    near(picture, colour, 45)
}

fn count(picture: &Pixmap, colour: [u8; 3]) -> usize {
    near(picture, colour, 0)
}

#[test]
fn the_filled_model_is_drawn_with_all_that_acts_on_it() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("pictures/model.png");
    let coarse = ["--set", "spacing=0.05mm"];
    let picture = draw(&quarter_impact(), &path, &coarse);
    assert_eq!(picture.width(), 1200);
    let (plate, sphere) = (of_body(&picture, FIRST), of_body(&picture, SECOND));
    assert!(plate > 5000 && sphere > 3000, "{plate} {sphere}");
    assert!(count(&picture, SYMMETRY) > 300);
    assert_eq!(count(&picture, SURFACE) + count(&picture, KEEP), 0);
    // The same picture from any number of threads.
    let other = place.path().join("other.png");
    let mut alone = check(&quarter_impact(), &other, &coarse);
    end(alone.env("RAYON_NUM_THREADS", "1")).with_code(0);
    assert!(std::fs::read(&path).unwrap() == std::fs::read(&other).unwrap());

    let more = [
        "--set",
        "spacing=0.05mm",
        "--set",
        "plane=[{ normal = \"+z\", point = [0, 0, \"-0.2 mm\"] }]",
        "--set",
        "domain.keep.below={ z = \"0.75 mm\" }",
        "--section",
        "z=0.2mm",
    ];
    let picture = draw(&quarter_impact(), &path, &more);
    assert!(count(&picture, SURFACE) > 300 && count(&picture, KEEP) > 100);
}

#[test]
fn models_of_fewer_dimensions_are_drawn_whole() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("model.png");
    for case in ["inputs/rubber-rings", "inputs/sod"] {
        let picture = draw(&project(case), &path, &[]);
        assert!(of_body(&picture, FIRST) > 500, "{case}");
        let ended = end(&mut check(&project(case), &path, &["--section", "y=0"])).with_code(2);
        assert!(ended.stderr.contains("leave --section out"), "{ended:#?}");
    }
}

#[test]
fn what_cannot_be_drawn_is_said() {
    let place = tempfile::tempdir().unwrap();
    let png = place.path().join("model.png");
    for (picture, section, said) in [
        (place.path().join("model.pdf"), "y", ".png or .svg"),
        (place.path().join("model.csv"), "y", ".png or .svg"),
        (place.path().join("model"), "y", ".png or .svg"),
        (png.clone(), "w=0", "cannot read the section"),
        (png.clone(), "y=1s", "cannot read"),
        (
            png.clone(),
            "y=9mm",
            "no particle lies in the section y = 9 mm",
        ),
    ] {
        let more = ["--set", "spacing=0.05mm", "--section", section];
        let ended = end(&mut check(&quarter_impact(), &picture, &more)).with_code(2);
        assert!(ended.stderr.contains(said), "{ended:#?}");
        assert!(!picture.exists());
    }
    let alone = ["check", &quarter_impact(), "--section", "y=0"];
    end(command(WHIPPLE).args(alone)).with_code(2);
}
