//! Gauges and witness planes against what is known of the matter about them.

use crate::common::outcome::start;
use crate::common::{SPACING, ball, case, planes, sphere_on_plate};
use comm::Comm;
use engine::measure::GaugeRow;
use engine::step::Simulation;
use engine::step::measurements;
use model::{Axis, Cadence, Case, Gauge, Vec3, Witness};

fn gauge(at: [f64; 3], fields: &[&str]) -> Gauge {
    Gauge {
        name: "gauge".into(),
        at,
        moves: false,
        particle: None,
        body: None,
        fields: fields.iter().map(|&field| field.into()).collect(),
        along: None,
        every: Cadence::Steps(1),
    }
}

fn read(simulation: &mut Simulation) -> Vec<GaugeRow> {
    measurements::read_gauges(simulation, &Comm::solo(), |_| true)
}

fn step(simulation: &mut Simulation, steps: usize) {
    for _ in 0..steps {
        simulation.advance(&Comm::solo()).unwrap();
    }
}

/// A gauge on a particle that it names reads that particle and what stands around it.
#[test]
fn a_gauge_names_its_particle() {
    let mut case = case(3, vec![ball("ball", 0.0, 6.0, 300.0)], 1.0);
    let named = Gauge {
        moves: true,
        particle: Some(u64::MAX),
        ..gauge([0.0; 3], &["velocity"])
    };
    case.measure.gauges = vec![named];
    let id = {
        let simulation = start(case.clone());
        let particles = &simulation.particles;
        let nearest = (0..particles.owned()).min_by(|&i, &j| {
            let square = |i: usize| particles.position[i].iter().map(|x| x * x).sum::<f64>();
            square(i).total_cmp(&square(j))
        });
        particles.id[nearest.unwrap()]
    };
    let mut nobody = start(case.clone());
    step(&mut nobody, 1);
    assert_eq!(read(&mut nobody)[0].coverage, 0.0);
    case.measure.gauges[0].particle = Some(id);
    let mut simulation = start(case);
    step(&mut simulation, 1);
    let names: Vec<String> = (simulation.gauges().columns())
        .map(|(name, _)| name)
        .collect();
    let row = &read(&mut simulation)[0];
    let value = |name: &str| row.values[names.iter().position(|own| own == name).unwrap()].unwrap();
    assert_eq!(row.coverage, 1.0);
    assert!(Vec3::from(row.position).norm() < SPACING);
    assert!((value("closest_neighbour") / SPACING - 1.0).abs() < 1e-6);
    // Sites of a cubic lattice within twice 1.3 spacings, or 1.2.
    assert!((56.0..=92.0).contains(&value("neighbours")), "{row:?}");
    assert_eq!(value("foreign_neighbours"), 0.0);
    assert!(value("closest_foreign").is_nan());
}

/// A mean of what is the same everywhere is that, to rounding; coverage tells inside, face and void.
#[test]
fn a_gauge_reads_the_matter_about_it() {
    let mut case = case(3, vec![ball("ball", 0.0, 6.0, 300.0)], 1.0);
    let fields = ["density", "velocity", "stress", "temperature"];
    let place = |x: f64| [x * SPACING, 0.1 * SPACING, 0.0];
    case.measure.gauges = vec![
        gauge(place(0.3), &fields),
        gauge(place(6.0), &["velocity"]),
        gauge(place(40.0), &["velocity"]),
    ];
    let mut simulation = start(case);
    step(&mut simulation, 1);
    let names: Vec<String> = simulation
        .gauges()
        .columns()
        .map(|(name, _)| name)
        .collect();
    assert_eq!(
        names[..5],
        [
            "density",
            "velocity_x",
            "velocity_y",
            "velocity_z",
            "stress_xx"
        ]
    );
    let rows = read(&mut simulation);
    let value = |row: &GaugeRow, name: &str| {
        let at = names.iter().position(|n| n == name).unwrap();
        row.values[at].unwrap()
    };
    let inside = &rows[0];
    assert!((inside.coverage - 1.0).abs() < 0.02, "{inside:?}");
    assert!((value(inside, "velocity_z") / 300.0 - 1.0).abs() < 1e-12);
    let density = simulation.case.materials[0].reference_density;
    assert!((value(inside, "density") / density - 1.0).abs() < 1e-9);
    assert!(
        (value(inside, "temperature") - 293.0).abs() < 10.0,
        "{inside:?}"
    );
    assert!((0.2..0.8).contains(&rows[1].coverage), "{:?}", rows[1]);
    assert!((value(&rows[1], "velocity_z") / 300.0 - 1.0).abs() < 1e-12);
    assert_eq!(rows[1].values[0], None);
    assert_eq!(rows[2].coverage.to_bits(), 0.0_f64.to_bits());
    assert!(value(&rows[2], "velocity_z").is_nan());
}

/// A linear field is read where the gauge is: the mean of the kernel is centred to the symmetry of the
/// lattice, here in a point of it.
#[test]
fn a_gauge_reads_a_gradient_where_it_is() {
    let mut ball = ball("ball", 0.0, 6.0, 0.0);
    ball.angular_velocity = Vec3::new(0.0, 0.0, 1e4);
    let mut case = case(3, vec![ball], 1.0);
    let at = [1.5 * SPACING, 0.5 * SPACING, 0.5 * SPACING];
    case.measure.gauges = vec![gauge(at, &["velocity"])];
    let rows = read(&mut start(case));
    let expected = [-1e4 * at[1], 1e4 * at[0], 0.0];
    for (value, expected) in rows[0].values.iter().zip(expected) {
        let speed = 1e4 * SPACING;
        assert!((value.unwrap() - expected).abs() < 1e-9 * speed, "{rows:?}");
    }
}

fn impact(quarter: bool) -> Case {
    let mut case = sphere_on_plate(1e-4, 3000.0, quarter, 1.0);
    let fields = ["pressure", "velocity", "stress", "density"];
    let mut along = gauge([0.0, 0.0, 0.0], &fields);
    along.along = Some([0.0, 0.0, 1.0]);
    let mut sphere = gauge([0.0, 1.3e-4, 0.3e-3], &fields);
    sphere.body = Some(0);
    case.measure.gauges = vec![along, sphere, gauge([2e-4, 1e-4, -0.5e-4], &fields)];
    case
}

/// A gauge on planes of symmetry reads their images too: as in the whole model.
#[test]
fn a_quarter_is_read_as_the_whole() {
    let [mut quarter, mut whole] = [true, false].map(|quarter| start(impact(quarter)));
    step(&mut quarter, 12);
    step(&mut whole, 12);
    let [quarter, whole] = [read(&mut quarter), read(&mut whole)];
    let scales = [
        1e10, 1e3, 1e3, 1e3, 1e10, 1e10, 1e10, 1e10, 1e10, 1e10, 1e3, 1e10,
    ];
    for (a, b) in quarter.iter().zip(&whole) {
        assert!((a.coverage - b.coverage).abs() < 1e-9);
        for ((x, y), scale) in a.values.iter().zip(&b.values).zip(scales) {
            let apart = x.zip(*y).map_or(0.0, |(x, y)| (x - y).abs());
            assert!(apart < 1e-9 * scale, "{a:?}\n{b:?}");
        }
    }
    let first = &whole[0].values;
    let (zz, normal) = (first[6].unwrap(), first[11].unwrap());
    assert_eq!(zz.to_bits(), normal.to_bits());
    assert!(normal < -1e8, "pressed along z: {normal}");
    assert_eq!(whole[1].values[11], None);
}

/// The nearest particle carries a gauge, of those as near that of the smallest id, and the gauge says
/// what that particle holds.
#[test]
fn a_carried_gauge_says_what_its_particle_holds() {
    let mut case = impact(false);
    let mut carried = gauge(
        [0.0, 0.0, 0.3e-3],
        &["pressure", "velocity", "plastic_strain"],
    );
    carried.moves = true;
    let mut of_plate = carried.clone();
    of_plate.body = Some(1);
    case.measure.gauges = vec![carried, of_plate];
    let mut simulation = start(case);
    let particles = &simulation.particles;
    let nearest = |body: Option<u32>| {
        let all = (0..particles.owned()).filter(|&i| body.is_none_or(|b| particles.body[i] == b));
        let far = |i: usize| {
            let x = particles.position[i];
            x[0] * x[0] + x[1] * x[1] + (x[2] - 0.3e-3) * (x[2] - 0.3e-3)
        };
        let key = |i: usize| (far(i).to_bits(), particles.id[i]);
        all.map(key).min().unwrap().1
    };
    let wanted = [nearest(None), nearest(Some(1))];
    assert_eq!(simulation.state.gauge_carriers, wanted);
    let begun = read(&mut simulation)[0].position;
    step(&mut simulation, 40);
    let rows = read(&mut simulation);
    let particles = &simulation.particles;
    for (row, id) in rows.iter().zip(wanted) {
        let i = particles.id.iter().position(|&other| other == id).unwrap();
        assert_eq!(row.position, particles.position[i]);
        assert_eq!(row.coverage.to_bits(), 1.0_f64.to_bits());
        let v = particles.velocity[i];
        let held = [
            particles.pressure[i],
            v[0],
            v[1],
            v[2],
            particles.plastic_strain[i],
        ];
        let said: Vec<f64> = row.values.iter().map(|value| value.unwrap()).collect();
        assert_eq!(said, held);
    }
    assert!(rows[0].position[2] < begun[2]);
}

/// All of a ball flies through a plane, and half of it is modelled: the ledger is that of the whole
/// ball, each particle passes once, where and when it is on the plane.
#[test]
fn a_witness_plane_counts_what_passes() {
    let mut case = case(3, vec![ball("ball", 0.0, 5.0, 3000.0)], 1.0);
    case.symmetry = planes(&[Axis::X]);
    let plane = |name: &str, z: f64, normal: f64| Witness {
        name: name.into(),
        point: [0.0, 0.0, z * SPACING],
        normal: [0.0, 0.0, normal],
    };
    case.measure.witnesses = vec![
        plane("ahead", 6.2, 1.0),
        plane("against", 6.2, -1.0),
        plane("far", 90.0, 1.0),
    ];
    let mut simulation = start(case);
    let comm = Comm::solo();
    let mut seen = Vec::new();
    let flight = 12.0 * SPACING / 3000.0;
    while simulation.state.time < flight {
        step(&mut simulation, 1);
        // As often as rows and checkpoints ask.
        if simulation.state.step.is_multiple_of(3) {
            seen.extend(measurements::join_crossings(&mut simulation, &comm));
        }
    }
    seen.extend(measurements::join_crossings(&mut simulation, &comm));
    let passed = measurements::whole(&simulation).passed;
    let count = simulation.particles.owned() as u64;
    let totals = &simulation.state.totals;
    assert_eq!(passed.len(), 6);
    let forwards = passed[0];
    assert_eq!(forwards.particles, 2 * count);
    assert!((forwards.mass / (2.0 * totals.mass) - 1.0).abs() < 1e-12);
    assert!((forwards.momentum[2] / (forwards.mass * 3000.0) - 1.0).abs() < 1e-12);
    assert_eq!(forwards.momentum[0].to_bits(), 0.0_f64.to_bits());
    let kinetic = 0.5 * forwards.mass * 9e6;
    assert!((forwards.kinetic_energy / kinetic - 1.0).abs() < 1e-12);
    assert_eq!(passed[1].particles, 0);
    assert_eq!([passed[2].particles, passed[3].particles], [0, 2 * count]);
    assert_eq!([passed[4].particles, passed[5].particles], [0, 0]);
    assert_eq!(seen.len() as u64, 2 * count);
    for crossing in seen.iter().filter(|crossing| crossing.plane == 0) {
        let z = crossing.position[2];
        assert!((z / (6.2 * SPACING) - 1.0).abs() < 1e-12, "{crossing:?}");
        let i = simulation
            .particles
            .id
            .iter()
            .position(|&id| id == crossing.id)
            .unwrap();
        let flown = 3000.0 * (simulation.state.time - crossing.time);
        assert!((simulation.particles.position[i][2] - z - flown).abs() < 1e-9 * SPACING);
    }
}
