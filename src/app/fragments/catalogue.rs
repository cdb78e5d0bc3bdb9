//! The catalogue of all fragments: figures, surfaces, and the breakup model beside them.

use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;
use std::path::Path;

use super::FragmentsError;
use super::debris::main_body;
use super::loaded::Loaded;
use crate::output_format::wrote;
use desk::catalogue::breakup::Collision;
use desk::catalogue::{Grain, Solid, polydata, solids};
use engine::fragments::{Census, Fragment};
use files::output::{Column, OutputError, Table, Value, write_atomically};
use model::readable::{one_line, shown, with_unit};
use model::{Case, Vec3};
use plot::{Chart, Curve, Mark, Quantity, colour_of};

/// Mass (kg), momentum (kg m/s) and kinetic energy (J) of some matter of the whole model.
#[derive(Debug, Clone, Copy, Default)]
struct Ledger {
    mass: f64,
    momentum: [f64; 3],
    kinetic: f64,
}

impl Ledger {
    /// Adds so many copies of some matter that lies on this side of planes, of which no momentum along `odd` axes is left.
    fn add(&mut self, copies: f64, mass: f64, velocity: &[f64; 3], odd: [bool; 3]) {
        self.mass += copies * mass;
        for a in (0..3).filter(|a| !odd[*a]) {
            self.momentum[a] += copies * mass * velocity[a];
        }
        let square: f64 = velocity.iter().map(|v| v * v).sum();
        self.kinetic += 0.5 * copies * mass * square;
    }

    fn join(&mut self, other: &Self) {
        self.mass += other.mass;
        for a in 0..3 {
            self.momentum[a] += other.momentum[a];
        }
        self.kinetic += other.kinetic;
    }

    fn cells(&self, name: &'static str) -> Vec<Value<'static>> {
        let numbers = [self.mass]
            .into_iter()
            .chain(self.momentum)
            .chain([self.kinetic]);
        [Value::Word(name)]
            .into_iter()
            .chain(numbers.map(Value::Real))
            .collect()
    }
}

/// Writes the catalogue of a snapshot's fragments into a folder; returns what there is to say of it.
///
/// # Errors
/// [`FragmentsError`] if the model has not three dimensions, its surfaces cannot be found, or a file not be written.
pub fn write(
    folder: &Path,
    path: &Path,
    (loaded, census): (&Loaded, &Census),
    case: Option<&Case>,
) -> Result<String, FragmentsError> {
    if loaded.dimension != 3 {
        let reason = format!(
            "a catalogue is of models of three dimensions, and this has {}",
            loaded.dimension
        );
        return Err(super::loaded::wrong(path, reason));
    }
    let grains = grains(loaded, census);
    let solids = solids(&grains, census.fragments.len())
        .map_err(|reason| super::loaded::wrong(path, reason))?;
    std::fs::create_dir_all(folder).map_err(OutputError::io("create", folder))?;
    let mut text = String::new();
    save(
        &folder.join("catalogue.csv"),
        &table(loaded, census, &solids),
    )?;
    let (closed, ledger) = ledger(loaded, census);
    save(&folder.join("ledger.csv"), &ledger)?;
    let _ = writeln!(
        text,
        "\nledger: mass, momentum and kinetic energy of fragments, dust and what failed are those of all matter to {closed:.1e}"
    );
    let column = |value: fn(&Fragment, &Solid) -> f64| -> Vec<f64> {
        let all = census.fragments.iter().zip(&solids);
        all.map(|(fragment, solid)| value(fragment, solid))
            .collect()
    };
    let columns: [(&str, Vec<f64>); 4] = [
        ("mass", column(|fragment, _| fragment.mass)),
        (
            "speed",
            column(|fragment, _| Vec3::from(fragment.velocity).norm()),
        ),
        (
            "spin",
            column(|fragment, _| Vec3::from(fragment.spin).norm()),
        ),
        (
            "characteristic_length",
            column(|_, solid| solid.characteristic_length()),
        ),
    ];
    save(
        &folder.join("catalogue.vtk"),
        &polydata(&loaded.title, &solids, &columns),
    )?;
    let collision = case.and_then(collision);
    let chart = chart(loaded, census, (&solids, collision.as_ref()));
    let picture = folder.join("catalogue.png");
    chart.draw(None)?.save(&picture)?;
    wrote(&picture, "");
    if let Some(collision) = collision {
        let _ = writeln!(text, "{}", beside(&collision));
    }
    Ok(text)
}

fn save(path: &Path, content: &[u8]) -> Result<(), OutputError> {
    write_atomically(path, content)?;
    wrote(path, "");
    Ok(())
}

/// The breakup model of a collision in words.
fn beside(collision: &Collision) -> String {
    let energy = with_unit(collision.specific_energy(), "J/kg");
    let kind = if collision.is_catastrophic() {
        "both bodies break up (40 kJ/kg)"
    } else {
        "the larger is cratered (below 40 kJ/kg)"
    };
    format!(
        "NASA's breakup model: {energy} of the larger body, so {kind}; its curve is in catalogue.png"
    )
}

/// The particles of all fragments, with their images behind the planes that a fragment reaches across.
fn grains(loaded: &Loaded, census: &Census) -> Vec<Grain> {
    let piece_of: HashMap<u64, u32> = census.fragments.iter().map(|f| f.label).zip(0..).collect();
    let mut grains = Vec::new();
    for (i, label) in census.labels.iter().enumerate() {
        let Some(&piece) = piece_of.get(label) else {
            continue;
        };
        let (first, grain) = (grains.len(), loaded.grain(i, piece));
        // What is frozen is no matter.
        if grain.size <= 0.0 {
            continue;
        }
        grains.push(grain);
        // The centre of a fragment that reaches across a plane lies in it.
        let centre = &census.fragments[piece as usize].centre;
        for plane in &loaded.symmetry {
            let axis = plane.axis.index();
            if centre[axis] != plane.position {
                continue;
            }
            for k in first..grains.len() {
                let mut image = grains[k];
                image.centre[axis] = 2.0 * plane.position - image.centre[axis];
                if let Some(gradient) = &mut image.deformation {
                    // M F M of the mirror M.
                    for other in (0..3).filter(|other| *other != axis) {
                        gradient[3 * axis + other] = -gradient[3 * axis + other];
                        gradient[3 * other + axis] = -gradient[3 * other + axis];
                    }
                }
                grains.push(image);
            }
        }
    }
    grains
}

/// A row for each fragment, the heaviest first.
fn table(loaded: &Loaded, census: &Census, solids: &[Solid]) -> Vec<u8> {
    let mut columns = vec![
        Column::new("label", ""),
        Column::new("body", ""),
        Column::new("copies", ""),
        Column::new("particles", ""),
        Column::new("mass", "kg"),
    ];
    for (name, unit) in [("centre", "m"), ("velocity", "m/s"), ("spin", "rad/s")] {
        columns.extend(["x", "y", "z"].map(|axis| Column::new(&format!("{name}_{axis}"), unit)));
    }
    let rest = [
        ("volume", "m^3"),
        ("surface_area", "m^2"),
        ("cross_section", "m^2"),
        ("area_to_mass", "m^2/kg"),
        ("length_1", "m"),
        ("length_2", "m"),
        ("length_3", "m"),
        ("characteristic_length", "m"),
        ("number_by_length", ""),
    ];
    columns.extend(rest.map(|(name, unit)| Column::new(name, unit)));
    let numbers = numbers(census, solids);
    let all = census.fragments.iter().zip(solids).zip(numbers);
    let rows: Vec<Vec<Value>> = all
        .map(|((fragment, solid), number)| {
            let mut row = vec![
                Value::Count(fragment.label),
                Value::Word(&loaded.bodies[main_body(fragment)]),
                Value::Count(fragment.copies),
                Value::Count(fragment.particles),
                Value::Real(fragment.mass),
            ];
            let vectors = [fragment.centre, fragment.velocity, fragment.spin];
            row.extend(vectors.as_flattened().iter().copied().map(Value::Real));
            let ratio = solid.cross_section / fragment.mass;
            row.extend([solid.volume, solid.area, solid.cross_section, ratio].map(Value::Real));
            row.extend(solid.lengths.map(Value::Real));
            row.push(Value::Real(solid.characteristic_length()));
            row.push(Value::Count(number));
            row
        })
        .collect();
    Table::whole(&columns, &rows)
}

/// Of each fragment the number of those as long or longer, copies included.
fn numbers(census: &Census, solids: &[Solid]) -> Vec<u64> {
    let mut order: Vec<usize> = (0..solids.len()).collect();
    let length = |k: usize| solids[k].characteristic_length();
    order.sort_by(|a, b| length(*b).total_cmp(&length(*a)));
    let (mut numbers, mut before) = (vec![0; solids.len()], 0);
    for k in order {
        before += census.fragments[k].copies;
        numbers[k] = before;
    }
    numbers
}

/// Largest part by which a sum over fragments, dust and what failed is not that over all particles; and the table.
fn ledger(loaded: &Loaded, census: &Census) -> (f64, Vec<u8>) {
    let known: HashSet<u64> = census.fragments.iter().map(|f| f.label).collect();
    let odd: [bool; 3] =
        std::array::from_fn(|a| loaded.symmetry.iter().any(|plane| plane.axis.index() == a));
    let images = f64::from(1_u32 << loaded.symmetry.len());
    let [mut dust, mut failed, mut all] = [Ledger::default(); 3];
    let (mut size, mut kinetic) = (0.0, 0.0);
    for (i, one) in loaded.matter().enumerate() {
        let Some((_, mass, velocity)) = one else {
            continue;
        };
        all.add(images, mass, &velocity, odd);
        size += images * mass * Vec3::from(velocity).norm();
        let label = census.labels[i];
        if known.contains(&label) {
            kinetic += 0.5 * images * mass * Vec3::from(velocity).norm_squared();
        } else {
            let share = if label == u64::MAX {
                &mut failed
            } else {
                &mut dust
            };
            share.add(images, mass, &velocity, odd);
        }
    }
    let mut pieces = Ledger::default();
    for fragment in &census.fragments {
        #[expect(clippy::cast_precision_loss, reason = "at most eight")]
        let copies = fragment.copies as f64;
        pieces.add(copies, fragment.mass, &fragment.velocity, odd);
    }
    // That of its particles, of which its centre has a part.
    pieces.kinetic = kinetic;
    let mut sum = pieces;
    sum.join(&dust);
    sum.join(&failed);
    let apart = [
        (sum.mass - all.mass) / all.mass,
        (sum.kinetic - all.kinetic) / all.kinetic,
    ];
    let momentum = (0..3).map(|a| (sum.momentum[a] - all.momentum[a]) / size);
    let apart = apart
        .into_iter()
        .chain(momentum)
        .filter(|part| part.is_finite());
    let closed = apart.fold(0.0, |most, part| f64::max(most, part.abs()));
    let names = [
        ("of", ""),
        ("mass", "kg"),
        ("momentum_x", "kg m/s"),
        ("momentum_y", "kg m/s"),
        ("momentum_z", "kg m/s"),
        ("kinetic_energy", "J"),
    ];
    let rows = [
        pieces.cells("fragments"),
        dust.cells("dust"),
        failed.cells("failed"),
        all.cells("all matter"),
    ];
    (
        closed,
        Table::whole(&names.map(|(name, unit)| Column::new(name, unit)), &rows),
    )
}

/// The collision of the heaviest body of a case and of that which meets it fastest, if any does.
fn collision(case: &Case) -> Option<Collision> {
    let mass = |b: usize| {
        let body = &case.bodies[b];
        case.density_of(b) * body.shape.volume(case.dimension)
    };
    let deforming = || (0..case.bodies.len()).filter(|&b| case.bodies[b].rigid.is_none());
    let target = deforming().max_by(|&a, &b| mass(a).total_cmp(&mass(b)))?;
    let speed = |b: usize| (case.bodies[b].velocity - case.bodies[target].velocity).norm();
    let projectile = deforming()
        .filter(|&b| b != target)
        .max_by(|&a, &b| speed(a).total_cmp(&speed(b)))?;
    (speed(projectile) > 0.0).then(|| Collision {
        masses: [mass(projectile), mass(target)],
        speed: speed(projectile),
    })
}

/// The number of fragments as long as a length or longer, beside the breakup model.
fn chart(
    loaded: &Loaded,
    census: &Census,
    (solids, collision): (&[Solid], Option<&Collision>),
) -> Chart {
    let mut ends: Vec<(f64, u64)> = (solids.iter())
        .map(Solid::characteristic_length)
        .zip(numbers(census, solids))
        .filter(|(length, _)| *length > 0.0)
        .collect();
    ends.sort_by_key(|(_, number)| *number);
    let mut points = Vec::new();
    let mut before = None;
    for (length, number) in ends {
        #[expect(clippy::cast_precision_loss, reason = "a picture")]
        let number = number as f64;
        points.extend(before.map(|before| [length, before]));
        points.push([length, number]);
        before = Some(number);
    }
    let span = points
        .first()
        .zip(points.last())
        .map(|(long, short)| [short[0], long[0]]);
    let mut curves = vec![Curve {
        name: "fragments".to_owned(),
        colour: colour_of(0),
        mark: Mark::Line,
        points,
        ..Curve::default()
    }];
    if let (Some(collision), Some([short, long])) = (collision, span) {
        curves.push(Curve {
            name: "NASA's breakup model".to_owned(),
            colour: colour_of(1),
            mark: Mark::Line,
            points: [short, long]
                .map(|length| [length, collision.number(length)])
                .to_vec(),
            ..Curve::default()
        });
    }
    let axis = |label: &str, unit: &str| Quantity {
        label: label.to_owned(),
        unit: unit.to_owned(),
        logarithmic: true,
        ..Quantity::default()
    };
    Chart {
        title: one_line(&loaded.title).into_owned(),
        subtitle: format!(
            "fragments at {}, of {}",
            shown(loaded.time, "s"),
            shown(census.total.mass, "kg")
        ),
        x: axis("characteristic length", "m"),
        y: axis("number as long", ""),
        curves,
    }
}
