//! Equations of state from tables: a table of a known state gives it back, and what is no table is refused.

use std::fmt::Write as _;

use crate::support::material;
use material::{Eos, Grid, LANES, Material, Murnaghan, PointBatch, Strength, Table};

const GAMMA: f64 = 1.4;
/// Specific heat (J/(kg K)).
const HEAT: f64 = 717.63;

/// Stiffened gas: `e = c_v T + p_∞/ρ`, `p = (γ − 1) ρ c_v T − p_∞`.
fn state(stiff: f64, rho: f64, t: f64) -> [f64; 2] {
    [
        HEAT * t + stiff / rho,
        (GAMMA - 1.0) * rho * HEAT * t - stiff,
    ]
}

/// Nodes from `first` to `last` in equal ratios.
fn nodes(first: f64, last: f64, count: i32) -> Vec<f64> {
    let ratio = (last / first).powf(1.0 / f64::from(count - 1));
    (0..count).map(|n| first * ratio.powi(n)).collect()
}

/// Text of a table, with a row of zeros in front as tables of SESAME have.
fn text(rho: &[f64], t: &[f64], values: impl Fn(f64, f64) -> [f64; 2]) -> String {
    let (rho, t): (Vec<f64>, Vec<f64>) = (
        [0.0].iter().chain(rho).copied().collect(),
        [0.0].iter().chain(t).copied().collect(),
    );
    let mut text = format!(
        "# a table\n# for tests\n20240101\n{} {}\n",
        rho.len(),
        t.len()
    );
    for list in [&rho, &t] {
        let words: Vec<String> = list.iter().map(|x| format!("{x:e}")).collect();
        let _ = writeln!(text, "{}", words.join(" "));
    }
    for t in &t {
        for rho in &rho {
            let [e, p] = if *rho == 0.0 {
                [0.0; 2]
            } else {
                values(*rho, *t)
            };
            let _ = writeln!(text, "{e:e} {p:e} 0 0");
        }
    }
    text
}

fn of(stiff: f64, columns: i32, rows: i32) -> String {
    let values = |rho: f64, t: f64| state(stiff, rho, t);
    text(
        &nodes(100.0, 4000.0, columns),
        &nodes(50.0, 5000.0, rows),
        values,
    )
}

fn tabled(text: &str) -> Material {
    let grid = Grid::read(text).unwrap();
    let table = Table::new(grid, 1000.0, 300.0, [String::new(), String::new()]).unwrap();
    material(1000.0, Eos::Table(table), Strength::None)
}

fn at(material: &Material, rho: f64, e: f64) -> (f64, f64) {
    let mut point = PointBatch {
        density: [rho; LANES],
        specific_energy: [e; LANES],
        ..PointBatch::ZERO
    };
    material.update(&mut point, 0.0);
    (point.pressure[0], point.sound_speed[0])
}

/// The surface is bilinear, as the pressure of an ideal gas is; what is left of a stiffened gas is the curvature of its cold
/// energy between densities, and falls with the square of their distance.
#[test]
fn a_table_of_a_known_state_gives_it_back() {
    let ideal = tabled(&of(0.0, 20, 20));
    let mut errors = Vec::new();
    for columns in [40, 80, 160] {
        let stiff = 2e8;
        let table = tabled(&of(stiff, columns, 40));
        let mut most = 0.0_f64;
        for rho in [137.0, 500.0, 1000.0, 1234.5, 3900.0] {
            for t in [60.0, 300.0, 1111.0, 4000.0] {
                let [e, p] = state(stiff, rho, t);
                let (found, speed) = at(&table, rho, e);
                let size = p.abs() + stiff;
                most = most.max((found - p).abs() / size);
                let exact = (GAMMA * (p + stiff) / rho).sqrt();
                if columns == 160 {
                    assert!(
                        (speed / exact - 1.0).abs() < 0.05,
                        "{rho} {t}: {speed} {exact}"
                    );
                }
                let [e, p] = state(0.0, rho, t);
                let (found, speed) = at(&ideal, rho, e);
                assert!((found / p - 1.0).abs() < 1e-12, "{rho} {t}: {found} {p}");
                assert!((speed / (GAMMA * p / rho).sqrt() - 1.0).abs() < 1e-10);
            }
        }
        errors.push(most);
    }
    println!("errors {errors:?}");
    assert!(errors[2] < 1e-3 && errors[2] < 0.35 * errors[1] && errors[1] < 0.35 * errors[0]);
}

/// Beyond the table an ideal gas goes on as one: hotter, denser and thinner.
#[test]
fn beyond_its_ends_a_table_goes_on() {
    let ideal = tabled(&of(0.0, 20, 20));
    for (rho, t) in [
        (1000.0, 9000.0),
        (6000.0, 300.0),
        (1e-3, 300.0),
        (1e-3, 9000.0),
    ] {
        let [e, p] = state(0.0, rho, t);
        let (found, _) = at(&ideal, rho, e);
        assert!((found / p - 1.0).abs() < 1e-10, "{rho} {t}: {found} {p}");
    }
    // Colder than the first temperature it has the pressure of that.
    let [_, coldest] = state(0.0, 1000.0, 50.0);
    let (found, _) = at(&ideal, 1000.0, 0.0);
    assert!((found / coldest - 1.0).abs() < 1e-12);
    assert!(at(&ideal, f64::NAN, 1e5).0.is_nan());
}

/// The reference energy is that of the reference temperature, and the modulus `ρ c²` there.
#[test]
fn the_reference_state_is_of_its_temperature() {
    let ideal = tabled(&of(0.0, 20, 20));
    let energy = ideal.eos.reference_energy(1000.0);
    assert!((energy / (HEAT * 300.0) - 1.0).abs() < 1e-12);
    let [_, p] = state(0.0, 1000.0, 300.0);
    assert!((ideal.bulk_modulus() / (GAMMA * p) - 1.0).abs() < 1e-10);
}

/// Numbers in columns of a width, five a line; flags after the fifth where the layout has them.
fn columns_of(numbers: &[f64], width: usize, flags: &str) -> String {
    let mut text = String::new();
    for line in numbers.chunks(5) {
        for x in line {
            let digits = if width == 22 { 15 } else { 8 };
            // As Fortran writes: two digits of exponent, or three without a letter.
            let word = format!("{x:.digits$e}");
            let (digits, exponent) = word.split_once('e').unwrap();
            let exponent: i32 = exponent.parse().unwrap();
            let sign = if exponent < 0 { '-' } else { '+' };
            let word = match exponent.abs() {
                far @ 100.. => format!("{digits}{sign}{far}"),
                near => format!("{digits}E{sign}{near:02}"),
            };
            let _ = write!(text, "{word:>width$}");
        }
        let _ = writeln!(text, "{}", if line.len() == 5 { flags } else { "" });
    }
    text
}

/// A record 301 of the stiffened gas: g/cm³, K, `GPa`, MJ/kg.
fn record(columns: i32, rows: i32) -> Vec<f64> {
    let (rho, t) = (nodes(100.0, 4000.0, columns), nodes(50.0, 5000.0, rows));
    let mut numbers = vec![f64::from(columns), f64::from(rows)];
    numbers.extend(rho.iter().map(|rho| rho / 1e3));
    numbers.extend(&t);
    for (which, unit) in [(1, 1e9), (0, 1e6)] {
        for t in &t {
            numbers.extend(rho.iter().map(|rho| state(2e8, *rho, *t)[which] / unit));
        }
    }
    numbers
}

/// A file of Los Alamos: a comment, material, and states.
fn los_alamos(numbers: &[f64], width: usize, material: u32) -> String {
    let head = |index: u32, record: u32, count: usize| {
        format!("{index:2}{material:6}{record:6}{count:6}   r   82803   22704 1\n")
    };
    format!(
        "{}{:80}\n{:80}\n{}{}{}{}",
        head(0, 101, 100),
        "material: a stiffened gas 1 2 3",
        "of two lines",
        head(1, 201, 5),
        columns_of(&[13.0, 26.98, 1.0, 0.1, 0.0], width, "11111"),
        head(1, 301, numbers.len()),
        columns_of(numbers, width, "11111"),
    )
}

/// Files of SESAME in three widths give what the layout of SWIFT gives, to the digits that they hold.
#[test]
fn files_of_sesame_are_read() {
    let numbers = record(20, 20);
    let aneos = format!(
        " INDEX      MATID =      1    NWDS =        9\n{} RECORD     TYPE =  201     NWDS =        5\n{} \
         RECORD     TYPE =  301     NWDS = {:8}\n{}",
        columns_of(&[1.0; 9], 16, ""),
        columns_of(&[13.0, 26.98, 1.0, 0.1, 298.0], 16, ""),
        numbers.len(),
        columns_of(&numbers, 16, ""),
    );
    let plain = tabled(&of(2e8, 20, 20));
    for (text, digits) in [
        (los_alamos(&numbers, 15, 3720), 1e-7),
        (los_alamos(&numbers, 22, 3720), 1e-12),
        (aneos, 1e-7),
    ] {
        let table = tabled(&text);
        for (rho, e) in [(200.0, 1e6), (1000.0, 5e5), (3900.0, 2e6)] {
            let ((p, c), (of_p, of_c)) = (at(&table, rho, e), at(&plain, rho, e));
            assert!((p - of_p).abs() < digits * (of_p.abs() + 2e8), "{p} {of_p}");
            assert!((c / of_c - 1.0).abs() < 10.0 * digits, "{c} {of_c}");
        }
    }
    // Numbers of three digits of exponent touch their letterless exponent.
    let mut small = numbers.clone();
    small[2 + 20 + 20] = 1e-101;
    assert!(columns_of(&small, 15, "").contains("-101"));
    let _ = Grid::read(&los_alamos(&small, 15, 3720));

    let said = |text: &str| Grid::read(text).expect_err("no table");
    let sound = los_alamos(&numbers, 15, 3720);
    let cut = sound.len() - 200;
    assert!(said(&sound[..cut]).contains("the file ends before the"));
    let two = format!("{sound}{}", los_alamos(&numbers, 15, 3721));
    assert_eq!(
        said(&two),
        "it holds the materials 3720 and 3721: a file is to hold one"
    );
    assert!(said(&sound.replace("   301", "   303")).contains("it has no record 301"));
    assert!(said(&los_alamos(&numbers[..300], 15, 1)).contains("too few for 20 densities"));
    assert!(said(&sound.replace("E+01", "F+01")).contains("is no number"));
}

#[test]
fn what_is_no_table_is_refused() {
    let sound = of(2e8, 10, 10);
    let said = |text: &str| Grid::read(text).expect_err("no table");
    let cut = |lines: usize| sound.lines().take(lines).collect::<Vec<_>>().join("\n");
    assert_eq!(said(""), "it ends before its version");
    assert_eq!(said("# only words"), "it ends before its version");
    assert_eq!(said(&cut(3)), "it ends before the number of densities");
    assert!(said(&cut(40)).contains("it ends before its"));
    assert_eq!(
        said(&cut(sound.lines().count() - 1)),
        "it ends before its energies"
    );
    assert!(said(&format!("{sound} 1")).contains("more than its numbers say"));
    for (counts, what) in [
        ("1e9 11", "must be a whole number from 3 to 10000"),
        ("10000 10000", "it is too short for 10000 densities"),
        ("2 11", "must be a whole number"),
        ("11.5 11", "must be a whole number"),
        ("-11 11", "must be a whole number"),
        ("nan 11", "is no finite number"),
        ("eleven 11", "`eleven` is no number"),
    ] {
        let text = sound.replacen("11 11", counts, 1);
        assert!(said(&text).contains(what), "{counts}: {}", said(&text));
    }
    let (rho, t) = (nodes(100.0, 4000.0, 10), nodes(50.0, 5000.0, 10));
    let stiff = |rho: f64, t: f64| state(2e8, rho, t);
    let falls: Vec<f64> = rho.iter().rev().copied().collect();
    assert!(
        said(&text(&falls, &t, stiff))
            .contains("its densities are not positive, each above the last")
    );
    assert!(said(&text(&rho, &falls, stiff)).contains("its temperatures are not"));
    let flat = |_: f64, _: f64| [1.0, 1.0];
    assert!(said(&text(&rho, &t, flat)).contains("does not rise"));
    // Pressures in GPa, energies in erg/g, exchanged columns.
    let wrong: [fn(f64, f64) -> [f64; 2]; 3] = [
        |rho, t| {
            let [e, p] = state(2e8, rho, t);
            [e, 1e-9 * p]
        },
        |rho, t| {
            let [e, p] = state(2e8, rho, t);
            [1e4 * e, p]
        },
        |rho, t| {
            let [e, p] = state(2e8, rho, t);
            [p, e]
        },
    ];
    for (n, values) in wrong.into_iter().enumerate() {
        let text = text(&rho, &t, values);
        assert!(
            said(&text).contains("do not belong together"),
            "{n}: {}",
            said(&text)
        );
    }
    let grid = || Grid::read(&sound).unwrap();
    let names = || [String::new(), String::new()];
    assert!(
        Table::new(grid(), 10.0, 300.0, names())
            .unwrap_err()
            .contains("reference density")
    );
    assert!(
        Table::new(grid(), 1000.0, 1e4, names())
            .unwrap_err()
            .contains("reference temperature")
    );
}

/// A few thousand texts with bytes changed are read or refused, without a panic.
#[test]
fn any_text_is_read_or_refused() {
    for sound in [of(2e8, 5, 5), los_alamos(&record(5, 5), 15, 1)] {
        changed(sound.as_bytes());
    }
}

fn changed(sound: &[u8]) {
    let mut seed = 0x9E37_79B9_7F4A_7C15_u64;
    let mut drawn = move || {
        seed ^= seed << 13;
        seed ^= seed >> 7;
        seed ^= seed << 17;
        seed
    };
    let letters = b"0123456789.e-+ \n#naifx";
    for _ in 0..3000 {
        let mut bytes = sound.to_vec();
        for _ in 0..=drawn() % 4 {
            let place = usize::try_from(drawn() % bytes.len() as u64).unwrap();
            bytes[place] = letters[usize::try_from(drawn() % letters.len() as u64).unwrap()];
        }
        let text = String::from_utf8(bytes).unwrap();
        if let Ok(grid) = Grid::read(&text)
            && let Ok(table) = Table::new(grid, 1000.0, 300.0, [String::new(), String::new()])
        {
            let made = material(1000.0, Eos::Table(table), Strength::None);
            let _ = at(&made, 1234.0, 1e5);
        }
    }
}

/// The bulk modulus of Murnaghan's law is `K + n p`.
#[test]
fn the_modulus_of_murnaghan_grows_with_the_pressure() {
    let law = Murnaghan {
        bulk_modulus: 70e9,
        exponent: 4.3,
    };
    let solid = material(2700.0, Eos::Murnaghan(law), Strength::None);
    for ratio in [0.95, 1.0, 1.1, 1.4] {
        let (p, c) = at(&solid, 2700.0 * ratio, 0.0);
        let modulus = 2700.0 * ratio * c * c;
        assert!((modulus / (70e9 + 4.3 * p) - 1.0).abs() < 1e-12);
    }
}
