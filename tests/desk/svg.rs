//! Pictures as SVG, the same as PNG, and what they draw as tables.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use resvg::tiny_skia::{Pixmap, Transform};
use resvg::usvg::{Options, Tree, fontdb::Database};
use roxmltree::Document;

use crate::fixture::{Case, Particles, impact, plot, run, write};

/// The font inside the program.
const FONT: &[u8] = include_bytes!("../../src/plot/font/DejaVuSans-subset.ttf");

/// Draws a picture of a name; gives its text, or the bytes of a PNG file.
fn draw(source: &Path, out: &str, options: &str) -> Vec<u8> {
    let folder = if source.is_dir() {
        source
    } else {
        source.parent().unwrap()
    };
    let path = folder.join(out);
    plot(source, &format!("{options} --out {}", path.display())).unwrap();
    std::fs::read(path).unwrap()
}

fn svg(source: &Path, options: &str) -> String {
    String::from_utf8(draw(source, "drawn.svg", options)).unwrap()
}

/// The texts of a picture, in order.
fn texts<'a>(document: &'a Document) -> Vec<&'a str> {
    let all = document
        .descendants()
        .filter(|node| node.has_tag_name("text"));
    all.map(|node| node.text().unwrap()).collect()
}

fn count(document: &Document, tag: &str) -> usize {
    let all = document.descendants();
    all.filter(|node| node.tag_name().name() == tag).count()
}

/// The pixels of a picture by the font of the program alone.
fn render(svg: &str) -> Pixmap {
    let mut fonts = Database::new();
    fonts.load_font_data(FONT.to_vec());
    let options = Options {
        fontdb: Arc::new(fonts),
        ..Options::default()
    };
    let tree = Tree::from_str(svg, &options).unwrap();
    let size = tree.size().to_int_size();
    let mut pixmap = Pixmap::new(size.width(), size.height()).unwrap();
    resvg::render(&tree, Transform::identity(), &mut pixmap.as_mut());
    pixmap
}

fn snapshot(folder: &Path, case: &Case, particles: &Particles) -> PathBuf {
    let path = folder.join("state.vtkhdf");
    write(&path, case, particles, 2e-7);
    path
}

#[test]
fn a_png_is_what_its_svg_shows_and_both_are_the_same_again() {
    let folder = tempfile::tempdir().unwrap();
    let run = run(folder.path());
    for options in [
        "--history",
        "--field pressure",
        "--panels",
        "--as particles",
        "--profile pressure --width 700",
        "--field velocity.x --width 500",
    ] {
        let picture = svg(&run, options);
        assert_eq!(picture, svg(&run, options), "{options}");
        let png = draw(&run, "drawn.png", options);
        assert_eq!(png, draw(&run, "drawn.png", options), "{options}");
        let pixels = Pixmap::decode_png(&png).unwrap();
        assert!(pixels == render(&picture), "{options}");
        assert!(picture.len() < 2_000_000, "{options}: {}", picture.len());
    }
}

#[test]
fn words_are_text_and_curves_are_lines() {
    let folder = tempfile::tempdir().unwrap();
    let run = run(folder.path());
    let picture = svg(&run, "--history");
    let document = Document::parse(&picture).unwrap();
    let words = texts(&document);
    for word in [
        "energies",
        "total",
        "kinetic",
        "time (µs)",
        "energy (mJ)",
        "0.20",
    ] {
        assert!(words.contains(&word), "{word}: {words:?}");
    }
    assert_eq!(count(&document, "image"), 0);
    assert!(count(&document, "path") >= 4);
    let root = document.root_element();
    assert_eq!(root.attribute("width"), Some("1200"));
    assert!(
        root.attribute("font-family")
            .unwrap()
            .starts_with("DejaVu Sans, ")
    );

    let picture = svg(&run, "--panels --field pressure");
    let document = Document::parse(&picture).unwrap();
    assert_eq!(count(&document, "image"), 3);
    assert_eq!(count(&document, "linearGradient"), 1);
    assert!(texts(&document).contains(&"pressure (GPa)"));
}

#[test]
fn few_particles_are_circles_and_many_are_pixels() {
    let folder = tempfile::tempdir().unwrap();
    let path = snapshot(folder.path(), &Case::quarter(), &impact(0.0));
    let few = svg(&path, "--as particles --view=-0.4:0.4,-0.3:0.7mm");
    let document = Document::parse(&few).unwrap();
    assert_eq!(count(&document, "image"), 0);
    let circles = count(&document, "circle");
    assert!((1000..3000).contains(&circles), "{circles}");
    let many = svg(&path, "--profile pressure --along r");
    let document = Document::parse(&many).unwrap();
    assert_eq!(count(&document, "image"), 1);
    // Those of the legend.
    assert_eq!(count(&document, "circle"), 2);
}

#[test]
fn names_do_no_more_than_to_show_themselves() {
    let folder = tempfile::tempdir().unwrap();
    let mut case = Case::quarter();
    let title = "a <b>&amp;\"'\u{1b}[31m\u{202e}\u{ffff}\u{5e9}\u{5dc} ]]> --> ü\u{200f}";
    title.clone_into(&mut case.title);
    case.bodies = vec!["</text><script>".to_owned(), "\u{7}&\u{2066}".to_owned()];
    let path = snapshot(folder.path(), &case, &impact(0.0));
    let picture = svg(&path, "");
    let document = Document::parse(&picture).unwrap();
    let words = texts(&document);
    let shown = "a <b>&amp;\"'\\u{1b}[31m\\u{202e}\u{fffd}\u{5e9}\u{5dc} ]]> --> ü\\u{200f}";
    assert_eq!(words[0], shown);
    assert!(words.contains(&"</text><script>"), "{words:?}");
    assert!(words.contains(&"\\u{7}&\\u{2066}"), "{words:?}");
    assert_eq!(count(&document, "script"), 0);
    let png = draw(&path, "drawn.png", "");
    assert!(Pixmap::decode_png(&png).unwrap() == render(&picture));
}

#[test]
fn endings_and_options_say_what_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let run = run(folder.path());
    let has = |name: &str| run.join("pictures").join(name).is_file();
    plot(&run, "--history --format svg").unwrap();
    plot(&run, "--csv --field pressure").unwrap();
    plot(&run, "--panels --format png").unwrap();
    assert!(has("history.svg") && has("000002-pressure.csv") && has("panels-body.png"));
    assert!(!has("history.png"));
    let name = run.join("own.SVG");
    plot(&run, &format!("--history --out {}", name.display())).unwrap();
    assert!(std::fs::read_to_string(&name).unwrap().starts_with("<svg "));
    for options in ["--csv", "--format png"] {
        let complaint = plot(&run, &format!("{options} --out {}", name.display())).unwrap_err();
        assert!(complaint.contains("another kind of file"), "{complaint}");
    }
    assert!(plot(&run, "--csv --format svg").is_err());
    assert!(
        plot(&run, "--format pdf")
            .unwrap_err()
            .contains("possible values: svg, png")
    );
}

#[test]
fn what_is_drawn_can_be_had_as_a_table() {
    let folder = tempfile::tempdir().unwrap();
    let run = run(folder.path());
    let table = |options: &str| {
        let bytes = draw(&run, "drawn.csv", options);
        String::from_utf8(bytes).unwrap()
    };
    let energies = table("--history");
    let mut lines = energies.lines();
    assert_eq!(lines.next(), Some("# units: -,s,J"));
    assert_eq!(lines.next(), Some("curve,time,energy"));
    assert_eq!(lines.count(), 4 * 401);
    // A table that was drawn can be drawn again, a line for each curve.
    let again = svg(&run.join("drawn.csv"), "--xy time:energy");
    assert!(again.contains(">kinetic</text>"));

    let cut = table("--field pressure --width 400 --panels --index 0,2");
    let mut lines = cut.lines();
    assert_eq!(lines.next(), Some("# units: s,m,m,-,Pa"));
    assert_eq!(lines.next(), Some("time,x,z,body,pressure"));
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    assert!(rows.len() > 2000 && rows.iter().all(|row| row.len() == 5));
    let at = |k: usize| rows.iter().map(move |row| row[k].parse::<f64>().unwrap());
    assert!(at(0).any(|t| t == 0.0) && at(0).any(|t| (t - 2e-7).abs() < 1e-15));
    // The plate is 3 mm wide.
    let widest = at(1).fold(0.0, f64::max);
    assert!((widest - 1.5e-3).abs() < 2e-5, "{widest}");
    assert!(rows.iter().any(|row| row[3] == "sphere") && at(4).any(|p| p > 1e9));

    let discs = table("--as particles --no-mirror --time 0");
    assert!(discs.starts_with("# units: s,m,m,-\ntime,x,z,body\n0.0,"));
    // One layer of a quarter.
    let count = discs.lines().count();
    assert!((800..1600).contains(&count), "{count}");
}
