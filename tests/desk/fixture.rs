//! Synthetic snapshots in the layout of the developer guide, for the tests of `whipple plot`.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use app::plot::{self as command, PlotArgs};
use clap::Parser;
use hdf5::types::{FixedAscii, FixedUnicode};

/// Particle spacing of the synthetic impact (m).
pub const SPACING: f64 = 2e-5;

/// Particles of a snapshot, row by row.
#[derive(Default)]
pub struct Particles {
    pub points: Vec<[f64; 3]>,
    pub body: Vec<u32>,
}

/// What a snapshot says of its case.
pub struct Case {
    pub title: String,
    pub bodies: Vec<String>,
    pub spacings: Vec<f64>,
    pub symmetry: Vec<(char, f64)>,
    pub dimension: u64,
    /// Initial densities (kg/m³); snapshots of older versions do not say them.
    pub densities: Option<Vec<f64>>,
}

impl Case {
    /// A sphere on a plate, one quarter of it.
    pub fn quarter() -> Self {
        Self {
            title: "Aluminium sphere on an aluminium plate at 7 km/s".to_owned(),
            bodies: vec!["sphere".to_owned(), "plate".to_owned()],
            spacings: vec![SPACING; 2],
            symmetry: vec![('x', 0.0), ('y', 0.0)],
            dimension: 3,
            densities: None,
        }
    }
}

/// A quarter of a sphere of radius 0.3 mm above a plate of 0.2 mm × radius 1.5 mm: about 48,000
/// particles, moved and torn as if `stage` (0 to 1) of 0.2 µs had passed.
pub fn impact(stage: f64) -> Particles {
    let mut particles = Particles::default();
    let half = |k: i32| (f64::from(k) + 0.5) * SPACING;
    let (sphere, plate, thickness) = (3e-4, 1.5e-3, 2e-4);
    for i in 0..75 {
        for j in 0..75 {
            for k in -10..30 {
                let (x, y, z) = (half(i), half(j), half(k));
                let r = x.hypot(y);
                let in_sphere = z > 0.0 && r.hypot(z - sphere) < sphere;
                let in_plate = z < 0.0 && z > -thickness && r < plate;
                if in_sphere || in_plate {
                    let point = deform([x, y, z], in_sphere, stage);
                    particles.points.push(point);
                    particles.body.push(u32::from(in_plate));
                }
            }
        }
    }
    particles
}

/// A made-up flow that looks like a debris cloud.
fn deform([x, y, z]: [f64; 3], sphere: bool, stage: f64) -> [f64; 3] {
    let r = x.hypot(y);
    let near = (-(r / 3.5e-4).powi(4)).exp();
    let spread = 1.0 + stage * near * if sphere { 0.8 } else { 1.6 };
    let lip = stage * 2.5e-4 * (-((r - 6e-4) / 1.2e-4).powi(2)).exp();
    let push = if sphere {
        1.0e-3
    } else {
        1.1e-3 + 2.0 * (z + 1e-4)
    };
    let jitter = |a: f64| 0.4 * SPACING * stage * near * (a * 7.3e5).sin();
    [
        (x + jitter(y + 2.0 * z)).abs() * spread,
        (y + jitter(x - z)).abs() * spread,
        z - stage * push * near + if sphere { 0.0 } else { lip } + jitter(x + y),
    ]
}

/// Fields that look like those of an impact: name, unit, components, value of a particle.
type Made = (
    &'static str,
    &'static str,
    usize,
    fn(&[f64; 3], usize) -> f64,
);

const FIELDS: [Made; 5] = [
    ("pressure", "Pa", 1, |p, _| {
        let d = p[0].hypot(p[1]).hypot(p[2]) / 2.5e-4;
        6e10 * (-d * d).exp() - 1.2e9 * (d - 2.0).abs().min(1.0)
    }),
    ("density", "kg/m^3", 1, |p, _| {
        2785.0 * (1.0 + 0.4 * (-(p[0].hypot(p[1]) / 4e-4).powi(2)).exp())
    }),
    ("velocity", "m/s", 3, |p, c| {
        let near = (-(p[0].hypot(p[1]) / 4e-4).powi(2)).exp();
        [
            1500.0 * near * p[0] / 4e-4,
            1500.0 * near * p[1] / 4e-4,
            900.0 - 6500.0 * near,
        ][c]
    }),
    ("deviatoric_stress", "Pa", 6, |p, c| {
        let s = 1.7e8 * (-(p[0].hypot(p[1]) / 9e-4).powi(2)).exp();
        [s, -0.5 * s, -0.5 * s, 0.0, 0.0, 0.0][c]
    }),
    ("contact_stress", "Pa", 6, |_, c| {
        [-3e7, 0.0, 0.0, 1e7, 0.0, 0.0][c]
    }),
];

/// Writes a snapshot.
pub fn write(path: &Path, case: &Case, particles: &Particles, time: f64) {
    let file = hdf5::File::create(path).expect("a new file");
    let root = file.create_group("VTKHDF").unwrap();
    let n = particles.points.len();
    let points: Vec<f64> = particles.points.concat();
    array(&root, "Points", &points, 3);
    let counts = [i64::try_from(n).unwrap()];
    let builder = root.new_dataset_builder();
    builder.with_data(&counts).create("NumberOfPoints").unwrap();
    let data = root.create_group("PointData").unwrap();
    for (name, unit, width, value) in FIELDS {
        let values: Vec<f64> = particles
            .points
            .iter()
            .flat_map(|p| (0..width).map(move |c| value(p, c)))
            .collect();
        array(&data, name, &values, width);
        text(&data.dataset(name).unwrap(), "unit", unit);
        text(&data.dataset(name).unwrap(), "description", "made up");
    }
    let ids: Vec<u64> = (0..n as u64).collect();
    let builder = data.new_dataset_builder();
    builder.with_data(&ids).create("id").unwrap();
    // A string of fixed length, as other writers make them.
    let one = FixedAscii::<4>::from_ascii("1").unwrap();
    let unit = data.dataset("id").unwrap();
    unit.new_attr::<FixedAscii<4>>()
        .create("unit")
        .unwrap()
        .write_scalar(&one)
        .unwrap();
    let builder = data.new_dataset_builder();
    builder.with_data(&particles.body).create("body").unwrap();
    text(&data.dataset("body").unwrap(), "unit", "1");
    let field = root.create_group("FieldData").unwrap();
    array(&field, "TimeValue", &[time], 1);

    let about = file.create_group("whipple").unwrap();
    text(&about, "title", &case.title);
    text(
        &about,
        "bodies",
        &serde_json::to_string(&case.bodies).unwrap(),
    );
    text(
        &about,
        "spacings",
        &serde_json::to_string(&case.spacings).unwrap(),
    );
    if let Some(densities) = &case.densities {
        text(
            &about,
            "densities",
            &serde_json::to_string(densities).unwrap(),
        );
    }
    let dimension = about.new_attr::<u64>().create("dimension").unwrap();
    dimension.write_scalar(&case.dimension).unwrap();
    text(
        &about,
        "rigid",
        &serde_json::to_string(&vec![false; case.bodies.len()]).unwrap(),
    );
    text(
        &about,
        "symmetry",
        &serde_json::to_string(&case.symmetry).unwrap(),
    );
}

/// Adds a field of `width` numbers for each particle to a snapshot.
pub fn add_field(path: &Path, name: &str, values: &[f64], width: usize) {
    let file = hdf5::File::open_rw(path).expect("a snapshot");
    let data = file.group("VTKHDF/PointData").unwrap();
    array(&data, name, values, width);
    text(&data.dataset(name).unwrap(), "unit", "1");
}

fn array(group: &hdf5::Group, name: &str, data: &[f64], width: usize) {
    let rows = data.len() / width;
    let shape = if width == 1 {
        vec![rows]
    } else {
        vec![rows, width]
    };
    let dataset = group
        .new_dataset::<f64>()
        .shape(shape)
        .create(name)
        .unwrap();
    dataset.as_writer().write_raw(data).unwrap();
}

fn text(place: &hdf5::Location, name: &str, value: &str) {
    // UTF-8 of fixed length, as the program's own writer makes it.
    let value: FixedUnicode<256> = value.parse().unwrap();
    let attribute = place.new_attr::<FixedUnicode<256>>().create(name).unwrap();
    attribute.write_scalar(&value).unwrap();
}

/// A run folder with three snapshots of the impact and a history.
pub fn run(folder: &Path) -> PathBuf {
    let run = folder.join("run");
    std::fs::create_dir_all(run.join("snapshots")).unwrap();
    for k in 0..3_u32 {
        let stage = f64::from(k) / 2.0;
        let name = format!("snapshots/{k:06}.vtkhdf");
        write(
            &run.join(name),
            &Case::quarter(),
            &impact(stage),
            2e-7 * stage,
        );
    }
    let mut rows = String::from(
        "# energies in J, time in s\n\
         step,time,dt,kinetic_energy,internal_energy,contact_energy,total_energy\n",
    );
    for k in 0..=400 {
        let s = f64::from(k) / 400.0;
        let lost = 2.4e-3 * (1.0 - (-4.0 * s).exp());
        let contact = 2e-4 * (20.0 * s * (1.0 - 20.0 * s).exp());
        let kinetic = 7.71e-3 - lost - contact;
        let (t, sum) = (2e-7 * s, kinetic + lost + contact);
        writeln!(
            rows,
            "{k},{t:e},5e-10,{kinetic:e},{lost:e},{contact:e},{sum:e}"
        )
        .unwrap();
    }
    std::fs::write(run.join("history.csv"), rows).unwrap();
    run
}

#[derive(Parser)]
struct Cli {
    #[command(flatten)]
    args: PlotArgs,
}

/// Runs `whipple plot` with the options of one line; the complaint, if there is one.
pub fn plot(source: &Path, options: &str) -> Result<(), String> {
    let words = ["plot", source.to_str().unwrap()];
    let words = words.into_iter().chain(options.split_whitespace());
    let cli = Cli::try_parse_from(words).map_err(|e| e.to_string())?;
    command::run(&cli.args).map_err(|e| e.to_string())
}
