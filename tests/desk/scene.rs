//! Views of whole models, radiographs and movies, as `whipple plot` draws them.

use std::cmp::Ordering;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

use plot::{RadiographRequest, Radiographs, Source};
use resvg::tiny_skia::Pixmap;

use crate::fixture::{Case, Particles, SPACING, impact, plot, write};
use files::FileOpener;

/// What a pixel shows: colours of bodies are more or less bright, and mixed at edges.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shows {
    Paper,
    /// The first body, which is blue.
    First,
    /// The second, which is orange.
    Second,
    /// Both by halves.
    Both,
}

/// The panel of a picture: what stands below the legend and above the axes.
struct Panel {
    width: usize,
    rows: Vec<Vec<Shows>>,
}

impl Panel {
    fn count(&self, wanted: Shows) -> usize {
        self.rows.iter().flatten().filter(|&&s| s == wanted).count()
    }

    /// First and last column with matter.
    fn columns(&self) -> (usize, usize) {
        let matter = |x: &usize| self.rows.iter().any(|row| row[*x] != Shows::Paper);
        let columns = || (0..self.width).filter(matter);
        (columns().next().unwrap(), columns().next_back().unwrap())
    }
}

fn pixels(snapshot: &Path, options: &str) -> Pixmap {
    let out = snapshot.with_extension("png");
    plot(snapshot, &format!("{options} --out {}", out.display())).unwrap();
    Pixmap::load_png(out).unwrap()
}

fn panel(snapshot: &Path, options: &str) -> Panel {
    let picture = pixels(snapshot, options);
    let shows = |x, y| {
        let pixel = picture.pixel(x, y).unwrap();
        let [red, green, blue] = [pixel.red(), pixel.green(), pixel.blue()];
        match red.cmp(&blue) {
            Ordering::Greater => Shows::Second,
            Ordering::Less => Shows::First,
            Ordering::Equal if [red, green] == [255; 2] => Shows::Paper,
            Ordering::Equal => Shows::Both,
        }
    };
    let row = |y| (0..picture.width()).map(|x| shows(x, y)).collect();
    Panel {
        width: picture.width() as usize,
        rows: (135..picture.height() - 116).map(row).collect(),
    }
}

fn snapshot(folder: &Path, case: &Case, particles: &Particles) -> PathBuf {
    let path = folder.join("state.vtkhdf");
    write(&path, case, particles, 0.0);
    path
}

/// The quarter of an impact whose masses are known.
fn weighed() -> Case {
    Case {
        densities: Some(vec![8930.0, 2785.0]),
        ..Case::quarter()
    }
}

fn quarter(folder: &Path, stage: f64) -> PathBuf {
    snapshot(folder, &weighed(), &impact(stage))
}

/// Two blocks of bodies of their own, one behind the other along an axis.
fn pair(folder: &Path, axis: usize) -> PathBuf {
    let mut particles = Particles::default();
    for body in 0..2_u32 {
        for k in 0..512 {
            let mut point = [k % 8, k / 8 % 8, k / 64].map(|n| (f64::from(n) - 3.5) * SPACING);
            point[axis] += 3e-4 * f64::from(body);
            particles.points.push(point);
            particles.body.push(body);
        }
    }
    let case = Case {
        symmetry: Vec::new(),
        ..Case::quarter()
    };
    snapshot(folder, &case, &particles)
}

#[test]
#[ignore = "slow"]
fn what_is_nearer_hides_what_is_behind() {
    let folder = tempfile::tempdir().unwrap();
    for (axis, views) in [
        (0, ["left", "right"]),
        (1, ["front", "back"]),
        (2, ["bottom", "top"]),
    ] {
        let snapshot = pair(folder.path(), axis);
        for (view, [seen, hidden]) in views
            .into_iter()
            .zip([[Shows::First, Shows::Second], [Shows::Second, Shows::First]])
        {
            let panel = panel(&snapshot, &format!("--view {view} --width 600"));
            assert!(panel.count(seen) > 10_000, "{view}");
            assert_eq!(panel.count(hidden), 0, "{view}");
        }
    }
    // From the side both are seen, as large.
    let both = panel(&pair(folder.path(), 0), "--from 0,0 --width 600");
    let counts = [Shows::First, Shows::Second].map(|s| both.count(s));
    // But for round-off, which may move an edge over the middle of a sample.
    assert!(
        counts[0].abs_diff(counts[1]) <= counts[0] / 100,
        "{counts:?}"
    );
}

#[test]
fn the_image_of_a_mirror_is_the_same_to_the_pixel() {
    let folder = tempfile::tempdir().unwrap();
    let tossed = quarter(folder.path(), 1.0);
    for options in ["--view front", "--view front --cut none", "--view top"] {
        let panel = panel(&tossed, &format!("{options} --width 600"));
        let (first, last) = panel.columns();
        assert!(last - first > 400);
        // The light is not the same on both sides, what there is is.
        let is_paper = |row: &[Shows], x: usize| row[x] == Shows::Paper;
        for (y, row) in panel.rows.iter().enumerate() {
            for x in first..=last {
                let image = first + last - x;
                assert_eq!(
                    is_paper(row, x),
                    is_paper(row, image),
                    "{options}: {x}, {y}"
                );
            }
        }
    }
    // The quarter alone is half as wide, of matter that is as dense as at the start: nothing has been tossed
    // beyond the plane, and balls are no larger than the lattice has room for.
    let even = Case {
        densities: Some(vec![2785.0; 2]),
        ..Case::quarter()
    };
    let start = snapshot(folder.path(), &even, &impact(0.0));
    let width = |options: &str| {
        let (first, last) = panel(&start, options).columns();
        last - first
    };
    let [whole, half] =
        ["", "--no-mirror"].map(|o| width(&format!("--from front --view=-1.6:1.6,-1:1mm {o}")));
    // Balls beside the plane stand a fifth of a spacing, 1.6 pixels, beyond it.
    assert!((2 * half).abs_diff(whole) <= 5, "{half} {whole}");
}

#[test]
#[ignore = "slow"]
fn a_cut_takes_away_what_is_before_it() {
    let folder = tempfile::tempdir().unwrap();
    let snapshot = quarter(folder.path(), 0.0);
    let count = |options: &str| panel(&snapshot, &format!("{options} --width 600"));
    assert!(count("--view top --cut none").count(Shows::First) > 1000);
    // The sphere lies above the plate, whose upper layers go with it.
    let below = count("--view top --cut z=-0.05mm");
    assert_eq!(below.count(Shows::First), 0);
    assert!(below.count(Shows::Second) > 10_000);
    // A wedge leaves three quarters, two cuts one, no cut all; and what is open is what opens a mirror.
    let matter = |options: &str| {
        let panel = count(&format!(
            "--from 45,60 --view=-1.6:1.6,-1.6:1.6mm {options}"
        ));
        panel.count(Shows::First) + panel.count(Shows::Second)
    };
    let whole = matter("--cut none");
    let wedge = matter("--cut x=0,y=0");
    let quarter = matter("--cut x=0 --cut y=0");
    assert_eq!(matter(""), wedge);
    assert!(
        quarter < wedge && wedge < whole,
        "{quarter} {wedge} {whole}"
    );
    let share =
        f64::from(u32::try_from(quarter).unwrap()) / f64::from(u32::try_from(whole).unwrap());
    assert!((0.2..0.4).contains(&share), "{share}");
    let complaint = |options: &str| plot(&snapshot, options).unwrap_err();
    assert!(complaint("--view front --cut x=0").contains("from the front"));
    assert!(complaint("--view front --cut w=0").contains("y=0"));
    assert!(complaint("--view front --cut y=9mm").contains("nothing to see"));
}

#[test]
fn bodies_are_shown_alone_or_let_others_through() {
    let folder = tempfile::tempdir().unwrap();
    let snapshot = quarter(folder.path(), 0.0);
    let count = |options: &str| panel(&snapshot, &format!("--view bottom --width 600 {options}"));
    // From below the plate hides the sphere.
    assert_eq!(count("").count(Shows::First), 0);
    assert_eq!(count("--bodies sphere").count(Shows::Second), 0);
    let through = pixels(&snapshot, "--view bottom --width 600 --transparent plate");
    let hidden = pixels(&snapshot, "--view bottom --width 600");
    let middle = |picture: &Pixmap| {
        let pixel = picture.pixel(300, 400).unwrap();
        [pixel.red(), pixel.green(), pixel.blue()].map(i32::from)
    };
    let (through, hidden) = (middle(&through), middle(&hidden));
    assert!(hidden[0] - hidden[2] > 100, "{hidden:?}");
    assert!(through[0] < hidden[0] - 60, "{through:?} {hidden:?}");
    let complaint = |options: &str| plot(&snapshot, options).unwrap_err();
    assert!(complaint("--view top --bodies ball").contains("sphere, plate"));
    assert!(complaint("--view top --transparent ball").contains("sphere, plate"));
    assert!(complaint("--bodies plate").contains("--view isometric"));
    assert!(complaint("--transparent plate").contains("--view isometric"));
}

#[test]
fn views_have_the_same_pixels_on_any_threads() {
    let folder = tempfile::tempdir().unwrap();
    let snapshot = quarter(folder.path(), 1.0);
    for options in [
        "--view isometric --width 500 --transparent plate",
        "--view 20,30 --width 500 --field velocity.x",
        "--radiograph z --width 500",
    ] {
        let drawn = [1, 4].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
            let pool = pool.build().unwrap();
            pool.install(|| pixels(&snapshot, options)).data().to_vec()
        });
        assert!(drawn[0] == drawn[1], "{options}");
    }
}

#[test]
fn a_radiograph_holds_all_mass_and_no_more() {
    let folder = tempfile::tempdir().unwrap();
    let case = weighed();
    let particles = impact(1.0);
    let snapshot = snapshot(folder.path(), &case, &particles);
    let count = |body| {
        let own = particles.body.iter().filter(|&&b| b == body).count();
        f64::from(u32::try_from(own).unwrap())
    };
    let volume = SPACING.powi(3);
    let [sphere, plate] = [8930.0 * count(0), 2785.0 * count(1)].map(|m| m * volume);
    let source = [Source {
        name: String::new(),
        snapshots: vec![snapshot.clone()],
    }];
    for (along, mirror, bodies, mass) in [
        ("x", true, "", 4.0 * (sphere + plate)),
        ("z", false, "", sphere + plate),
        ("y", true, "sphere", 4.0 * sphere),
    ] {
        let request = RadiographRequest {
            along: along.to_owned(),
            mirror,
            bodies: bodies.split_whitespace().map(str::to_owned).collect(),
            ..RadiographRequest::default()
        };
        let radiographs = Radiographs::new(&FileOpener, &source, &request).unwrap();
        let size = [321, 123];
        let areal = radiographs.areal(0, size).unwrap();
        let sum: f64 = areal.iter().sum::<f64>() * radiographs.pixel_area(size);
        assert!((sum / mass - 1.0).abs() < 1e-9, "{along}: {sum} {mass}");
    }
    // An undeformed plate of .2 mm along z has its density times its thickness.
    write(&snapshot, &case, &impact(0.0), 0.0);
    let radiographs = Radiographs::new(
        &FileOpener,
        &source,
        &RadiographRequest {
            along: "z".to_owned(),
            mirror: true,
            bodies: vec!["plate".to_owned()],
            ..RadiographRequest::default()
        },
    )
    .unwrap();
    let areal = radiographs.areal(0, [300, 300]).unwrap();
    let off_middle = areal[150 * 300 + 60];
    // Sizes follow the made-up density, which is that of the start far from the axis alone.
    let bound = 0.01 * 2785.0 * 2e-4;
    assert!((off_middle - 2785.0 * 2e-4).abs() < bound, "{off_middle}");
    plot(&snapshot, "--radiograph y --range 0:10kg/m2 --width 500").unwrap();
    let complaint = plot(&snapshot, "--radiograph y --view front").unwrap_err();
    assert!(complaint.contains("line of sight"), "{complaint}");
}

#[test]
fn views_and_radiographs_are_images_among_the_words_of_an_svg() {
    let folder = tempfile::tempdir().unwrap();
    let snapshot = quarter(folder.path(), 1.0);
    for (options, words) in [
        ("--view isometric", "isometric"),
        ("--radiograph y", "radiograph along y"),
    ] {
        let out = folder.path().join("picture.svg");
        let options = format!("{options} --width 500 --out {}", out.display());
        plot(&snapshot, &options).unwrap();
        let picture = std::fs::read_to_string(out).unwrap();
        assert!(picture.contains("<image"), "{options}");
        assert!(picture.contains(words), "{options}");
    }
    plot(&snapshot, "--view top --width 500 --format svg").unwrap();
    assert!(snapshot.with_file_name("state-top-body.svg").is_file());
}

#[test]
fn a_movie_has_a_picture_for_each_snapshot() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    std::fs::create_dir_all(run.join("snapshots")).unwrap();
    for k in 0..3_u8 {
        let (path, stage) = (format!("snapshots/{k:06}.vtkhdf"), f64::from(k) / 2.0);
        write(&run.join(path), &weighed(), &impact(stage), 2e-7 * stage);
    }
    let at = |name: &str| folder.path().join(name);
    for (options, name) in [
        ("--view isometric --field velocity", "view.apng"),
        ("--field pressure", "section.png"),
    ] {
        let out = at(name);
        let options = format!(
            "{options} --movie --fps 4 --width 450 --out {}",
            out.display()
        );
        plot(&run, &options).unwrap();
        let decoder = png::Decoder::new(BufReader::new(File::open(&out).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let control = reader.info().animation_control().unwrap();
        assert_eq!((control.num_frames, control.num_plays), (3, 0));
        let mut pictures = Vec::new();
        for _ in 0..3 {
            let mut picture = vec![0; reader.output_buffer_size().unwrap()];
            reader.next_frame(&mut picture).unwrap();
            let shown = reader.info().frame_control().unwrap();
            assert_eq!((shown.delay_num, shown.delay_den), (1, 4));
            pictures.push(picture);
        }
        assert!(pictures[0] != pictures[1] && pictures[1] != pictures[2]);
    }
    for (options, name) in [("--radiograph y", "mass.gif"), ("--view left", "side.gif")] {
        let out = at(name);
        let options = format!(
            "{options} --width 450 --index 0,2 --movie {}",
            out.display()
        );
        plot(&run, &options).unwrap();
        let mut options = gif::DecodeOptions::new();
        options.set_color_output(gif::ColorOutput::Indexed);
        let mut reader = options.read_info(File::open(&out).unwrap()).unwrap();
        let mut pictures = 0;
        while let Some(frame) = reader.read_next_frame().unwrap() {
            assert_eq!(frame.delay, 10);
            pictures += 1;
        }
        assert_eq!((pictures, reader.width()), (2, 450));
    }
    plot(&run, "--movie --width 400").unwrap();
    assert!(run.join("pictures/movie-body.apng").is_file());
    let complaint = |options: &str| plot(&run, options).unwrap_err();
    assert!(complaint("--movie film.mp4").contains(".gif"));
    assert!(complaint("--movie --out film.mp4").contains(".gif"));
    assert!(complaint("--movie --out film.svg").contains(".gif"));
    assert!(complaint("--movie --format svg").contains("cannot be used with"));
    assert!(complaint("--movie --fps 0").contains("0.1 to 50"));
    assert!(complaint("--history --movie").contains("cannot be used with"));
}

#[test]
fn flat_models_and_wrong_words_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case {
        dimension: 2,
        symmetry: Vec::new(),
        ..Case::quarter()
    };
    let particles = Particles {
        points: vec![[0.0; 3], [SPACING, 0.0, 0.0]],
        body: vec![0, 1],
    };
    let flat = snapshot(folder.path(), &case, &particles);
    let complaint = |options: &str| plot(&flat, options).unwrap_err();
    assert!(complaint("--view isometric").contains("three dimensions"));
    assert!(complaint("--radiograph z").contains("three dimensions"));
    assert!(complaint("--view above").contains("isometric, front"));
    assert!(complaint("--view front --from back").contains("both"));
    assert!(complaint("--view front --section y=0").contains("--cut"));
    assert!(complaint("--view front --csv").contains("no table"));
    assert!(complaint("--radiograph y --out mass.csv").contains("no table"));
    assert!(complaint("--from front --history").contains("leave the other kind out"));
    // What gauges have read is a folder of tables.
    let gauges = folder.path().join("gauges");
    std::fs::create_dir(&gauges).unwrap();
    let refused = plot(&gauges, "--from front").unwrap_err();
    assert!(refused.contains("leave the other kind out"), "{refused}");
}
