//! Sections as `whipple plot` draws them by default: the matter that a plane cuts.

use std::path::{Path, PathBuf};

use plot::{Pictures, Request, Sequence, Source};
use resvg::tiny_skia::Pixmap;

use crate::fixture::{Case, Particles, impact, plot, write};
use files::FileOpener;

/// Colours of the first three bodies.
const FIRST: [u8; 3] = [0, 114, 178];
const SECOND: [u8; 3] = [230, 159, 0];
const THIRD: [u8; 3] = [0, 158, 115];

/// Spacing of the blocks (m).
const STEP: f64 = 1e-3;

/// Draws one picture of a snapshot and reads it back.
fn picture(snapshot: &Path, options: &str) -> Pixmap {
    let out = snapshot.with_extension("png");
    plot(snapshot, &format!("{options} --out {}", out.display())).unwrap();
    Pixmap::load_png(out).unwrap()
}

fn is(picture: &Pixmap, x: u32, y: u32, colour: [u8; 3]) -> bool {
    let pixel = picture.pixel(x, y).unwrap();
    [pixel.red(), pixel.green(), pixel.blue()] == colour
}

/// Places of all pixels of a colour, from a row on.
fn places(picture: &Pixmap, colour: [u8; 3], top: u32) -> Vec<(u32, u32)> {
    let all = (top..picture.height()).flat_map(|y| (0..picture.width()).map(move |x| (x, y)));
    all.filter(|&(x, y)| is(picture, x, y, colour)).collect()
}

/// A number of pixels.
fn real(count: usize) -> f64 {
    u32::try_from(count).unwrap().into()
}

/// Columns and rows that the pixels of a colour reach, below the legend.
fn bounds(picture: &Pixmap, colour: [u8; 3]) -> [u32; 4] {
    let found = places(picture, colour, 130);
    assert!(!found.is_empty(), "no pixel of {colour:?}");
    let xs = || found.iter().map(|p| p.0);
    let ys = || found.iter().map(|p| p.1);
    [
        xs().min().unwrap(),
        xs().max().unwrap(),
        ys().min().unwrap(),
        ys().max().unwrap(),
    ]
}

/// Particles of one body.
fn body(number: u32, points: impl IntoIterator<Item = [f64; 3]>) -> Particles {
    let points: Vec<_> = points.into_iter().collect();
    Particles {
        body: vec![number; points.len()],
        points,
    }
}

fn joined(parts: impl IntoIterator<Item = Particles>) -> Particles {
    let mut all = Particles::default();
    for part in parts {
        all.points.extend(part.points);
        all.body.extend(part.body);
    }
    all
}

/// Sites of a cubic lattice of so many steps from a corner.
fn cubic(corner: [f64; 3], counts: [i32; 3]) -> Vec<[f64; 3]> {
    let mut sites = Vec::new();
    for i in 0..counts[0] {
        for j in 0..counts[1] {
            for k in 0..counts[2] {
                let at = |n: i32, c: f64| c + (f64::from(n) + 0.5) * STEP;
                sites.push([at(i, corner[0]), at(j, corner[1]), at(k, corner[2])]);
            }
        }
    }
    sites
}

/// Sites of a hexagonal lattice with one for each cubic step within a box about the middle.
fn hexagonal(half: [f64; 3]) -> Vec<[f64; 3]> {
    let a = STEP * 2_f64.powf(1.0 / 6.0);
    let (row, layer) = (a * 0.75_f64.sqrt(), a * (2.0_f64 / 3.0).sqrt());
    let mut sites = Vec::new();
    for k in -30..30_i32 {
        for j in -30..30_i32 {
            for i in -30..30_i32 {
                let odd = f64::from(k.rem_euclid(2));
                let x = (f64::from(i) + 0.5 * f64::from(j.rem_euclid(2)) + 0.5 * odd) * a;
                let y = (f64::from(j) + odd / 3.0) * row;
                let z = (f64::from(k) + 0.5) * layer;
                if [x, y, z].iter().zip(half).all(|(c, h)| c.abs() < h) {
                    sites.push([x, y, z]);
                }
            }
        }
    }
    sites
}

fn turned(sites: Vec<[f64; 3]>, angle: f64) -> Vec<[f64; 3]> {
    let (sin, cos) = angle.sin_cos();
    let turn = |[x, y, z]: [f64; 3]| [cos * x - sin * z, y, sin * x + cos * z];
    sites.into_iter().map(turn).collect()
}

fn case(bodies: &[&str]) -> Case {
    Case {
        bodies: bodies.iter().map(|&name| name.to_owned()).collect(),
        spacings: vec![STEP; bodies.len()],
        symmetry: Vec::new(),
        ..Case::quarter()
    }
}

fn snapshot(folder: &Path, case: &Case, particles: &Particles) -> PathBuf {
    let path = folder.join("state.vtkhdf");
    write(&path, case, particles, 0.0);
    path
}

/// What the picture says of where its section is.
fn caption(snapshot: &Path, request: &Request) -> String {
    let source = Source {
        name: String::new(),
        snapshots: vec![snapshot.to_owned()],
    };
    Pictures::new(&FileOpener, &[source], request)
        .unwrap()
        .caption()
        .to_owned()
}

#[test]
fn a_block_has_no_holes_wherever_it_is_cut() {
    let folder = tempfile::tempdir().unwrap();
    let half = 8.0 * STEP;
    let lattices = [
        ("cubic", cubic([-half; 3], [16; 3])),
        ("hexagonal", hexagonal([half; 3])),
        ("turned", turned(cubic([-half; 3], [16; 3]), 0.4)),
    ];
    for (name, sites) in lattices {
        let path = snapshot(folder.path(), &case(&["block"]), &body(0, sites));
        // Through a layer, between two, and anywhere else.
        let planes = [
            "y=0",
            "y=0.5mm",
            "y=0.23mm",
            "x=-1.37mm",
            "z=2mm",
            "z=0.9mm",
        ];
        // A turned block is cut across its edges only about the axis of the turn.
        let planes = &planes[..if name == "turned" { 3 } else { 6 }];
        for plane in planes {
            let options = format!("--section {plane} --view=-12:12,-12:12mm");
            let picture = picture(&path, &options);
            let [left, right, top, bottom] = bounds(&picture, FIRST);
            let area = real(places(&picture, FIRST, 130).len());
            let square = f64::from(right - left + 1) * f64::from(bottom - top + 1);
            // A turned square covers less of the one about it; a hexagonal lattice has jagged
            // faces.
            let (share, bound) = match name {
                "turned" => ((0.4_f64.sin() + 0.4_f64.cos()).powi(-2), 0.04),
                "hexagonal" => (0.95, 0.05),
                _ => (1.0, 0.02),
            };
            assert!(
                (area / square / share - 1.0).abs() < bound,
                "{name} {plane}: {area} of {square}"
            );
            // Nothing but the body in the middle third.
            let inset = (right - left) / 3;
            for y in top + inset..bottom - inset {
                for x in left + inset..right - inset {
                    assert!(
                        is(&picture, x, y, FIRST),
                        "{name} {plane}: hole at {x}, {y}"
                    );
                }
            }
        }
    }
}

#[test]
fn faces_stand_half_a_spacing_outside() {
    let folder = tempfile::tempdir().unwrap();
    let path = snapshot(
        folder.path(),
        &case(&["block"]),
        &body(0, cubic([0.0; 3], [10, 10, 5])),
    );
    for (plane, wide, high) in [
        ("y=5mm", 10.0, 5.0),
        ("y=4.6mm", 10.0, 5.0),
        ("z=2mm", 10.0, 10.0),
    ] {
        let picture = picture(&path, &format!("--section {plane}"));
        let [left, right, top, bottom] = bounds(&picture, FIRST);
        let aspect = f64::from(right - left + 1) / f64::from(bottom - top + 1);
        // Edges are up to a tenth of a spacing outside.
        assert!(
            (aspect / (wide / high) - 1.0).abs() < 0.02,
            "{plane}: {aspect}"
        );
    }
    // The particles beside a plane that is the face itself are half a spacing from it.
    assert!(!places(&picture(&path, "--section z=0"), FIRST, 130).is_empty());
    assert!(
        plot(&path, "--section z=-1mm")
            .unwrap_err()
            .contains("no particle")
    );
}

#[test]
fn bodies_in_touch_meet_in_a_line() {
    let folder = tempfile::tempdir().unwrap();
    // The second lattice is half a spacing off along the face.
    let particles = joined([
        body(0, cubic([-5e-3, -3e-3, -4e-3], [10, 6, 4])),
        body(1, cubic([-4.5e-3, -3e-3, 0.0], [10, 6, 4])),
    ]);
    let path = snapshot(folder.path(), &case(&["lower", "upper"]), &particles);
    for plane in ["y=0", "y=0.4mm"] {
        let picture = picture(&path, &format!("--section {plane} --view=-4:4,-3:3mm"));
        let [left, right, top, _] = bounds(&picture, SECOND);
        let [.., bottom] = bounds(&picture, FIRST);
        let white = |x: u32| {
            let rows = (top..bottom).filter(|&y| is(&picture, x, y, [255; 3]));
            rows.count()
        };
        let gaps: usize = (left + 2..right - 2).map(white).sum();
        assert_eq!(gaps, 0, "{plane}");
    }
}

#[test]
fn a_line_is_drawn_about_bodies() {
    let folder = tempfile::tempdir().unwrap();
    let particles = joined([
        body(0, cubic([-5e-3, -3e-3, -4e-3], [10, 6, 4])),
        body(1, cubic([-5e-3, -3e-3, 0.0], [10, 6, 4])),
    ]);
    let path = snapshot(folder.path(), &case(&["lower", "upper"]), &particles);
    let picture = picture(&path, "--section y=0");
    let [left, right, ..] = bounds(&picture, FIRST);
    let [.., bottom] = bounds(&picture, SECOND);
    let middle = u32::midpoint(left, right);
    let dark = |y: &u32| picture.pixel(middle, *y).unwrap().red() < 140;
    let line = (bottom..bottom + 4)
        .filter(dark)
        .filter(|&y| !is(&picture, middle, y, FIRST));
    assert!((1..=3).contains(&line.count()));
}

#[test]
fn debris_is_cells_of_the_volume_they_have() {
    let folder = tempfile::tempdir().unwrap();
    // Far from the axis the fixture's density is 2785 kg/m³.
    let particles = joined([
        body(0, [[0.010, 0.01, 0.002], [0.014, 0.01, 0.002]]),
        body(1, [[0.018, 0.01, 0.006]]),
    ]);
    let mut case = case(&["dust", "drop"]);
    case.densities = Some(vec![2785.0, 8.0 * 2785.0]);
    let path = snapshot(folder.path(), &case, &particles);
    let picture = picture(&path, "--section y=10mm");
    let [dust, drop] = [FIRST, SECOND].map(|colour| places(&picture, colour, 130).len());
    // Two balls of one spacing, one of two: a disc of twice the area of both.
    let ratio = real(drop) / real(dust);
    assert!((ratio / 2.0 - 1.0).abs() < 0.05, "{ratio}");
    let [left, right, ..] = bounds(&picture, FIRST);
    let [from, to, ..] = bounds(&picture, SECOND);
    let (pair, ball) = (f64::from(right - left + 1), f64::from(to - from + 1));
    assert!((pair / ball - 5.0 / 2.0).abs() < 0.05, "{pair} {ball}");
}

#[test]
fn a_whole_model_shows_what_its_quarter_does() {
    let folder = tempfile::tempdir().unwrap();
    for stage in [0.0, 1.0] {
        let quarter = impact(stage);
        let image = |sx: f64, sy: f64| Particles {
            points: quarter
                .points
                .iter()
                .map(|[x, y, z]| [sx * x, sy * y, *z])
                .collect(),
            body: quarter.body.clone(),
        };
        let signs = [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
        let whole = joined(signs.map(|(sx, sy)| image(sx, sy)));
        let view = "--view=-1:1,-1.4:0.7mm";
        let of_quarter = picture(&snapshot(folder.path(), &Case::quarter(), &quarter), view);
        let case = Case {
            symmetry: Vec::new(),
            ..Case::quarter()
        };
        let path = snapshot(folder.path(), &case, &whole);
        assert_eq!(caption(&path, &Request::default()), "section y = 0");
        let of_whole = picture(&path, view);
        for colour in [FIRST, SECOND] {
            let [a, b] = [&of_quarter, &of_whole].map(|p| real(places(p, colour, 130).len()));
            assert!(
                a > 10_000.0 && (b / a - 1.0).abs() < 0.01,
                "{stage}: {a} {b}"
            );
        }
    }
}

#[test]
fn the_default_plane_goes_along_the_impact_through_the_smaller_body() {
    let folder = tempfile::tempdir().unwrap();
    let plate = || body(0, cubic([-10e-3, -10e-3, -4e-3], [20, 20, 4]));
    let ball = |x: f64, y: f64| body(1, cubic([x, y, 0.0], [3; 3]));
    let request = Request {
        mirror: true,
        ..Request::default()
    };
    let of = |case: &Case, particles: &Particles| {
        caption(&snapshot(folder.path(), case, particles), &request)
    };
    let mut two = case(&["plate", "ball"]);
    // Off the middle of the plate.
    assert_eq!(
        of(&two, &joined([plate(), ball(2e-3, 4e-3)])),
        "section y = 5.5 mm"
    );
    // One plane of symmetry, which does or does not cut the ball.
    two.symmetry = vec![('x', 0.0)];
    assert_eq!(
        of(&two, &joined([plate(), ball(0.0, 4e-3)])),
        "section x = 0"
    );
    assert_eq!(
        of(&two, &joined([plate(), ball(3e-3, 4e-3)])),
        "section y = 5.5 mm,  mirrored at x = 0"
    );
    // The one normal to the impact shows nothing of it.
    two.symmetry = vec![('z', -4e-3)];
    assert_eq!(
        of(&two, &joined([plate(), ball(0.0, -1.5e-3)])),
        "section y = 0,  mirrored at z = −4 mm"
    );
    // A hollow body whose middle is empty.
    let shell = cubic([-5e-3; 3], [10; 3])
        .into_iter()
        .filter(|p| p[1].abs() > 3e-3);
    let shell = snapshot(folder.path(), &case(&["shell"]), &body(0, shell));
    assert_eq!(caption(&shell, &request), "section y = −3.5 mm");
    picture(&shell, "");
}

#[test]
fn the_legend_lists_what_is_seen() {
    let folder = tempfile::tempdir().unwrap();
    let particles = joined([
        body(0, cubic([-5e-3, -5e-3, -4e-3], [10, 10, 4])),
        body(1, cubic([-2e-3, -4e-3, 0.0], [4, 2, 4])),
        body(2, cubic([-2e-3, -1e-3, 0.0], [4, 2, 4])),
    ]);
    let path = snapshot(
        folder.path(),
        &case(&["plate", "hidden", "shown"]),
        &particles,
    );
    let in_legend = |picture: &Pixmap, colour: [u8; 3]| {
        let above = places(picture, colour, 0);
        above.iter().any(|&(_, y)| y < 130)
    };
    for style in ["", "--as particles"] {
        let both = picture(&path, &format!("--section y=0.5mm {style}"));
        let seen = [FIRST, SECOND, THIRD].map(|colour| in_legend(&both, colour));
        assert_eq!(seen, [true, false, true], "{style}");
        let part = picture(
            &path,
            &format!("--section y=0.5mm --view=-3:3,-3:-1mm {style}"),
        );
        let seen = [FIRST, SECOND, THIRD].map(|colour| in_legend(&part, colour));
        assert_eq!(seen, [true, false, false], "{style}");
    }
}

#[test]
fn a_slice_of_particles_is_captioned_as_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = snapshot(
        folder.path(),
        &case(&["block"]),
        &body(0, cubic([0.0; 3], [6; 3])),
    );
    let request = |thickness: Option<&str>, drawn_as: Option<&str>| Request {
        section: Some("y=3mm".to_owned()),
        thickness: thickness.map(str::to_owned),
        drawn_as: drawn_as.map(str::to_owned),
        ..Request::default()
    };
    let said = |thickness, drawn_as| caption(&path, &request(thickness, drawn_as));
    assert_eq!(said(None, None), "section y = 3 mm");
    assert_eq!(
        said(None, Some("particles")),
        "one layer of particles about y = 3 mm"
    );
    assert_eq!(said(Some("2.5mm"), None), "slice of 2.5 mm about y = 3 mm");
    let complaint = plot(&path, "--as cut --thickness 1mm").unwrap_err();
    assert!(complaint.contains("--as particles"), "{complaint}");
    assert!(plot(&path, "--as discs").unwrap_err().contains("particles"));
}

#[test]
fn runs_of_other_spacings_stand_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let coarse = folder.path().join("coarse.vtkhdf");
    write(
        &coarse,
        &case(&["block"]),
        &body(0, cubic([0.0; 3], [8, 8, 4])),
        0.0,
    );
    let halves = cubic([0.0; 3], [16, 16, 8])
        .into_iter()
        .map(|p| p.map(|c| 0.5 * c));
    let mut finer = case(&["other", "block"]);
    finer.spacings = vec![0.5 * STEP; 2];
    let fine = folder.path().join("fine.vtkhdf");
    write(&fine, &finer, &body(1, halves), 0.0);
    for style in ["", "--as particles"] {
        for (first, second) in [(&coarse, &fine), (&fine, &coarse)] {
            let out = folder.path().join("both.png");
            let options = format!(
                "--panels --section y=4mm --with {} --out {} {style}",
                second.display(),
                out.display()
            );
            plot(first, &options).unwrap();
            let both = Pixmap::load_png(&out).unwrap();
            // The block has one colour in both, whatever its number in its own run.
            let colour = if first == &coarse { FIRST } else { SECOND };
            let half = both.width() / 2;
            let found = places(&both, colour, 150);
            let left = found.iter().filter(|p| p.0 < half).count();
            let ratio = real(found.len() - left) / real(left);
            // Rims of discs are as wide in both.
            assert!((ratio - 1.0).abs() < 0.15, "{style}: {ratio}");
        }
    }
}

#[test]
fn mirrored_vectors_point_the_other_way() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("state.vtkhdf");
    write(&path, &Case::quarter(), &impact(0.0), 0.0);
    let picture = picture(
        &path,
        "--field velocity.x --range=-0.1:0.1km/s --view=-0.6:0.6,-0.4:0.8mm",
    );
    let (red, blue) = ([180, 4, 38], [59, 76, 192]);
    // Without the colour bar, which stands beyond.
    let count = |colour: [u8; 3], columns: std::ops::Range<u32>| {
        let found = places(&picture, colour, 130);
        found.iter().filter(|p| columns.contains(&p.0)).count()
    };
    let (left, right) = (0..500, 650..950);
    assert!(count(blue, left.clone()) > 10_000 && count(red, right.clone()) > 10_000);
    assert_eq!([count(red, left), count(blue, right)], [0, 0]);
}

#[test]
fn rows_far_from_the_plane_are_skipped() {
    // A row whose body is none of the case would be refused if it were read.
    let folder = tempfile::tempdir().unwrap();
    let mut particles = body(0, cubic([0.0; 3], [6, 6, 6]));
    particles.points.push([0.0, 1.0, 0.0]);
    particles.body.push(9);
    let path = snapshot(folder.path(), &case(&["block"]), &particles);
    picture(&path, "--section y=3mm");
    let complaint = plot(&path, "--section y=1m").unwrap_err();
    assert!(complaint.contains("body 9"), "{complaint}");
}

#[test]
fn endings_of_no_picture_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = snapshot(
        folder.path(),
        &case(&["block"]),
        &body(0, cubic([0.0; 3], [4; 3])),
    );
    let out = |name: &str| {
        plot(
            &path,
            &format!("--out {}", folder.path().join(name).display()),
        )
    };
    for name in ["x.pdf", "x.jpg", "x.pgn", "deep/er/x.svgz"] {
        let complaint = out(name).unwrap_err();
        assert!(complaint.contains(".png, .svg or .csv"), "{complaint}");
    }
    let made = std::fs::read_dir(folder.path()).unwrap().count();
    assert_eq!(made, 1, "only the snapshot is there");
    out("x.PNG").unwrap();
    out("x.SVG").unwrap();
    for name in ["pictures", "v1.2", "pictures.old/"] {
        out(name).unwrap();
        assert!(
            folder.path().join(name).join("state-body.png").is_file(),
            "{name}"
        );
    }
    out("pictures.old").unwrap();
}
